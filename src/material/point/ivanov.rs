//! Shear damage of rock, whose failure strain grows with pressure.
//!
//! ```text
//! dD = dε_p/ε_f,    ε_f = max[ε_b, B (p − p_c)]
//! ```
//!
//! Source: Ivanov, Deniem & Neukum (1997), *Implementation of dynamic strength models into 2D
//! hydrocodes: applications for atmospheric breakup and impact cratering*, Int. J. Impact Eng. 20,
//! 411. The onset of softening by fracture energy is another law's: this one damages by itself.

use super::{Conditions, LANES, Law, PointBatch};
use crate::at_least;

law! {
    /// Shear damage with a failure strain linear in the pressure.
    Ivanov {
        /// Failure strain `ε_b` of brittle rock.
        least_strain: "",
        /// Growth B of the failure strain with pressure (1/Pa).
        slope: "1/Pa",
        /// Pressure `p_c` from which on it grows (Pa).
        pressure: "Pa",
    }
}

impl Ivanov {
    /// Failure strain at a pressure (Pa).
    #[inline(always)]
    #[must_use]
    pub fn failure_strain(&self, pressure: f64) -> f64 {
        at_least(self.slope * (pressure - self.pressure), self.least_strain)
    }
}

/// Damages by the plastic strain of the step over a failure strain at a pressure (Pa).
#[inline(always)]
pub(super) fn damage_by_shear(
    point: &mut PointBatch,
    now: &Conditions,
    failure_strain: impl Fn(f64) -> f64,
) {
    for k in 0..LANES {
        let increment = now.plastic_increment[k];
        if increment > 0.0 {
            let factor = now.options.strain_factor(point.id[k]);
            point.damage[k] += increment / (factor * failure_strain(point.pressure[k]));
        }
    }
}

impl Law for Ivanov {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "damage", "failure_energy"];
    const FOLLOWS_STATE: bool = true;
    const HAS_ONSET: bool = false;

    #[inline(never)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
        if !now.options.softens() {
            damage_by_shear(point, now, |pressure| self.failure_strain(pressure));
        }
    }

    #[inline(never)]
    fn open(&self, point: &mut PointBatch, now: &Conditions) {
        damage_by_shear(point, now, |pressure| self.failure_strain(pressure));
    }
}
