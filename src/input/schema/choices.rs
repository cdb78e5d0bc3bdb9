//! Words to choose from.

use serde::Deserialize;

choices! {
    /// A coordinate axis.
    AxisName {
        /// First.
        X,
        /// Second.
        Y,
        /// Third.
        Z,
    }
    /// Side of a surface.
    SideName {
        /// Outside, as of a punch.
        Outside,
        /// Inside, as of a container.
        Inside,
    }
    /// Kind of lattice.
    LatticeName {
        /// Simple cubic.
        Cubic,
        /// Hexagonal close-packed.
        Hexagonal,
        /// Concentric rings.
        Rings,
    }
    /// How the SPH sums take gradients.
    SphFormName {
        /// By the kernel's gradient.
        Conventional,
        /// By the corrected gradient.
        Normalised,
        /// By linear fits at stress points.
        StressPoints,
    }
    /// Smoothing length in the SPH sums.
    SmoothingName {
        /// h = h₀.
        Constant,
        /// h follows the density.
        Variable,
    }
    /// Form of the linear equation of state.
    FormName {
        /// ln(ρ/ρ₀).
        Logarithmic,
        /// ρ/ρ₀ − 1.
        DensityRatio,
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
