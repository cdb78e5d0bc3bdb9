//! Strength of concrete after Riedel, Hiermaier and Thoma.
//!
//! With stresses and pressures over the compressive strength, `σ* = q/f_c`, `p* = p/f_c`, strengths `f_t*`, `f_s*` in
//! tension and in shear, and the factor F of the rate, failure begins at `f_c σ*(p*, F) R(θ, p*)`:
//!
//! ```text
//! σ* = A [p* − F/3 + (A/F)^(−1/N)]^N                      3p* ≥ F
//! σ* = F f_s*/Q₁ + 3p* (1 − f_s*/Q₁)                      F > 3p* ≥ 0
//! σ* = F f_s*/Q₁ − 3p* [1/Q₂ − f_s*/(Q₁ f_t*)]            0 > 3p* ≥ 3p_t*
//! p_t* = F Q₂ f_s* f_t*/3 (Q₁ f_t* − Q₂ f_s*)
//! ```
//!
//! `R(θ, Q)` of Willam & Warnke (1975) is 1 in compression and `Q = Q₀ + B ⟨p*⟩₊` in tension, `Q₁ = R(30°, Q₀)` and
//! `Q₂ = Q₀`. F is `(ε̇/ε̇_c)^β_c` in compression, `(ε̇/ε̇_t)^β_t` in tension, and linear in p* between. Flow begins at the share
//! `g_c` of failure in compression, `g_t` in tension, and hardens with the share ξ of the shear modulus for the slope of
//! stress over strain up to failure. From there on damage D takes it to the friction `B_f p*^M` of what is broken.
//!
//! Source: Riedel, Thoma, Hiermaier & Schmolinske (1999), *Penetration of reinforced concrete by BETA-B-500*, 9th Int. Symp.
//! Interaction of the Effects of Munitions with Structures, 315; with these branches Borrvall & Riedel (2011), *The RHT concrete
//! model in LS-DYNA*, 8th European LS-DYNA Users Conference. Without their cap, by which crushing pores take strength before
//! failure. Stress returns at constant pressure and Lode angle, and the strain at which hardening ends is that of the
//! meridian of compression.

use super::radial_return::{equivalent_stress, positive};
use super::{Conditions, Contradiction, LANES, Law, PointBatch, jaumann, strain_rates_squared};
use crate::{at_least, at_most};
use numerics::dispatch::{Vectorised, instructions};
use numerics::elementary::pow;
use numerics::lanes::{F64x8, Lanes};
use numerics::principal::principal;

law! {
    /// Elastic–plastic with the strength of concrete, by pressure, Lode angle and rate.
    RiedelHiermaierThoma {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Coefficient A of the failure surface.
        a: "",
        /// Exponent N of the failure surface.
        n: "",
        /// Compressive strength `f_c` of slow tests (Pa).
        compressive_strength: "Pa",
        /// Tensile strength `f_t*`, over `f_c`.
        tensile_ratio: "",
        /// Shear strength `f_s*`, over `f_c`.
        shear_ratio: "",
        /// Strength in tension over that in compression at zero pressure, `Q₀`.
        lode_ratio: "",
        /// Its growth B with the pressure over `f_c`.
        lode_slope: "",
        /// Share `g_c` of the compressive strength at which flow begins.
        elastic_compression: "",
        /// Share `g_t` of the tensile strength at which flow begins.
        elastic_tension: "",
        /// Share ξ of the shear modulus while flow hardens.
        hardening: "",
        /// Coefficient `B_f` of the friction of what is broken.
        b: "",
        /// Exponent M of that friction.
        m: "",
        /// Exponent `β_c` of the rate in compression.
        rate_compression: "",
        /// Exponent `β_t` of the rate in tension.
        rate_tension: "",
        /// Reference rate `ε̇_c` in compression (1/s).
        reference_compression: "1/s",
        /// Reference rate `ε̇_t` in tension (1/s).
        reference_tension: "1/s",
    }
}

/// `R(θ, Q)` of Willam and Warnke from the cosine of θ, which is 60° in triaxial compression.
fn lode_share(cosine: f64, q: f64) -> f64 {
    let wide = 4.0 * (1.0 - q * q) * cosine * cosine;
    let root = at_least(wide + 5.0 * q * q - 4.0 * q, 0.0).sqrt();
    let numerator = 2.0 * (1.0 - q * q) * cosine + (2.0 * q - 1.0) * root;
    numerator / (wide + (1.0 - 2.0 * q) * (1.0 - 2.0 * q))
}

