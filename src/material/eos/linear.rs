//! Linear equation of state, without heat.

use serde::Deserialize;

use super::{EquationOfState, PointResponse};

/// Dependence of the pressure of [`Linear`] on the density.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinearForm {
    /// `p = K ln(ρ/ρ₀)`: with linear elasticity, uniaxial strain follows `σ̇ = M D` exactly.
    Logarithmic,
    /// `p = K (ρ/ρ₀ − 1)`.
    DensityRatio,
}

impl LinearForm {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Logarithmic => "logarithmic",
            Self::DensityRatio => "density_ratio",
        }
    }
}

law! {
    /// Pressure from the density alone, by the bulk modulus.
    Linear {
        /// Bulk modulus K (Pa).
        bulk_modulus: "Pa",
        /// Dependence on the density.
        form: LinearForm,
    }
}

impl EquationOfState for Linear {
    fn bulk_modulus(&self, _rho0: f64) -> f64 {
        self.bulk_modulus
    }

    #[inline]
    fn at(&self, rho0: f64, rho: f64, _e: f64) -> PointResponse {
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
