//! Linear elasticity in shear.

use super::jaumann;
use crate::material::{LANES, PointBatch};

/// Linear elastic in shear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}

impl Elastic {
    /// Advances the stress of a batch by `dt` (s).
    #[inline(always)]
    pub(in crate::material) fn update(self, batch: &mut PointBatch, dt: f64) {
        if dt != 0.0 {
            jaumann::advance(batch, &[self.shear_modulus; LANES], dt);
        }
    }
}
