//! Parameters of the mode `potential`.

use serde::Deserialize;

use super::{ContactDirection, ContactLaw};

/// Contact potential of Vignjevic, De Vuyst & Campbell (2006), eqs. 20–24.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Potential {
    /// Dimensionless stiffness k: K = k M/Δp^d with the smaller p-wave modulus M of the two
    /// bodies and their mean spacing.
    pub stiffness: f64,
    /// Exponent n ≥ 1 of the kernel ratio.
    pub exponent: u32,
    /// Range of the force.
    pub range: PotentialRange,
    /// Along what it acts.
    pub direction: ContactDirection,
}

/// Where the contact potential acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PotentialRange {
    /// Everywhere in the kernel's support, 2h.
    Support,
    /// Closer than the mean particle spacing.
    Spacing,
}

impl Default for Potential {
    fn default() -> Self {
        Self {
            stiffness: 1.0,
            exponent: 4,
            range: PotentialRange::Support,
            direction: ContactDirection::Pair,
        }
    }
}

impl ContactLaw for Potential {
    fn stiffness(&self) -> f64 {
        self.stiffness
    }
}
