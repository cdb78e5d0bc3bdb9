//! Strength of ceramics and glass, intact and fractured, after Johnson and Holmquist.
//!
//! With stresses over that at the Hugoniot elastic limit, `σ* = q/σ_HEL`, pressures over its
//! pressure, `p* = p/p_HEL`, `T* = T/p_HEL`, and rates over a reference rate,
//!
//! ```text
//! σ*_i = A (p* + T*)^N (1 + C ln ε̇*),    σ*_f = min[B p*^M (1 + C ln ε̇*), σ*_max],
//! σ* = σ*_i − D (σ*_i − σ*_f),    σ_HEL = 1.5 (HEL − p_HEL)
//! ```
//!
//! Source: Johnson & Holmquist (1994), *An improved computational constitutive model for brittle
//! materials*, AIP Conf. Proc. 309, 981. The rate is the equivalent one of all deformation, elastic
//! too; below the reference rate it counts as that.
//!
//! Stress returns at constant pressure, and tension ends at T, of which
//! [`FrictionKept`](super::Effect::FrictionKept) leaves `T (1 − D)`. Damage and the pressure by bulking are those of
//! [`JohnsonHolmquist2Failure`](super::JohnsonHolmquist2Failure), which reads the two strengths from the [`Conditions`].

use super::radial_return::{positive, to_flow_stress};
use super::{Conditions, Contradiction, LANES, Law, PointBatch, jaumann};
use crate::at_least;
use numerics::dispatch::{Vectorised, instructions};
use numerics::elementary::{ln, pow};
use numerics::lanes::{F64x8, Lanes};

law! {
    /// Elastic–plastic with the strengths of an intact and of a fractured ceramic.
    JohnsonHolmquist2 {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Intact strength A, over `σ_HEL`.
        a: "",
        /// Fractured strength B, over `σ_HEL`.
        b: "",
        /// Rate coefficient C.
        c: "",
        /// Exponent M of the fractured strength.
        m: "",
        /// Exponent N of the intact strength.
        n: "",
        /// Largest tension T: the pressure does not fall below −T (Pa).
        max_tension: "Pa",
        /// Hugoniot elastic limit, HEL (Pa).
        hugoniot_limit: "Pa",
        /// Pressure at the Hugoniot elastic limit, `p_HEL` (Pa).
        hugoniot_pressure: "Pa",
        /// Largest fractured strength over `σ_HEL`; zero for no limit.
        max_fractured: "",
        /// Reference strain rate (1/s).
        reference_rate: "1/s",
    }
}

impl JohnsonHolmquist2 {
    /// Equivalent stress (Pa) at the Hugoniot elastic limit.
    #[inline(always)]
    #[must_use]
    pub fn limit_stress(&self) -> f64 {
        1.5 * (self.hugoniot_limit - self.hugoniot_pressure)
    }
}

/// Strengths of eight points.
struct Strengths<'a> {
    law: &'a JohnsonHolmquist2,
    /// Pressures (Pa).
    pressure: &'a super::Lanes,
    /// Squares of the deviatoric rates of deformation, `d':d'` (1/s²).
    rate: &'a F64x8,
}

impl Vectorised for Strengths<'_> {
    /// `p* + T*`, intact and fractured strength (Pa).
    type Output = [F64x8; 3];

    #[inline(always)]
    fn run<V: Lanes>(self) -> [F64x8; 3] {
        let law = self.law;
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let least = V::splat(f64::MIN_POSITIVE);
        let scale = V::splat(1.0 / law.hugoniot_pressure);
        let pressure = V::read(self.pressure);
        let above = pressure.add(V::splat(law.max_tension)).mul(scale).max(zero);
        let pressed = pressure.mul(scale).max(zero);
        let limit = V::splat(law.limit_stress());
        let mut fast = one;
        if law.c > 0.0 {
            let rate = V::load(self.rate).mul(V::splat(2.0 / 3.0)).sqrt();
            let ratio = rate.div(V::splat(law.reference_rate)).max(one);
            fast = ln(ratio).mul_add(V::splat(law.c), one);
        }
        let intact = pow(above.max(least), V::splat(law.n)).mul(positive(above));
        let intact = intact.mul(V::splat(law.a)).mul(fast).mul(limit);
        let mut fractured = zero;
        if law.b > 0.0 {
            let power = pow(pressed.max(least), V::splat(law.m)).mul(positive(pressed));
            fractured = power.mul(V::splat(law.b)).mul(fast);
            if law.max_fractured > 0.0 {
                fractured = fractured.min(V::splat(law.max_fractured));
            }
            fractured = fractured.mul(limit);
        }
        [above.store(), intact.store(), fractured.store()]
    }
}

impl Law for JohnsonHolmquist2 {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const FOLLOWS_STATE: bool = true;
    const KEEPS_FRICTION: bool = true;
    const BOUNDS_TENSION: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        (self.hugoniot_limit <= self.hugoniot_pressure).then_some(Contradiction {
            keys: &["hugoniot_limit", "hugoniot_pressure"],
            title: "`hugoniot_limit` must be above `hugoniot_pressure`",
        })
    }

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    /// That at zero pressure.
    fn yield_stress(&self) -> f64 {
        let above = self.max_tension / self.hugoniot_pressure;
        self.limit_stress() * self.a * libm::pow(above, self.n)
    }

    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch, _softens: bool) {
        for k in 0..LANES {
            point.pressure[k] = at_least(point.pressure[k], -self.max_tension);
        }
    }

    /// The strengths at pressure and rate.
    #[inline(never)]
    fn soften(&self, point: &PointBatch, now: &mut Conditions) {
        now.curves.follow(point, |rate| {
            instructions().run(Strengths {
                law: self,
                pressure: &point.pressure,
                rate,
            })
        });
    }

    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        jaumann::deform(point, now);
    }

    /// Return at constant pressure.
    #[inline(always)]
    fn flow(&self, point: &mut PointBatch, now: &Conditions) {
        if now.dt == 0.0 {
            return;
        }
        let mut flow_stress = [0.0; LANES];
        for k in 0..LANES {
            flow_stress[k] = now.softening[k] * now.curves.at(k, point.damage[k]);
        }
        to_flow_stress(point, now, &flow_stress);
    }
}
