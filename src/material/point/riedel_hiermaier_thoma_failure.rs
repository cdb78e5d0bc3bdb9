//! Damage of concrete by plastic strain beyond its failure surface.
//!
//! ```text
//! dD = dε_p/ε_f,    ε_f = max[D₁ (p* − p_t*)^D₂, ε_min]
//! ```
//!
//! with the pressures of [`RiedelHiermaierThoma`](super::RiedelHiermaierThoma), the strength that this law belongs to: strain counts
//! from the end of its hardening on. Source: Riedel, Thoma, Hiermaier & Schmolinske (1999), 9th Int. Symp. Interaction of the
//! Effects of Munitions with Structures, 315.

use super::holmquist_johnson_cook_failure::advance;
use super::{Conditions, LANES, Law, PointBatch};
use crate::at_most;

law! {
    /// Damage by plastic strain beyond the failure surface.
    RiedelHiermaierThomaFailure {
        /// Damage coefficient D₁: failure strain at `p* − p_t* = 1`.
        d1: "",
        /// Damage exponent D₂.
        d2: "",
        /// Least failure strain `ε_min`.
        least_strain: "",
    }
}

impl RiedelHiermaierThomaFailure {
    /// What flows beyond its hardening is damaged.
    #[inline(never)]
    fn damage(&self, point: &mut PointBatch, now: &Conditions) {
        let mut by = now.plastic_increment;
        for k in 0..LANES {
            by[k] = at_most(by[k], point.plastic_strain[k] - now.curves.hardened[k]);
        }
        advance(point, now, [self.d1, self.d2, self.least_strain], &by);
    }
}

impl Law for RiedelHiermaierThomaFailure {
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
