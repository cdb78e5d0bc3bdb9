//! Mohr–Coulomb plasticity: friction in the plane where shear over pressure is largest.
//!
//! With principal stresses `σ₁ ≥ σ₂ ≥ σ₃`, tension positive, cohesion c and friction angle φ of
//! `tan φ = μ`, and with a bound T of tension,
//!
//! ```text
//! (σ₁ − σ₃) + (σ₁ + σ₃) sin φ ≤ 2 c cos φ,    σ₁ ≤ T
//! ```
//!
//! Source: Coulomb (1773) and Mohr (1900); in this form de Souza Neto, Perić & Owen (2008),
//! *Computational methods for plasticity*, section 6.3; the bound is Rankine's. This is the whole
//! hexagon, and not a circle about it or inside it.
//!
//! Both conditions are linear in S at a given pressure. A trial stress outside scales to the surface,
//! so that its pressure and its Lode angle stay: flow changes no volume and has the direction of S.
//! The pressure stays above that of the tip, `−min(c cot φ, T)`. Damage takes its share of c and of
//! T, `1 − D`.

use super::radial_return::equivalent_stress;
use super::{Conditions, LANES, Law, PointBatch, jaumann};
use crate::{at_least, at_most};
use numerics::principal::principal;

law! {
    /// Elastic–plastic inside the hexagon of Mohr and Coulomb.
    MohrCoulomb {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Cohesion c: shear strength of a plane without pressure across it (Pa).
        cohesion: "Pa",
        /// Coefficient of friction in that plane, μ = tan φ.
        friction: "",
        /// Largest principal tension T (Pa).
        tensile_strength: "Pa",
    }
}

impl MohrCoulomb {
    /// `[sin φ, cos φ]`.
    #[inline(always)]
    fn angle(&self) -> [f64; 2] {
        let cosine = 1.0 / (1.0 + self.friction * self.friction).sqrt();
        [self.friction * cosine, cosine]
    }

    /// Lowest pressure (Pa): that of the tip.
    fn tip(&self) -> f64 {
        let apex = if self.friction > 0.0 {
            self.cohesion / self.friction
        } else {
            f64::INFINITY
        };
        -at_most(apex, self.tensile_strength)
    }

    /// By what a deviator of the principal values `s` (Pa) has to be scaled to lie on the surface, at a pressure (Pa)
    /// and damage. Without shear it lies inside: infinite.
    #[inline(always)]
    #[must_use]
    pub fn scale(&self, s: [f64; 3], pressure: f64, damage: f64) -> f64 {
        let [sine, cosine] = self.angle();
        let (mut most, mut least) = (s[0], s[0]);
        for value in [s[1], s[2]] {
            most = at_least(most, value);
            least = at_most(least, value);
        }
        let kept = 1.0 - damage;
        let strength = 2.0 * (kept * self.cohesion * cosine + pressure * sine);
        let by_shear = at_least(strength, 0.0) / ((1.0 + sine) * most - (1.0 - sine) * least);
        let by_tension = at_least(kept * self.tensile_strength + pressure, 0.0) / most;
        at_most(by_shear, by_tension)
    }

    /// Equivalent stress (Pa) below which no point is outside, at a pressure (Pa) and damage: the corners of the
    /// hexagon in triaxial extension are the nearest, and σ₁ lies at most two thirds of it above the mean.
    #[inline(always)]
    fn inner(&self, [sine, cosine]: [f64; 2], pressure: f64, damage: f64) -> f64 {
        let kept = 1.0 - damage;
        let shear = 6.0 * (kept * self.cohesion * cosine + pressure * sine) / (3.0 + sine);
        let tension = 1.5 * (kept * self.tensile_strength + pressure);
        at_least(at_most(shear, tension), 0.0)
    }
}

impl Law for MohrCoulomb {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const FOLLOWS_STATE: bool = true;
    const KEEPS_FRICTION: bool = true;
    const BOUNDS_TENSION: bool = true;

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    /// That of uniaxial compression.
    fn yield_stress(&self) -> f64 {
        let [sine, cosine] = self.angle();
        2.0 * self.cohesion * cosine / (1.0 - sine)
    }

    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch, _softens: bool) {
        let tip = self.tip();
        for k in 0..LANES {
            point.pressure[k] = at_least(point.pressure[k], tip);
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
        let angle = self.angle();
        for k in 0..LANES {
            let q = equivalent_stress(point, k);
            let (pressure, damage) = (point.pressure[k], point.damage[k]);
            if q <= now.softening[k] * self.inner(angle, pressure, damage) {
                continue;
            }
            let s = &mut point.deviatoric_stress;
            let (values, _) = principal(&s.each_ref().map(|component| component[k]));
            let scale = now.softening[k] * self.scale(values, pressure, damage);
            if scale < 1.0 {
                for component in s.iter_mut() {
                    component[k] *= scale;
                }
                let three_g = 3.0 * now.shear_modulus[k];
                if three_g > 0.0 {
                    point.plastic_strain[k] += (1.0 - scale) * q / three_g;
                }
            }
        }
    }
}
