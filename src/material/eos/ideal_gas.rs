//! Ideal gas, or stiffened gas for liquids and solids under shock:
//!
//! ```text
//! p = (γ − 1) ρ e − γ p_∞,    c² = γ (p + p_∞)/ρ
//! ```
//!
//! with `p_∞ = 0` for an ideal gas. Source: Harlow & Amsden (1971), *Fluid dynamics*, LA-4700;
//! for the stiffened gas Menikoff & Plohr (1989), Rev. Mod. Phys. 61, 75.
//!
//! Unlike other equations of state it has no state of rest by itself: its reference state is the
//! reference density at a reference pressure, and a body that states no specific energy begins at
//! that pressure.

use super::{EquationOfState, PointResponse};

law! {
    /// Ideal or stiffened gas.
    IdealGas {
        /// Ratio of specific heats γ.
        gamma: "",
        /// Stiffening pressure `p_∞` (Pa); 0 for an ideal gas.
        stiffening_pressure: "Pa",
        /// Pressure of the reference state (Pa).
        reference_pressure: "Pa",
    }
}

impl IdealGas {
    /// Specific energy (J/kg) at the reference pressure and density `rho` (kg/m³).
    #[must_use]
    pub fn reference_energy(&self, rho: f64) -> f64 {
        let pressure = self.reference_pressure + self.gamma * self.stiffening_pressure;
        pressure / ((self.gamma - 1.0) * rho)
    }

    /// Pressure and derivatives at density `rho` (kg/m³) and specific energy `e` (J/kg).
    #[must_use]
    #[inline]
    pub fn response(&self, rho: f64, e: f64) -> PointResponse {
        let dp_drho = (self.gamma - 1.0) * e;
        PointResponse {
            pressure: rho * dp_drho - self.gamma * self.stiffening_pressure,
            dp_drho,
            dp_de: (self.gamma - 1.0) * rho,
        }
    }
}

impl EquationOfState for IdealGas {
    const APART: bool = true;

    /// `γ (p + p_∞)`.
    fn bulk_modulus(&self, _rho0: f64) -> f64 {
        self.gamma * (self.reference_pressure + self.stiffening_pressure)
    }

    fn reference_energy(&self, rho: f64) -> f64 {
        self.reference_energy(rho)
    }

    fn modulus_over_pressure(&self) -> Option<[f64; 2]> {
        Some([self.gamma, self.stiffening_pressure])
    }

    #[inline]
    fn at(&self, _rho0: f64, rho: f64, e: f64) -> PointResponse {
        self.response(rho, e)
    }
}
