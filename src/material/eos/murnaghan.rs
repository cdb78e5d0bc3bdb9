//! Murnaghan's equation of state, without heat:
//!
//! ```text
//! p = (K/n) [(ρ/ρ₀)^n − 1]
//! ```
//!
//! for a bulk modulus `K + n p` that grows linearly with the pressure. Source: Murnaghan (1944), *The
//! compressibility of media under extreme pressures*, Proc. Natl. Acad. Sci. 30, 244. It is Tait's law with
//! `B = K/n`, of a solid: unlike a liquid it does not cavitate unless it says so.

use super::{EquationOfState, PointResponse};

law! {
    /// Murnaghan's law.
    Murnaghan {
        /// Bulk modulus K of the reference state (Pa).
        bulk_modulus: "Pa",
        /// Its derivative by the pressure, n.
        exponent: "",
    }
}

impl EquationOfState for Murnaghan {
    const APART: bool = true;

    fn bulk_modulus(&self, _rho0: f64) -> f64 {
        self.bulk_modulus
    }

    #[inline]
    fn at(&self, rho0: f64, rho: f64, _e: f64) -> PointResponse {
        let power = libm::pow(rho / rho0, self.exponent);
        PointResponse {
            pressure: self.bulk_modulus / self.exponent * (power - 1.0),
            dp_drho: self.bulk_modulus * power / rho,
            dp_de: 0.0,
        }
    }
}
