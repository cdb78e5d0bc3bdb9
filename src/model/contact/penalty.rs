//! Parameters of the mode `penalty`.

use serde::Deserialize;

use super::{ContactLaw, Resistance};

/// Penalty between boundary particles (Campbell, Vignjevic & Libersky 2000).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Penalty {
    /// Stiffness κ relative to the p-wave modulus.
    pub stiffness: f64,
    /// Law of the force.
    pub law: PenaltyLaw,
    /// Friction and damping.
    pub resistance: Resistance,
}

/// Law of the penalty force (Belytschko & Neal 1991).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PenaltyLaw {
    /// As the depth to the power 3/2, as between spheres: a function of places.
    Hertz,
    /// The smaller of that and what stops the approach in one step; nothing while parting.
    Pinball,
}

impl Default for Penalty {
    fn default() -> Self {
        Self {
            stiffness: 2.0,
            law: PenaltyLaw::Hertz,
            resistance: Resistance::default(),
        }
    }
}

impl ContactLaw for Penalty {
    fn stiffness(&self) -> f64 {
        self.stiffness
    }

    fn resistance(&self) -> Option<&Resistance> {
        Some(&self.resistance)
    }

    fn needs_sums(&self) -> bool {
        true
    }
}
