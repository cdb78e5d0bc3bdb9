//! Lundborg's strength of intact rock: it grows with pressure towards a limit.
//!
//! Matter yields where `√J₂` reaches
//!
//! ```text
//! Y = Y₀ + μ p/[1 + μ p/(Y_m − Y₀)]   (p ≥ 0),    Y₀ + μ p   (−Y₀/μ ≤ p < 0)
//! ```
//!
//! Source: Lundborg (1968), *Strength of rock-like materials*, Int. J. Rock Mech. Min. Sci. 5, 427,
//! as a law of √J₂ and of the pressure Collins, Melosh & Ivanov (2004), Meteorit. Planet. Sci. 39,
//! 217. The straight line below zero has the slope of the curve there.
//!
//! Stress returns at constant pressure. Tension ends where the strength does. Damage takes its
//! share of Y₀, `(1 − D) Y₀`, and friction stays.

use super::drucker_prager::{ROOT_3, limit_at_tip, to_shear_strength};
use super::{Conditions, Contradiction, Law, PointBatch, jaumann};
use crate::{at_least, at_most};

law! {
    /// Elastic–plastic with a shear strength that grows with pressure towards a limit.
    Lundborg {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Shear strength Y₀ at zero pressure, compared with √J₂ (Pa).
        cohesion: "Pa",
        /// Slope μ of the shear strength over the pressure, at zero pressure.
        friction: "",
        /// Limit `Y_m` of the shear strength at high pressure (Pa).
        max_strength: "Pa",
    }
}

/// Lundborg's curve (Pa) at a pressure (Pa), from `[Y₀ (Pa), μ, Y_m (Pa)]`; `cohesion` (Pa) is what damage leaves
/// of Y₀.
#[inline(always)]
pub(super) fn curve(pressure: f64, [y0, friction, limit]: [f64; 3], cohesion: f64) -> f64 {
    let pressed = friction * at_least(pressure, 0.0);
    let pulled = friction * at_most(pressure, 0.0);
    at_least(
        cohesion + pressed / (1.0 + pressed / (limit - y0)) + pulled,
        0.0,
    )
}

/// Contradiction of the constants of a curve.
pub(super) fn contradiction(cohesion: f64, limit: f64) -> Option<Contradiction> {
    (limit <= cohesion).then_some(Contradiction {
        keys: &["max_strength", "cohesion"],
        title: "`max_strength` must be above `cohesion`",
    })
}

impl Lundborg {
    /// Shear strength (Pa) at a pressure (Pa) and damage.
    #[inline(always)]
    #[must_use]
    pub fn shear_strength(&self, pressure: f64, damage: f64) -> f64 {
        let constants = [self.cohesion, self.friction, self.max_strength];
        curve(pressure, constants, self.cohesion * (1.0 - damage))
    }
}

impl Law for Lundborg {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const FOLLOWS_STATE: bool = true;
    const KEEPS_FRICTION: bool = true;
    const BOUNDS_TENSION: bool = true;

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
