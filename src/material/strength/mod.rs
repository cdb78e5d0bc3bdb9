//! Strength: the deviatoric stress.

pub mod elastic;
pub mod jaumann;
pub mod von_mises;

pub use elastic::Elastic;
pub use von_mises::VonMises;

use super::{LANES, PointBatch};

/// The resistance of a material to shear.
#[derive(Debug, Clone, PartialEq)]
pub enum Strength {
    /// No shear stress: a fluid.
    None,
    /// Linear elastic (hypoelastic with the Jaumann rate), without bound.
    Elastic(Elastic),
    /// Elastic–plastic with a von Mises yield stress and linear hardening.
    VonMises(VonMises),
}

impl Strength {
    /// Elastic shear modulus G (Pa); zero for a fluid.
    #[must_use]
    pub fn shear_modulus(&self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Elastic(law) => law.shear_modulus,
            Self::VonMises(law) => law.shear_modulus,
        }
    }

    /// Advances stress and plastic strain of a batch by `dt` (s).
    #[inline(always)]
    pub(super) fn update(&self, batch: &mut PointBatch, dt: f64) {
        match self {
            Self::None => batch.deviatoric_stress = [[0.0; LANES]; 6],
            Self::Elastic(law) => law.update(batch, dt),
            Self::VonMises(law) => law.update(batch, dt),
        }
    }
}
