//! Mie–Grüneisen equation of state about a Hugoniot.

/// Mie–Grüneisen with a cubic Hugoniot and a Grüneisen parameter linear in the compression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MieGruneisen {
    /// Bulk sound speed c₀ in the reference state (m/s).
    pub c0: f64,
    /// Linear coefficient s₁ of the Hugoniot `U = c₀ + s₁ u + …`.
    pub s1: f64,
    /// Coefficient s₂ (0 for a straight Hugoniot).
    pub s2: f64,
    /// Coefficient s₃ (0 for a straight Hugoniot).
    pub s3: f64,
    /// Grüneisen parameter γ₀ in the reference state.
    pub gamma0: f64,
    /// Coefficient b in `ρ₀ (γ₀ + b μ)`, the pressure per specific energy, with `μ = ρ/ρ₀ − 1`.
    pub b: f64,
}
