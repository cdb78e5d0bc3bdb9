//! Mie–Grüneisen equation of state about a Hugoniot.
//!
//! With `μ = ρ/ρ₀ − 1`, in compression (`μ > 0`)
//!
//! ```text
//! p = ρ₀ c₀² N / D² + (γ₀ + b μ) ρ₀ e
//! N = μ [1 + (1 − γ₀/2) μ − (b/2) μ²]
//! D = 1 − (s₁ − 1) μ − s₂ μ²/(μ + 1) − s₃ μ³/(μ + 1)²
//! ```
//!
//! and in expansion `p = ρ₀ c₀² μ + f(μ) ρ₀ e`, with the specific energy e per mass. Sources:
//! Steinberg (1991), *Equation of state and strength properties of selected materials*,
//! UCRL-MA-106439; in this notation LS-DYNA's `*EOS_GRUNEISEN`.
//!
//! # Expansion
//!
//! LS-DYNA keeps `f = γ₀ + b μ` in all expansion, and so does this down to [`DENSE`] of the
//! reference density. Spray of a tenth of it would then have the thermal pressure of dense matter,
//! and would be heated by `exp(γ₀ ρ₀ (1/ρ₁ − 1/ρ₂))` as it is pressed from ρ₁ to ρ₂: 2·10⁶ times from
//! .1 to .38. So below, f is the cubic of the same value and slope there that ends in the thermal
//! pressure of a monatomic gas, `Γ ρ e` with Γ = 2/3 (γ₀ if that is less), where matter is thin.
//!
//! # Strong compression
//!
//! The fit has an end. N, the cold part, turns down beyond a `μ_N` where `dN/dμ = 0`, and D has a
//! zero (at `μ = 1/(s₁ − 1)` for a straight Hugoniot) beyond which the pressure would fall again.
//! So N keeps its largest value beyond `μ_N`, and D stays at or above [`SMALLEST_DENOMINATOR`]: the
//! pressure stays continuous and finite, and never falls with density while `s₁ ≥ 1` and `s₂, s₃ ≥
//! 0`. For aluminium 2024, `μ_N = 1.18` is reached by the shock of a symmetric impact at 21 km/s;
//! the floor of D lies at `μ = 2.66`.

use super::{EquationOfState, PointResponse, Response};
use crate::{LANES, Lanes, at_least, at_most};

/// Grüneisen parameter of a monatomic gas.
const THIN: f64 = 2.0 / 3.0;
/// Density down to which pressure is linear in density, over that of the reference state. Matter
/// that bears no more tension than solids do is denser.
pub const DENSE: f64 = 0.75;

/// Smallest value of the Hugoniot denominator D.
pub const SMALLEST_DENOMINATOR: f64 = 0.1;

law! {
    /// Mie–Grüneisen with a cubic Hugoniot and a Grüneisen parameter linear in the compression.
    MieGruneisen {
        /// Bulk sound speed c₀ in the reference state (m/s).
        c0: "m/s",
        /// Coefficient s₁ of the Hugoniot `U = c₀ + [s₁ + s₂ u/U + s₃ (u/U)²] u` of shock speed U
        /// and particle velocity u.
        s1: "",
        /// Coefficient s₂ of the Hugoniot (0 for a straight one).
        s2: "",
        /// Coefficient s₃ of the Hugoniot (0 for a straight one).
        s3: "",
        /// Grüneisen parameter γ₀ in the reference state.
        gamma0: "",
        /// Coefficient b in `ρ₀ (γ₀ + b μ)`, the pressure per specific energy, with `μ = ρ/ρ₀ − 1`.
        b: "",
    }
}

/// End of the growth of the numerator N of a [`MieGruneisen`]; the same for all points.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    mu_n: f64,
}

impl EquationOfState for MieGruneisen {
    fn bulk_modulus(&self, rho0: f64) -> f64 {
        rho0 * self.c0 * self.c0
    }

    #[inline(always)]
    fn linear_density(&self, rho0: f64, rho: f64) -> f64 {
        at_least(rho, DENSE * rho0)
    }

    fn at(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
        self.response(rho0, rho, e)
    }

