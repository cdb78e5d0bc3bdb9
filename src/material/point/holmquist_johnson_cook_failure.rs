//! Damage of concrete by plastic strain and by pores that crush.
//!
//! ```text
//! dD = (dε_p + dμ_p)/ε_f,    ε_f = max[D₁ (p* + T*)^D₂, ε_min]
//! ```
//!
//! with the permanent compression `μ_p` of a material that has [pores](crate::Porosity) and the pressures of [`HolmquistJohnsonCook`](super::HolmquistJohnsonCook), the strength that this law belongs to.
//! Source: Holmquist, Johnson & Cook (1993), 14th Int. Symp. Ballistics, 591.

use super::{Conditions, LANES, Lanes, Law, PointBatch};
use crate::at_least;

law! {
    /// Damage by plastic strain and crushed pores.
    HolmquistJohnsonCookFailure {
        /// Damage coefficient D₁: failure strain at `p* + T* = 1`.
        d1: "",
        /// Damage exponent D₂.
        d2: "",
        /// Least failure strain `ε_min`.
        least_strain: "",
    }
}

/// `max[D₁ x^D₂, ε_min]` of the constants `[D₁, D₂, ε_min]`.
pub(super) fn failure_strain([d1, d2, least]: [f64; 3], x: f64) -> f64 {
    let power = if x > 0.0 { libm::pow(x, d2) } else { 0.0 };
    at_least(d1 * power, least)
}

/// Damages eight points by increments of strain, lane by lane where there is any, with the constants of [`failure_strain`].
pub(super) fn advance(point: &mut PointBatch, now: &Conditions, constants: [f64; 3], by: &Lanes) {
    for k in 0..LANES {
        if by[k] > 0.0 {
            let factor = now.options.strain_factor(point.id[k]);
            let strain = factor * failure_strain(constants, now.curves.above[k]);
            point.damage[k] += by[k] / strain;
        }
    }
}

impl HolmquistJohnsonCookFailure {
    fn strain_constants(&self) -> [f64; 3] {
        [self.d1, self.d2, self.least_strain]
    }

    /// Failure strain at `p* + T*`.
    #[must_use]
    pub fn failure_strain(&self, above: f64) -> f64 {
        failure_strain(self.strain_constants(), above)
    }

    /// What flows or crushes is damaged.
    #[inline(never)]
    fn damage(&self, point: &mut PointBatch, now: &Conditions) {
        let mut by = now.plastic_increment;
        for k in 0..LANES {
            by[k] += at_least(now.permanent[k], 0.0);
        }
        advance(point, now, self.strain_constants(), &by);
    }
}

impl Law for HolmquistJohnsonCookFailure {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "damage", "failure_energy"];
    const FOLLOWS_STATE: bool = true;
    const HAS_ONSET: bool = false;

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
