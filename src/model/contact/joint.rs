//! Joints, which hold two bodies together until they are torn apart.

/// What holds two bodies together where they touch at the start, as an adhesive does (theory page "Joints").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Tension across it from which it comes apart (Pa).
    pub strength: f64,
    /// The same of shear (Pa).
    pub shear_strength: f64,
    /// Energy that an area takes to come apart in tension (J/m²); none if it does at once.
    pub energy: Option<f64>,
    /// The same in shear (J/m²).
    pub shear_energy: Option<f64>,
}

/// Stiffness over the smaller p-wave modulus and the spacing: as that of matter of two spacings.
const STIFFNESS: f64 = 0.5;

impl Joint {
    /// Traction over opening (Pa/m) between bodies of which the softer has this p-wave modulus (Pa), at a mean spacing (m).
    #[must_use]
    pub fn stiffness(modulus: f64, spacing: f64) -> f64 {
        STIFFNESS * modulus / spacing
    }
}
