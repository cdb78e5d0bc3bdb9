//! Words to choose from that make no choice of the model by themselves; those that do are read as
//! it.

use serde::Deserialize;

choices! {
    /// Side of a surface.
    SideName {
        /// Outside, as of a punch.
        Outside,
        /// Inside, as of a container.
        Inside,
    }
    /// Smoothing length in the SPH sums.
    SmoothingName {
        /// h = h₀.
        Constant,
        /// h follows the density.
        Variable,
    }
}

/// A signed axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum Direction {
    /// Towards larger x.
    #[serde(rename = "+x")]
    PlusX,
    /// Towards smaller x.
    #[serde(rename = "-x")]
    MinusX,
    /// Towards larger y.
    #[serde(rename = "+y")]
    PlusY,
    /// Towards smaller y.
    #[serde(rename = "-y")]
    MinusY,
    /// Towards larger z.
    #[serde(rename = "+z")]
    PlusZ,
    /// Towards smaller z.
    #[serde(rename = "-z")]
    MinusZ,
}
