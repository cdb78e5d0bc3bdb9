//! A polynomial in the compression, as for ceramics, glass and concrete.
//!
//! With `μ = ρ/ρ₀ − 1`
//!
//! ```text
//! p = K₁ μ + K₂ μ² + K₃ μ³ + γ₀ ρ₀ e   (μ ≥ 0),    K₁ μ + γ₀ ρ₀ e   (μ < 0)
//! ```
//!
//! Source: Johnson & Holmquist (1994), *An improved computational constitutive model for brittle
//! materials*, AIP Conf. Proc. 309, 981, where γ₀ is zero: heat gives no pressure.

use super::{EquationOfState, PointResponse};
use crate::{at_least, at_most};

law! {
    /// A cubic polynomial in the compression.
    Polynomial {
        /// Bulk modulus K₁ (Pa).
        k1: "Pa",
        /// Coefficient K₂ of the square of the compression (Pa).
        k2: "Pa",
        /// Coefficient K₃ of its cube (Pa).
        k3: "Pa",
        /// Grüneisen parameter γ₀: thermal pressure over `ρ₀ e`.
        gamma0: "",
    }
}

impl EquationOfState for Polynomial {
    fn bulk_modulus(&self, _rho0: f64) -> f64 {
        self.k1
    }

    #[inline(always)]
    fn at(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
        let mu = rho / rho0 - 1.0;
        let pressed = at_least(mu, 0.0);
        let pulled = at_most(mu, 0.0);
        let cold = pressed * (self.k1 + pressed * (self.k2 + pressed * self.k3));
        let slope = self.k1 + pressed * (2.0 * self.k2 + 3.0 * self.k3 * pressed);
        PointResponse {
            pressure: cold + self.k1 * pulled + self.gamma0 * rho0 * e,
            dp_drho: slope / rho0,
            dp_de: self.gamma0 * rho0,
        }
    }
}
