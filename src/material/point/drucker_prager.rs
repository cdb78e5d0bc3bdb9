//! Drucker–Prager plasticity: a shear strength that grows linearly with pressure up to a limit.
//!
//! Matter yields where `√J₂ = q/√3`, with `q = √(3/2 S:S)`, reaches
//!
//! ```text
//! Y = min(c + μ p, Y_max),    p ≥ −c/μ
//! ```
//!
//! Source: Drucker & Prager (1952), *Soil mechanics and plastic analysis or limit design*, Q. Appl.
//! Math. 10, 157, with `k = c` and `3 α = μ`; the limit as in Collins, Melosh & Ivanov (2004),
//! Meteorit. Planet. Sci. 39, 217. The cone through the edges of a Mohr–Coulomb pyramid of cohesion
//! `c'` and friction angle φ that are those of triaxial compression has
//!
//! ```text
//! c = 6 c' cos φ/[√3 (3 − sin φ)],    μ = 6 sin φ/[√3 (3 − sin φ)].
//! ```
//!
//! Stress returns at constant pressure, so plastic flow changes no volume. Tension ends at the tip
//! of the cone: matter without cohesion bears none. Damage takes its share of the cohesion,
//! `c (1 − D)`.

use super::radial_return::to_flow_stress;
use super::{Conditions, Contradiction, LANES, Law, PointBatch, jaumann};
use crate::{at_least, at_most};

/// √3: equivalent stress q over √J₂.
pub(super) const ROOT_3: f64 = 1.732_050_807_568_877_2;

law! {
    /// Elastic–plastic with a shear strength that is linear in the pressure up to a limit.
    DruckerPrager {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Shear strength c at zero pressure, compared with √J₂ (Pa).
        cohesion: "Pa",
        /// Slope μ of the shear strength over the pressure.
        friction: "",
        /// Largest shear strength `Y_max` (Pa); zero for no limit.
        max_strength: "Pa",
    }
}

impl DruckerPrager {
    /// Shear strength (Pa) at a pressure (Pa) and damage.
    #[inline(always)]
    #[must_use]
    pub fn shear_strength(&self, pressure: f64, damage: f64) -> f64 {
        let cohesion = self.cohesion * (1.0 - damage);
        let strength = at_least(cohesion + self.friction * pressure, 0.0);
        if self.max_strength > 0.0 {
            at_most(strength, self.max_strength)
        } else {
            strength
        }
    }
}

/// Bounds the pressure at the tip of a cone of this cohesion (Pa) and slope.
#[inline(always)]
pub(super) fn limit_at_tip(point: &mut PointBatch, cohesion: f64, friction: f64) {
    let tip = if friction > 0.0 {
        -cohesion / friction
    } else {
        f64::NEG_INFINITY
    };
    for k in 0..LANES {
        point.pressure[k] = at_least(point.pressure[k], tip);
    }
}

/// Returns eight points at constant pressure to the shear strengths (Pa), compared with √J₂, of their pressures (Pa) and
/// damage.
#[inline(always)]
pub(super) fn to_shear_strength(
    point: &mut PointBatch,
    now: &Conditions,
    shear_strength: impl Fn(f64, f64) -> f64,
) {
    if now.dt == 0.0 {
        return;
    }
    let mut flow_stress = [0.0; LANES];
    for k in 0..LANES {
        let strength = shear_strength(point.pressure[k], point.damage[k]);
        flow_stress[k] = ROOT_3 * now.softening[k] * strength;
    }
    to_flow_stress(point, now, &flow_stress);
}

impl Law for DruckerPrager {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const FOLLOWS_STATE: bool = true;
    const KEEPS_FRICTION: bool = true;
    const BOUNDS_TENSION: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        let limited = self.max_strength > 0.0;
        (limited && self.max_strength < self.cohesion).then_some(Contradiction {
            keys: &["max_strength", "cohesion"],
            title: "`max_strength` must not be below `cohesion`",
        })
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
