//! Spall: the largest tension that matter bears, and what becomes of it beyond.
//!
//! Matter whose pressure would fall below the limit has failed; what that means stands in
//! [`damage`](super::damage). Recompacted matter is whole again once it is compressed to its
//! reference density and bears as much pressure as it bore tension, `ρ ≥ ρ₀` and `p ≥ −p_spall`:
//!
//! - the density, because pressure alone does not tell closed voids: a vapour has pressure at any
//!   density, and hot matter begins to bear some before it is dense;
//! - the pressure, because fragments that merely touch do not weld. Between failure and recovery
//!   lies a change of pressure of twice the limit, so noise below the limit about a state of no
//!   pressure switches nothing.
//!
//! Neither is a jump of stress: at recovery the pressure is that of the equation of state before
//! and after, and shear grows from zero.

use serde::Deserialize;

use super::failure::FAILED;
use super::{Conditions, LANES, Law, PointBatch, damage};
use crate::at_least;

/// Damage of matter whose pressure has been held and whose cracks have not opened: it tells that the limit has acted.
const HELD: f64 = 1e-30;

/// Fate of material beyond the limit of [`Spall`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AfterSpall {
    /// It has failed for good: it bears pressure alone.
    #[default]
    Failed,
    /// The same until it is recompacted.
    Recompacts,
    /// It flows at the limit, as a fluid would, and has no memory of it.
    Hold,
}

impl AfterSpall {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Failed => "failed",
            Self::Recompacts => "recompacts",
            Self::Hold => "hold",
        }
    }
}

law! {
    /// Largest tension.
    Spall {
        /// Lowest pressure (Pa), negative.
        pressure: "Pa",
        /// Fate of material beyond it.
        after: AfterSpall,
    }
}

impl Law for Spall {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "damage", "failure_energy"];
    const FOLLOWS_STATE: bool = true;
    const HAS_ONSET: bool = false;

    fn state(&self) -> &'static [&'static str] {
        match self.after {
            AfterSpall::Hold => &[],
            AfterSpall::Failed | AfterSpall::Recompacts => Self::STATE,
        }
    }

    #[inline(always)]
    fn follows_state(&self) -> bool {
        self.after != AfterSpall::Hold
    }

    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch, softens: bool) {
        if softens || self.after == AfterSpall::Hold {
            for k in 0..LANES {
                point.pressure[k] = at_least(point.pressure[k], self.pressure);
            }
        }
    }

    /// Fails and recovers; nothing falls below a limit at which pressure is held.
    #[inline(always)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
        let recovers = self.after == AfterSpall::Recompacts;
        for k in 0..LANES {
            let p = point.pressure[k];
            let dense = point.density[k] >= now.reference_density;
            if p < self.pressure {
                point.damage[k] = FAILED;
            } else if recovers && dense && p > 0.0 && p >= -self.pressure {
                point.damage[k] = 0.0;
            }
        }
    }

    /// Pressure of softening material is held at the limit, of which damage takes a share. While it
    /// is, expansion opens cracks. Shear opens none: material at the limit flows as it did before.
    /// Beyond the onset of another law all work counts already.
    #[inline(always)]
    fn open(&self, point: &mut PointBatch, now: &Conditions) {
        if !self.follows_state() {
            return;
        }
        for k in 0..LANES {
            let p = point.pressure[k];
            let held = p <= self.pressure * now.kept[k];
            if held && point.failure_onset[k] < 1.0 && point.damage[k] < FAILED {
                let [xx, yy, zz] = [0, 4, 8].map(|c| point.velocity_gradient[c][k]);
                damage::spend(point, k, -p * (xx + yy + zz), now);
                point.damage[k] = at_least(point.damage[k], HELD);
            }
        }
    }
}
