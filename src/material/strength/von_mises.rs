//! Von Mises plasticity.

/// Elastic–plastic: elastic inside the von Mises cylinder, whose radius may grow with plastic
/// strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VonMises {
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
    /// Yield stress in uniaxial tension at zero plastic strain, Y₀ (Pa).
    pub yield_stress: f64,
    /// Hardening modulus H (Pa): `Y = Y₀ + H ε_p`; 0 for perfect plasticity.
    pub hardening_modulus: f64,
}