impl RiedelHiermaierThoma {
    /// `Q` at a pressure over `f_c`: convex from ½ to 1, and `Q₀` in tension.
    fn lode(&self, pressed: f64) -> f64 {
        at_most(
            at_least(
                self.lode_ratio + self.lode_slope * at_least(pressed, 0.0),
                0.51,
            ),
            1.0,
        )
    }

    /// `Q₁`.
    fn shear_share(&self) -> f64 {
        lode_share(0.75_f64.sqrt(), self.lode(0.0))
    }

    /// `p_t*` at a factor of the rate of one.
    #[must_use]
    pub fn tension(&self) -> f64 {
        let (shear, tension) = (self.shear_share(), self.lode(0.0));
        let (f_s, f_t) = (self.shear_ratio, self.tensile_ratio);
        tension * f_s * f_t / (3.0 * (shear * f_t - tension * f_s))
    }

    /// The share `R(θ, p*)` of a deviator of the principal values `s` (Pa), at a pressure (Pa).
    #[must_use]
    pub fn share(&self, s: [f64; 3], pressure: f64) -> f64 {
        let q = self.lode(pressure / self.compressive_strength);
        let square = 0.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
        let size = square * square.sqrt();
        let triple = if size > 0.0 {
            1.5 * 3.0_f64.sqrt() * s[0] * s[1] * s[2] / size
        } else {
            -1.0
        };
        let angle = libm::acos(at_most(at_least(triple, -1.0), 1.0)) / 3.0;
        lode_share(libm::cos(angle), q)
    }
}

/// Factor of the rate of points with these squares of the deviatoric rates of deformation, `d':d'` (1/s²).
#[inline(always)]
fn rate_factor<V: Lanes>(square: &F64x8, reference: f64, exponent: f64) -> V {
    let rate = V::load(square).mul(V::splat(2.0 / 3.0)).sqrt();
    let ratio = rate.div(V::splat(reference)).max(V::splat(1.0));
    pow(ratio, V::splat(exponent))
}

/// Where x lies between two values, from 1 at the upper to 0 at the lower one.
#[inline(always)]
fn between<V: Lanes>(x: V, upper: V, lower: V) -> V {
    let place = x.sub(lower).div(upper.sub(lower));
    place.max(V::splat(0.0)).min(V::splat(1.0))
}

/// Factors of the rate in tension of eight points.
struct TensionRates<'a> {
    law: &'a RiedelHiermaierThoma,
    rate: &'a F64x8,
}

impl Vectorised for TensionRates<'_> {
    type Output = F64x8;

    #[inline(always)]
    fn run<V: Lanes>(self) -> F64x8 {
        let law = self.law;
        rate_factor::<V>(self.rate, law.reference_tension, law.rate_tension).store()
    }
}

/// Strengths of eight points in triaxial compression.
struct Strengths<'a> {
    law: &'a RiedelHiermaierThoma,
    /// Pressures (Pa).
    pressure: &'a super::Lanes,
    /// Squares of the deviatoric rates of deformation, `d':d'` (1/s²).
    rate: &'a F64x8,
}

impl Vectorised for Strengths<'_> {
    /// `p* − p_t*`, strength at failure and of what is broken (Pa), and the share of the former at which flow begins.
    type Output = [F64x8; 4];

    #[inline(always)]
    fn run<V: Lanes>(self) -> [F64x8; 4] {
        let law = self.law;
        let (zero, three) = (V::splat(0.0), V::splat(3.0));
        let least = V::splat(f64::MIN_POSITIVE);
        let unit = V::splat(law.compressive_strength);
        let pressed = V::read(self.pressure).div(unit);
        let threefold = pressed.mul(three);
        let fast: V = rate_factor(self.rate, law.reference_compression, law.rate_compression);
        let pulled: V = rate_factor(self.rate, law.reference_tension, law.rate_tension);
        let tensile = V::splat(law.tensile_ratio).mul(pulled);
        let compressed = between(threefold, fast, zero.sub(tensile));
        let factor = compressed.mul_add(fast.sub(pulled), pulled);
        let shear = law.shear_ratio / law.shear_share();
        let at_zero = factor.mul(V::splat(shear));
        let tip = factor.mul(V::splat(law.tension()));
        // (A/F)^(−1/N)
        let shift = pow(factor.div(V::splat(law.a)), V::splat(1.0 / law.n));
        let beyond = threefold.sub(factor).div(three).max(zero).add(shift);
        let high = pow(beyond.max(least), V::splat(law.n)).mul(V::splat(law.a));
        let middle = threefold.mul_add(V::splat(1.0 - shear), at_zero);
        let slope = 1.0 / law.lode(0.0) - shear / law.tensile_ratio;
        let low = threefold.neg_mul_add(V::splat(slope), at_zero).max(zero);
        let failure = if_positive(threefold.sub(factor), high, middle);
        let failure = if_positive(zero.sub(threefold), low, failure);
        let onset = {
            let upper = factor.mul(V::splat(law.elastic_compression));
            let lower = factor.mul(V::splat(-law.elastic_tension * law.tensile_ratio));
            let range = V::splat(law.elastic_compression - law.elastic_tension);
            between(threefold, upper, lower).mul_add(range, V::splat(law.elastic_tension))
        };
        let friction = pow(pressed.max(least), V::splat(law.m)).mul(positive(pressed));
        [
            pressed.sub(tip).max(zero).store(),
            failure.mul(unit).store(),
            friction.mul(V::splat(law.b)).mul(unit).store(),
            onset.store(),
        ]
    }
}

