//! Linear elasticity in shear.

use super::{Conditions, Law, PointBatch, jaumann};

law! {
    /// Linear elastic in shear.
    Elastic {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
    }
}

impl Law for Elastic {
    const STATE: &'static [&'static str] = &["deviatoric_stress"];

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        jaumann::deform(point, now);
    }
}
