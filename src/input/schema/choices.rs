//! Words to choose from that make no choice of the model by themselves; those that do are read as it.

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
    /// Along what contact forces act.
    DirectionName {
        /// The line between particles.
        Pair,
        /// The normal of the surfaces.
        Normal,
    }
    /// Contact mode.
    ModeName {
        /// Nothing.
        None,
        /// One continuum.
        Kernel,
        /// Contact potential.
        Potential,
        /// Overlap energy.
        Overlap,
        /// Penalty between boundary particles.
        Penalty,
    }
    /// Law of the penalty force.
    PenaltyLawName {
        /// Depth to the power 3/2.
        Hertz,
        /// No more than what stops the approach in one step.
        Pinball,
    }
    /// Range of the contact potential.
    RangeName {
        /// 2h.
        Support,
        /// Mean spacing.
        Spacing,
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