/// `yes` where `by` is above zero, else `no`.
#[inline(always)]
fn if_positive<V: Lanes>(by: V, yes: V, no: V) -> V {
    positive(by).mul_add(yes.sub(no), no)
}

impl Law for RiedelHiermaierThoma {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const FOLLOWS_STATE: bool = true;
    const KEEPS_FRICTION: bool = true;
    const BOUNDS_TENSION: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        (self.shear_share() * self.tensile_ratio >= self.lode(0.0) * self.shear_ratio).then_some(
            Contradiction {
                keys: &["tensile_ratio", "shear_ratio"],
                title: "the failure surface does not close in tension: `tensile_ratio` must be lower, or `shear_ratio` higher",
            },
        )
    }

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    /// That of uniaxial compression.
    fn yield_stress(&self) -> f64 {
        self.elastic_compression * self.compressive_strength
    }

    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch, _softens: bool) {
        let most = self.tension() * self.compressive_strength;
        if point.pressure.iter().all(|&p| p >= most) {
            return;
        }
        let factor = instructions().run(TensionRates {
            law: self,
            rate: &F64x8(strain_rates_squared(point)),
        });
        for k in 0..LANES {
            point.pressure[k] = at_least(point.pressure[k], most * factor.0[k]);
        }
    }

    /// The strengths at pressure and rate.
    #[inline(never)]
    fn soften(&self, point: &PointBatch, now: &mut Conditions) {
        let mut onset = [1.0; LANES];
        now.curves.follow(point, |rate| {
            let [above, intact, fractured, share] = instructions().run(Strengths {
                law: self,
                pressure: &point.pressure,
                rate,
            });
            onset = share.0;
            [above, intact, fractured]
        });
        let softer = (1.0 - self.hardening) / (3.0 * self.hardening * self.shear_modulus);
        for k in 0..LANES {
            now.curves.onset[k] = onset[k];
            now.curves.hardened[k] = softer * (1.0 - onset[k]) * now.curves.intact[k];
        }
    }

    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        jaumann::deform(point, now);
    }

    /// Return at constant pressure and Lode angle, lane by lane where matter may flow.
    #[inline(never)]
    fn flow(&self, point: &mut PointBatch, now: &Conditions) {
        if now.dt == 0.0 {
            return;
        }
        let curves = &now.curves;
        for k in 0..LANES {
            let q = equivalent_stress(point, k);
            let (damage, pressure) = (point.damage[k], point.pressure[k]);
            let whole = (1.0 - damage) * curves.intact[k];
            let broken = damage * curves.fractured[k];
            let least = self.lode(pressure / self.compressive_strength) * curves.onset[k];
            if q <= now.softening[k] * (least * whole + broken) {
                continue;
            }
            let s = &mut point.deviatoric_stress;
            let (values, _) = principal(&s.each_ref().map(|component| component[k]));
            let failure = whole * self.share(values, pressure);
            let begins = now.softening[k] * (curves.onset[k] * failure + broken);
            let ends = now.softening[k] * (failure + broken);
            let three_g = 3.0 * now.shear_modulus[k];
            let left = curves.hardened[k] - point.plastic_strain[k];
            let (mut strength, mut slope) = (ends, 0.0);
            if left > 0.0 {
                slope = (ends - begins) / curves.hardened[k];
                strength = ends - slope * left;
            }
            if q <= strength {
                continue;
            }
            let mut increment = (q - strength) / (three_g + slope);
            if left > 0.0 && increment > left {
                increment = (q - ends) / three_g;
            }
            let scale = at_least(q - three_g * increment, 0.0) / q;
            for component in s.iter_mut() {
                component[k] *= scale;
            }
            point.plastic_strain[k] += increment;
        }
    }
}