    #[inline(always)]
    fn of_batch(&self, rho0: f64, rho: &Lanes, e: &Lanes) -> Response {
        let bounds = self.bounds();
        // A loop and no closure, which may be compiled apart from its caller, without its instructions.
        let mut response = Response::default();
        for k in 0..LANES {
            response.set(k, self.bounded_response(bounds, rho0, rho[k], e[k]));
        }
        response
    }
}

impl MieGruneisen {
    /// Pressure and derivatives at density `rho` and specific energy `e` (J/kg), for the
    /// reference density `rho0` (kg/m³).
    #[must_use]
    pub fn response(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
        self.bounded_response(self.bounds(), rho0, rho, e)
    }

    /// The positive root of `dN/dμ = 1 + 2 a μ − (3 b/2) μ²`, `a = 1 − γ₀/2`; infinite if none.
    fn bounds(&self) -> Bounds {
        let a = 1.0 - 0.5 * self.gamma0;
        let discriminant = 4.0 * a * a + 6.0 * self.b;
        let mu_n = if discriminant < 0.0 {
            f64::INFINITY
        } else {
            let denominator = discriminant.sqrt() - 2.0 * a;
            if denominator > 0.0 {
                2.0 / denominator
            } else {
                f64::INFINITY
            }
        };
        Bounds { mu_n }
    }

    /// [`Self::response`] with the bounds at hand; selects only, so that lanes vectorise.
    #[inline(always)]
    fn bounded_response(
        &self,
        bounds: Bounds,
        rho0: f64,
        rho: f64,
        e: f64,
    ) -> PointResponse {
        let mu = rho / rho0 - 1.0;
        let (n, dn) = self.numerator(at_most(mu, bounds.mu_n));
        let dn = if mu > bounds.mu_n { 0.0 } else { dn };
        let (d_raw, dd) = self.denominator(mu);
        let d = at_least(d_raw, SMALLEST_DENOMINATOR);
        let dd = if d_raw < SMALLEST_DENOMINATOR {
            0.0
        } else {
            dd
        };

        let inverse = 1.0 / d;
        let cold = n * inverse * inverse;
        let dcold = (dn - 2.0 * n * dd * inverse) * inverse * inverse;
        let compressed = mu > 0.0;
        let cold = if compressed { cold } else { mu };
        let dcold = if compressed { dcold } else { 1.0 };

        let c0_squared = self.c0 * self.c0;
        let linear = self.gamma0 + self.b * mu;
        let (f, df) = self.thin(mu);
        let dense = mu >= DENSE - 1.0;
        let dp_de = rho0 * if dense { linear } else { f };
        PointResponse {
            pressure: rho0 * c0_squared * cold + dp_de * e,
            dp_drho: c0_squared * dcold + if dense { self.b } else { df } * e,
            dp_de,
        }
    }

    /// `f` of thin matter and `df/dμ`: Hermite's cubic in `t = (1 + μ)/DENSE`.
    #[inline(always)]
    fn thin(&self, mu: f64) -> (f64, f64) {
        let end = self.gamma0 + self.b * (DENSE - 1.0);
        let (first, last) = (at_most(self.gamma0, THIN) * DENSE, self.b * DENSE);
        let square = 3.0 * end - 2.0 * first - last;
        let cubic = first + last - 2.0 * end;
        let t = (1.0 + mu) / DENSE;
        let f = t * (first + t * (square + t * cubic));
        let df = first + t * (2.0 * square + 3.0 * t * cubic);
        (f, df / DENSE)
    }

    /// N and dN/dμ.
    #[inline(always)]
    fn numerator(&self, mu: f64) -> (f64, f64) {
        let a = 1.0 - 0.5 * self.gamma0;
        let n = mu * (1.0 + mu * (a - 0.5 * self.b * mu));
        let dn = 1.0 + mu * (2.0 * a - 1.5 * self.b * mu);
        (n, dn)
    }

    /// D and dD/dμ, without floor.
    #[inline(always)]
    fn denominator(&self, mu: f64) -> (f64, f64) {
        let x = mu / (mu + 1.0);
        let d = 1.0 - mu * (self.s1 - 1.0 + x * (self.s2 + x * self.s3));
        let dd = 1.0 - self.s1 - x * (self.s2 * (2.0 - x) + self.s3 * x * (3.0 - 2.0 * x));
        (d, dd)
    }
}
