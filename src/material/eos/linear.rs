//! Linear equation of state, without heat.

use serde::Deserialize;

use super::PointResponse;

/// How the pressure of [`Linear`] depends on the density.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
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
    /// Dependence on the density.
    pub form: LinearForm,
}

impl Linear {
    /// Pressure and derivatives at density `rho`, for the reference density `rho0` (kg/m³).
    #[must_use]
    #[inline]
    pub fn response(&self, rho0: f64, rho: f64) -> PointResponse {
        let k = self.bulk_modulus;
        let (pressure, dp_drho) = match self.form {
            LinearForm::Logarithmic => (k * libm::log(rho / rho0), k / rho),
            LinearForm::DensityRatio => (k * (rho / rho0 - 1.0), k / rho0),
        };
        PointResponse {
            pressure,
            dp_drho,
            dp_de: 0.0,
        }
    }
}
