//! Parameters of the mode `overlap`.

use super::{ContactDirection, ContactLaw, Resistance};

/// Overlap energy of the foreign volume fraction above the touching value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Stiffness κ of the overlap energy relative to the p-wave modulus.
    pub stiffness: f64,
    /// Stiffness `κ_c` of the core that keeps lone particles apart.
    pub core_stiffness: f64,
    /// Radius of the core in mean particle spacings.
    pub core_radius: f64,
    /// Along what it acts, but for the core.
    pub direction: ContactDirection,
    /// Friction and damping.
    pub resistance: Resistance,
}

impl Default for Overlap {
    fn default() -> Self {
        Self {
            stiffness: 4.0,
            core_stiffness: 2.2,
            core_radius: 0.6,
            direction: ContactDirection::Pair,
            resistance: Resistance::default(),
        }
    }
}

impl ContactLaw for Overlap {
    fn stiffness(&self) -> f64 {
        self.stiffness
    }

    fn resistance(&self) -> Option<&Resistance> {
        Some(&self.resistance)
    }
}
