//! Linear elasticity in shear.

use super::{Conditions, Constants, Law, PointBatch, jaumann};

/// Linear elastic in shear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}

impl Law for Elastic {
    const STATE: &'static [&'static str] = &["deviatoric_stress"];

    fn constants(&self) -> Constants {
        vec![("shear_modulus", self.shear_modulus, "Pa")]
    }

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        jaumann::deform(point, now);
    }
}
