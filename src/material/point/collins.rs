//! Strength of rock, intact and damaged, after Collins, Melosh and Ivanov.
//!
//! Matter yields where `√J₂` reaches
//!
//! ```text
//! Y = [(1 − D) Y_i + D Y_d] tanh[ξ (T_m/T − 1)],
//! Y_i = Y_i0 + μ_i p/[1 + μ_i p/(Y_m − Y_i0)],    Y_d = min(Y_d0 + μ_d p, Y_dm, Y_i)
//! ```
//!
//! with the damage D of the material's laws of failure: intact rock has [Lundborg's](super::lundborg)
//! curve, rock that has failed the friction of its pieces. Source: Collins, Melosh & Ivanov (2004),
//! *Modeling damage and deformation in impact simulations*, Meteorit. Planet. Sci. 39, 217,
//! appendix; softening by heat after Ohnaka (1995), *A shear failure strength law of rock in the
//! brittle-plastic transition regime*, Geophys. Res. Lett. 22, 25. The melting temperature may
//! grow with pressure by Simon's law (Poirier 1991, *Introduction to the physics of the Earth's
//! interior*, section 5.2),
//!
//! ```text
//! T_m = T_m0 (1 + p/a)^{1/c}.
//! ```
//!
//! Below zero pressure the curves go on as straight lines. Stress returns at constant pressure.
//! Tension ends at `−Y_i0/μ_i`, before what failure leaves of it.

use super::drucker_prager::{ROOT_3, limit_at_tip, to_shear_strength};
use super::lundborg::{contradiction, curve};
use super::{Conditions, Contradiction, LANES, Law, PointBatch, jaumann};
use crate::{at_least, at_most};
use numerics::dispatch::{Vectorised, instructions};
use numerics::elementary::{exp, pow};
use numerics::lanes::{F64x8, Lanes};

/// Argument from which on the hyperbolic tangent is one.
const ONE: f64 = 20.0;
/// Temperature (K) below which matter is no stronger.
const COLD: f64 = 1.0;

law! {
    /// Elastic–plastic with the shear strengths of intact and of damaged rock.
    Collins {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Shear strength `Y_i0` of intact rock at zero pressure, compared with √J₂ (Pa).
        cohesion: "Pa",
        /// Its slope `μ_i` over the pressure, at zero pressure.
        friction: "",
        /// Its limit `Y_m` at high pressure (Pa).
        max_strength: "Pa",
        /// Shear strength `Y_d0` of damaged rock at zero pressure (Pa).
        damaged_cohesion: "Pa",
        /// Its slope `μ_d` over the pressure.
        damaged_friction: "",
        /// Its limit `Y_dm` (Pa); zero for that of intact rock.
        damaged_max_strength: "Pa",
        /// Coefficient ξ of softening by heat; zero for none.
        softening: "",
        /// Scale a of the pressure in Simon's law (Pa); zero for a melting temperature that does not follow it.
        simon_a: "Pa",
        /// Exponent c of Simon's law.
        simon_c: "",
    }
}

impl Collins {
    /// Shear strength (Pa) of cold rock at a pressure (Pa) and damage.
    #[inline(always)]
    #[must_use]
    pub fn shear_strength(&self, pressure: f64, damage: f64) -> f64 {
        let constants = [self.cohesion, self.friction, self.max_strength];
        let intact = curve(pressure, constants, self.cohesion);
        let limit = if self.damaged_max_strength > 0.0 {
            self.damaged_max_strength
        } else {
            self.max_strength
        };
        let line = self.damaged_cohesion + self.damaged_friction * pressure;
        let damaged = at_most(at_most(at_least(line, 0.0), limit), intact);
        (1.0 - damage) * intact + damage * damaged
    }

    /// Melting temperature (K) at a pressure (Pa), from that at zero pressure (K).
    #[must_use]
    pub fn melting_at(&self, melting: f64, pressure: f64) -> f64 {
        if self.simon_a > 0.0 && pressure > 0.0 {
            melting * libm::pow(1.0 + pressure / self.simon_a, 1.0 / self.simon_c)
        } else {
            melting
        }
    }
}

/// `tanh[ξ (T_m/T − 1)]` of eight points.
struct Softening<'a> {
    law: &'a Collins,
    /// Melting temperature at zero pressure (K).
    melting: f64,
    /// K
    temperature: F64x8,
    /// Pressures above zero (Pa).
    pressure: F64x8,
    /// True if a point has such a pressure, and it tells in the melting temperature.
    pressed: bool,
}

impl Vectorised for Softening<'_> {
    type Output = F64x8;

    #[inline(always)]
    fn run<V: Lanes>(self) -> F64x8 {
        let one = V::splat(1.0);
        let mut melting = V::splat(self.melting);
        if self.pressed {
            let scale = V::splat(self.law.simon_a);
            let ratio = V::load(&self.pressure).div(scale).add(one);
            melting = melting.mul(pow(ratio, V::splat(1.0 / self.law.simon_c)));
        }
        let above = melting.div(V::load(&self.temperature)).sub(one);
        let x = above.mul(V::splat(self.law.softening));
        let x = x.max(V::splat(0.0)).min(V::splat(ONE));
        let fades = exp(x.mul(V::splat(-2.0)));
        one.sub(fades).div(one.add(fades)).store()
    }
}

impl Law for Collins {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const FOLLOWS_STATE: bool = true;
    const KEEPS_FRICTION: bool = true;
    const BOUNDS_TENSION: bool = true;

    fn needs_temperature(&self) -> bool {
        self.softening > 0.0
    }

    fn needs_melting(&self) -> bool {
        self.softening > 0.0
    }

    fn contradiction(&self) -> Option<Contradiction> {
        contradiction(self.cohesion, self.max_strength)
    }

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    fn yield_stress(&self) -> f64 {
        ROOT_3 * self.cohesion
    }

    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch, _softens: bool) {
        limit_at_tip(point, self.cohesion, self.friction);
    }

    /// Softening by heat.
    #[inline(never)]
    fn soften(&self, point: &PointBatch, now: &mut Conditions) {
        let Some(melting) = now.thermal.melting_temperature else {
            return;
        };
        if self.softening == 0.0 {
            return;
        }
        let (mut temperature, mut pressure) = (F64x8([0.0; LANES]), F64x8([0.0; LANES]));
        for k in 0..LANES {
            temperature.0[k] = at_least(now.temperature[k], COLD);
            pressure.0[k] = at_least(point.pressure[k], 0.0);
        }
        let pressed = self.simon_a > 0.0 && pressure.0 != [0.0; LANES];
        let softening = Softening {
            law: self,
            melting,
            temperature,
            pressure,
            pressed,
        };
        now.softening = instructions().run(softening).0;
    }

    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        jaumann::deform(point, now);
    }

    /// Return at constant pressure.
    #[inline(always)]
    fn flow(&self, point: &mut PointBatch, now: &Conditions) {
        to_shear_strength(point, now, |p, damage| self.shear_strength(p, damage));
    }
}
