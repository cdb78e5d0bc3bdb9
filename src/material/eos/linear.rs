//! Linear equation of state, without heat.

/// How the pressure of [`Linear`] depends on the density ratio.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinearForm {
    /// `p = K ln(ρ/ρ₀)`: with linear elasticity, uniaxial strain follows `σ̇ = M D` exactly.
    Logarithmic,
    /// `p = K (ρ/ρ₀ − 1)`.
    DensityRatio,
}

/// Pressure from the density alone, by the bulk modulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linear {
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Dependence on the density ratio.
    pub form: LinearForm,
}
