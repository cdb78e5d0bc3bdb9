//! The switch of Balsara (1995), which takes artificial viscosity out of shear.

use super::TermRecord;
use crate::neighbourhood::gather;
use numerics::lanes::{LANES, Lanes};

/// The Balsara switch `|∇·v|/(|∇·v| + |∇×v| + 10⁻⁴ c/h)` (Balsara 1995): one in compression, zero
/// in shear. From the velocity gradient (1/s, row-major), sound speed (m/s) and smoothing length
/// (m).
#[must_use]
pub fn limiter(l: &[f64; 9], sound_speed: f64, h: f64) -> f64 {
    let divergence = (l[0] + l[4] + l[8]).abs();
    let curl = [l[7] - l[5], l[2] - l[6], l[3] - l[1]];
    let curl = (curl[0] * curl[0] + curl[1] * curl[1] + curl[2] * curl[2]).sqrt();
    let all = divergence + curl + 1e-4 * sound_speed / h;
    // A rigid body has neither strain nor sound.
    divergence / all.max(f64::MIN_POSITIVE)
}

/// The part of eight receivers: half of their factors.
pub(super) struct Lane<V>(V);

impl<V: Lanes> Lane<V> {
    #[inline(always)]
    pub fn begin(own: &[&TermRecord; LANES]) -> Self {
        Self(gather(own, |record| record.half_limiter))
    }

    /// The viscosity's signal speed with the mean factor of the pair.
    #[inline(always)]
    pub fn limit(&self, signal: V, other: &TermRecord) -> V {
        signal.mul(self.0.add(V::splat(other.half_limiter)))
    }
}
