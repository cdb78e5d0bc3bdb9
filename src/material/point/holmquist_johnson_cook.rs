//! Strength of concrete after Holmquist, Johnson and Cook.
//!
//! With stresses and pressures over the compressive strength, `σ* = q/f_c`, `p* = p/f_c`, and rates
//! over a reference rate,
//!
//! ```text
//! σ* = min{[A (1 − D) + B p*^N] (1 + C ln ε̇*), S_max}   (p ≥ 0)
//! σ* = A (1 − D) (1 + p/T) (1 + C ln ε̇*)                (−T ≤ p < 0)
//! ```
//!
//! Source: Holmquist, Johnson & Cook (1993), *A computational constitutive model for concrete
//! subjected to large strains, high strain rates, and high pressures*, 14th Int. Symp. Ballistics,
//! 591; below zero pressure as the manual of IMPETUS Afea states it. The rate is the equivalent one
//! of all deformation, elastic too; below the reference rate it counts as that.
//!
//! Stress returns at constant pressure, and tension ends at T, of which
//! [`FrictionKept`](super::Effect::FrictionKept) leaves `T (1 − D)`. How pores crush says
//! [`HolmquistJohnsonCookCompaction`](crate::HolmquistJohnsonCookCompaction).

use super::radial_return::{positive, to_flow_stress};
use super::{Conditions, LANES, Law, PointBatch, jaumann};
use crate::{at_least, at_most};
use numerics::dispatch::{Vectorised, instructions};
use numerics::elementary::{ln, pow};
use numerics::lanes::{F64x8, Lanes};

law! {
    /// Elastic–plastic with the strength of concrete.
    HolmquistJohnsonCook {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Strength A that damage takes, over `f_c`.
        a: "",
        /// Coefficient B of the pressure, over `f_c`.
        b: "",
        /// Rate coefficient C.
        c: "",
        /// Exponent N of the pressure.
        n: "",
        /// Compressive strength `f_c` of slow tests (Pa).
        compressive_strength: "Pa",
        /// Largest tension T: the pressure does not fall below −T (Pa).
        max_tension: "Pa",
        /// Largest strength `S_max`, over `f_c`.
        max_strength: "",
        /// Reference strain rate (1/s).
        reference_rate: "1/s",
    }
}

/// Strengths of eight points, before their largest one.
struct Strengths<'a> {
    law: &'a HolmquistJohnsonCook,
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
        let strength = V::splat(law.compressive_strength);
        let pressure = V::read(self.pressure);
        let pressed = pressure.max(zero).div(strength);
        let above = pressure.add(V::splat(law.max_tension)).div(strength);
        let mut fast = strength;
        if law.c > 0.0 {
            let rate = V::load(self.rate).mul(V::splat(2.0 / 3.0)).sqrt();
            let ratio = rate.div(V::splat(law.reference_rate)).max(one);
            fast = ln(ratio).mul_add(V::splat(law.c), one).mul(strength);
        }
        let power = pow(pressed.max(least), V::splat(law.n)).mul(positive(pressed));
        let fractured = power.mul(V::splat(law.b)).mul(fast);
        let mut share = one;
        if law.max_tension > 0.0 {
            let pulled = pressure.min(zero).div(V::splat(law.max_tension));
            share = pulled.add(one).max(zero);
        }
        let cohesion = share.mul(V::splat(law.a)).mul(fast);
        let above = above.max(zero).store();
        [above, cohesion.add(fractured).store(), fractured.store()]
    }
}

impl Law for HolmquistJohnsonCook {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const FOLLOWS_STATE: bool = true;
    const KEEPS_FRICTION: bool = true;
    const BOUNDS_TENSION: bool = true;

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    /// That at zero pressure.
    fn yield_stress(&self) -> f64 {
        self.a * self.compressive_strength
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
        let most = self.max_strength * self.compressive_strength;
        let mut flow_stress = [0.0; LANES];
        for k in 0..LANES {
            let strength = at_most(now.curves.at(k, point.damage[k]), most);
            flow_stress[k] = now.softening[k] * strength;
        }
        to_flow_stress(point, now, &flow_stress);
    }
}
