//! Damage of ceramics by plastic strain, and their bulking.
//!
//! ```text
//! dD = dε_p/ε_f,    ε_f = D₁ (p* + T*)^D₂
//! ```
//!
//! with the pressures of [`JohnsonHolmquist2`](super::JohnsonHolmquist2), the strength that this law belongs to. The elastic
//! energy of shear that damage takes, `U = σ²/(6G)` with the strength σ, becomes in part (β) energy of
//! a pressure Δp, which stays: what is broken takes more room,
//!
//! ```text
//! Δp ← −K₁ μ + √[(K₁ μ + Δp)² + 2 β K₁ (U(D) − U(D + dD))],    μ = ρ/ρ₀ − 1 ≥ 0.
//! ```
//!
//! Source: Johnson & Holmquist (1994), AIP Conf. Proc. 309, 981.

use super::{Conditions, Contradiction, LANES, Law, PointBatch};
use crate::{at_least, at_most};

law! {
    /// Damage by plastic strain, with bulking.
    JohnsonHolmquist2Failure {
        /// Damage coefficient D₁: failure strain at `p* + T* = 1`; at zero matter fails as soon as it yields.
        d1: "",
        /// Damage exponent D₂.
        d2: "",
        /// Share β of the elastic energy lost that becomes energy of pressure.
        bulking: "",
    }
}

impl JohnsonHolmquist2Failure {
    /// Failure strain at `p* + T*`.
    #[must_use]
    pub fn failure_strain(&self, above: f64) -> f64 {
        if above > 0.0 {
            self.d1 * libm::pow(above, self.d2)
        } else {
            0.0
        }
    }

    /// Lane by lane: only what flows is damaged.
    #[inline(never)]
    fn damage(&self, point: &mut PointBatch, now: &Conditions) {
        for k in 0..LANES {
            let increment = now.plastic_increment[k];
            let before = point.damage[k];
            if increment <= 0.0 || before >= super::FAILED {
                continue;
            }
            let factor = now.options.strain_factor(point.id[k]);
            let strain = factor * self.failure_strain(now.curves.above[k]);
            point.damage[k] = at_most(before + increment / strain, super::FAILED);
            let mu = point.density[k] / now.reference_density - 1.0;
            let lost = self.bulking * now.bulk_modulus / (3.0 * now.reference_shear_modulus);
            if lost > 0.0 && mu >= 0.0 {
                let [had, left] = [before, point.damage[k]].map(|d| now.curves.at(k, d));
                let squares = at_least(had * had - left * left, 0.0);
                let cold = now.bulk_modulus * mu;
                let bulked = cold + point.bulking_pressure[k];
                let new = (bulked * bulked + lost * squares).sqrt() - cold;
                point.pressure[k] += new - point.bulking_pressure[k];
                point.bulking_pressure[k] = new;
            }
        }
    }
}

impl Law for JohnsonHolmquist2Failure {
    const STATE: &'static [&'static str] = &[
        "deviatoric_stress",
        "damage",
        "failure_energy",
        "bulking_pressure",
    ];
    const FOLLOWS_STATE: bool = true;
    const HAS_ONSET: bool = false;
    const BULKS: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        (self.bulking > 1.0).then_some(Contradiction {
            keys: &["bulking"],
            title: "`bulking` must be between 0 and 1",
        })
    }

    #[inline(always)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
        if !now.options.softens() {
            self.damage(point, now);
        }
    }

    #[inline(always)]
    fn open(&self, point: &mut PointBatch, now: &Conditions) {
        self.damage(point, now);
    }
}
