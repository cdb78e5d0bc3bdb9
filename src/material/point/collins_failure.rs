//! Shear damage of rock that is brittle, semi-brittle or ductile by its pressure.
//!
//! ```text
//! dD = dε_p/ε_f,
//! ε_f = 0.01 + 0.04 p⁺/p_bd                       brittle:       p < p_bd
//!       0.05 + 0.05 (p − p_bd)/(p_bp − p_bd)      semi-brittle:  p_bd ≤ p < p_bp
//!       0.10 + 0.50 (p − p_bp)/p_bp               ductile:       p ≥ p_bp
//! ```
//!
//! with the pressures of the brittle–ductile and of the brittle–plastic transition. Source:
//! Collins, Melosh & Ivanov (2004), *Modeling damage and deformation in impact simulations*,
//! Meteorit. Planet. Sci. 39, 217, appendix.

use super::ivanov::damage_by_shear;
use super::{Conditions, Contradiction, Law, PointBatch};
use crate::at_least;

law! {
    /// Shear damage with the failure strains of brittle, semi-brittle and ductile rock.
    CollinsFailure {
        /// Pressure `p_bd` of the brittle–ductile transition (Pa).
        brittle_ductile: "Pa",
        /// Pressure `p_bp` of the brittle–plastic transition (Pa).
        brittle_plastic: "Pa",
    }
}

impl CollinsFailure {
    /// Failure strain at a pressure (Pa).
    #[inline(always)]
    #[must_use]
    pub fn failure_strain(&self, pressure: f64) -> f64 {
        let (ductile, plastic) = (self.brittle_ductile, self.brittle_plastic);
        if pressure < ductile {
            0.01 + 0.04 * at_least(pressure, 0.0) / ductile
        } else if pressure < plastic {
            0.05 + 0.05 * (pressure - ductile) / (plastic - ductile)
        } else {
            0.1 + 0.5 * (pressure - plastic) / plastic
        }
    }
}

impl Law for CollinsFailure {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "damage", "failure_energy"];
    const FOLLOWS_STATE: bool = true;
    const HAS_ONSET: bool = false;

    fn contradiction(&self) -> Option<Contradiction> {
        (self.brittle_plastic <= self.brittle_ductile).then_some(Contradiction {
            keys: &["brittle_plastic", "brittle_ductile"],
            title: "`brittle_plastic` must be above `brittle_ductile`",
        })
    }

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
