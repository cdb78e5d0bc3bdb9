//! Tait's equation of state for liquids, in the form of Vignjevic et al. (2006), equation (25):
//!
//! ```text
//! p = B [(ρ/ρ₀)^γ − 1],    B = ρ₀ c₀²/γ
//! ```
//!
//! without heat. In free-surface flow (Monaghan 1994, *Simulating free surface flows with SPH*, J.
//! Comput. Phys. 110, 399) c₀ is set to some ten times the largest velocity instead of the
//! liquid's own speed of sound, which keeps the density within a percent and steps long.

use super::{EquationOfState, PointResponse};

law! {
    /// Tait's law.
    Tait {
        /// Coefficient B (Pa).
        b: "Pa",
        /// Exponent γ.
        gamma: "",
    }
}

impl Tait {
    /// The law whose bulk sound speed at the reference density `rho0` (kg/m³) is `c0` (m/s).
    #[must_use]
    pub fn with_sound_speed(rho0: f64, c0: f64, gamma: f64) -> Self {
        Self {
            b: rho0 * c0 * c0 / gamma,
            gamma,
        }
    }

    /// Pressure and derivatives at density `rho`, for the reference density `rho0` (kg/m³).
    #[must_use]
    #[inline]
    pub fn response(&self, rho0: f64, rho: f64) -> PointResponse {
        let power = libm::pow(rho / rho0, self.gamma);
        PointResponse {
            pressure: self.b * (power - 1.0),
            dp_drho: self.gamma * self.b * power / rho,
            dp_de: 0.0,
        }
    }
}

impl EquationOfState for Tait {
    const APART: bool = true;

    fn bulk_modulus(&self, _rho0: f64) -> f64 {
        self.gamma * self.b
    }

    #[inline]
    fn at(&self, rho0: f64, rho: f64, _e: f64) -> PointResponse {
        self.response(rho0, rho)
    }
}
