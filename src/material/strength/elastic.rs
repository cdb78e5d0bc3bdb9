//! Linear elasticity in shear.

/// Linear elastic in shear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}
