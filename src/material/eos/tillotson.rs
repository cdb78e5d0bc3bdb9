//! Tillotson's equation of state for hypervelocity impact, from cold compression to vapour.
//!
//! With `η = ρ/ρ₀`, `μ = η − 1`, `w = e/(E₀ η²) + 1`: where the material is compressed (`μ ≥ 0`) or
//! too cold to vaporise (`e ≤ e_iv`)
//!
//! ```text
//! p_c = (a + b/w) ρ e + A μ + B max(μ, 0)²
//! ```
//!
//! where it is expanded and vaporised (`μ < 0`, `e ≥ e_cv`), with `z = 1/η − 1`,
//!
//! ```text
//! p_v = a ρ e + [b ρ e/w + A μ exp(−β z)] exp(−α z²)
//! ```
//!
//! and between the two energies the mean `[(e − e_iv) p_v + (e_cv − e) p_c]/(e_cv − e_iv)`. The
//! branches meet in value, and at `μ = 0` in slope. Source: Tillotson (1962), *Metallic equations
//! of state for hypervelocity impact*, GA-3216; in this form Melosh (1989), *Impact cratering*,
//! appendix II, and Benz & Asphaug (1999), Icarus 142, 5.
//!
//! B belongs to compression alone (as in Brundage 2013, Procedia Eng. 58, 461): where it is above A, as of limestone and
//! water, its square would push matter apart again that has expanded.
//!
//! Towards `e = −E₀ η²`, far below anything the fit knows, w would vanish: it stays at or above ½.
//! The expanded cold branch would bear any tension: a spall cut-off ends it, or a least density, below which no
//! branch has a pressure below zero (Schäfer et al. 2016, A&A 590, A19, has no pressure at all there).

use super::{EquationOfState, PointResponse};
use crate::Contradiction;

/// Smallest `w − 1`.
const LEAST: f64 = -0.5;

law! {
    /// Tillotson's law.
    Tillotson {
        /// Coefficient a of the thermal pressure of a dense vapour (γ − 1 of the ideal gas).
        a: "",
        /// Coefficient b of the thermal pressure: `a + b` is the Grüneisen parameter of the cold
        /// solid.
        b: "",
        /// Bulk modulus A (Pa).
        bulk_modulus: "Pa",
        /// Coefficient B of the square of the compression (Pa).
        quadratic_modulus: "Pa",
        /// Exponent α of the vapour's branch.
        alpha: "",
        /// Exponent β of the vapour's branch.
        beta: "",
        /// Scale of energy E₀ (J/kg).
        e0: "J/kg",
        /// Specific energy of incipient vaporisation (J/kg).
        e_iv: "J/kg",
        /// Specific energy of complete vaporisation (J/kg).
        e_cv: "J/kg",
        /// Density over that of the reference state below which matter that has not vaporised bears no
        /// tension; zero for none.
        least_density: "",
    }
}

/// Terms that the branches share at one state.
struct Shared {
    rho0: f64,
    rho: f64,
    e: f64,
    mu: f64,
    /// `b ρ e/w` and its derivatives by ρ and e.
    hot: PointResponse,
}

impl EquationOfState for Tillotson {
    const APART: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        (self.e_cv <= self.e_iv).then_some(Contradiction {
            keys: &["e_cv", "e_iv"],
            title: "`e_cv` must be above `e_iv`: complete vaporisation takes more than incipient",
        })
    }

    fn bulk_modulus(&self, _rho0: f64) -> f64 {
        self.bulk_modulus
    }

    fn spray_energy(&self) -> Option<f64> {
        (self.least_density > 0.0).then_some(self.e_cv)
    }

    fn at(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
        self.response(rho0, rho, e)
    }
}

impl Tillotson {
    /// Pressure and derivatives at density `rho` and specific energy `e` (J/kg), for the
    /// reference density `rho0` (kg/m³).
    #[inline]
    #[must_use]
    pub fn response(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
        let at = self.shared(rho0, rho, e);
        if at.mu >= 0.0 || e <= self.e_iv {
            return self.condensed(&at);
        }
        let vapour = self.vapour(&at);
        if e >= self.e_cv {
            return vapour;
        }
        let solid = self.condensed(&at);
        let span = self.e_cv - self.e_iv;
        let share = (e - self.e_iv) / span;
        let mix = |v: f64, s: f64| share * v + (1.0 - share) * s;
        PointResponse {
            pressure: mix(vapour.pressure, solid.pressure),
            dp_drho: mix(vapour.dp_drho, solid.dp_drho),
            dp_de: mix(vapour.dp_de, solid.dp_de) + (vapour.pressure - solid.pressure) / span,
        }
    }

    fn shared(&self, rho0: f64, rho: f64, e: f64) -> Shared {
        let eta = rho / rho0;
        // u = w − 1; d(e/w)/de = 1/w², d(ρ/w)/dρ = 1/w + 2 u/w² since du/dρ = −2 u/ρ.
        let u = e / (self.e0 * eta * eta);
        let (inverse, bent) = if u < LEAST {
            (1.0 / (LEAST + 1.0), 0.0)
        } else {
            (1.0 / (u + 1.0), u / (u + 1.0))
        };
        Shared {
            rho0,
            rho,
            e,
            mu: eta - 1.0,
            hot: PointResponse {
                pressure: self.b * rho * e * inverse,
                dp_drho: self.b * e * inverse * (1.0 + 2.0 * bent),
                dp_de: self.b * rho * inverse * (1.0 - bent),
            },
        }
    }

    fn condensed(&self, at: &Shared) -> PointResponse {
        let a = self.bulk_modulus;
        let b = if at.mu > 0.0 { self.quadratic_modulus } else { 0.0 };
        let response = PointResponse {
            pressure: self.a * at.rho * at.e + at.hot.pressure + at.mu * (a + b * at.mu),
            dp_drho: self.a * at.e + at.hot.dp_drho + (a + 2.0 * b * at.mu) / at.rho0,
            dp_de: self.a * at.rho + at.hot.dp_de,
        };
        self.cut(at, response)
    }

    fn vapour(&self, at: &Shared) -> PointResponse {
        let z = at.rho0 / at.rho - 1.0;
        let dz_drho = -at.rho0 / (at.rho * at.rho);
        let fade = libm::exp(-self.alpha * z * z);
        let cold = self.bulk_modulus * at.mu * libm::exp(-self.beta * z);
        let dcold_drho =
            self.bulk_modulus / at.rho0 * libm::exp(-self.beta * z) - self.beta * dz_drho * cold;
        let inner = at.hot.pressure + cold;
        let response = PointResponse {
            pressure: self.a * at.rho * at.e + inner * fade,
            dp_drho: self.a * at.e
                + (at.hot.dp_drho + dcold_drho - 2.0 * self.alpha * z * dz_drho * inner) * fade,
            dp_de: self.a * at.rho + at.hot.dp_de * fade,
        };
        self.cut(at, response)
    }

    /// None, of a branch that would bear tension below the least density.
    #[inline(always)]
    fn cut(&self, at: &Shared, response: PointResponse) -> PointResponse {
        if response.pressure < 0.0 && at.rho < self.least_density * at.rho0 {
            return PointResponse {
                pressure: 0.0,
                dp_drho: 0.0,
                dp_de: 0.0,
            };
        }
        response
    }
}
