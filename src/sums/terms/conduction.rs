//! Artificial conduction between approaching particles (Noh 1987; Monaghan 1997).

use super::TermRecord;
use crate::neighbourhood::gather;
use numerics::lanes::{LANES, Lanes};

/// The part of eight receivers.
pub(super) struct Lane<V> {
    energy: V,
    twice: V,
}

impl<V: Lanes> Lane<V> {
    #[inline(always)]
    pub fn begin(own: &[&TermRecord; LANES], coefficient: f64) -> Self {
        Self {
            energy: gather(own, |record| record.specific_energy),
            twice: V::splat(2.0 * coefficient),
        }
    }

    /// `2 α_u (e_i − e_j)` (J/kg).
    #[inline(always)]
    pub fn flow(&self, other: &TermRecord) -> V {
        let step = self.energy.sub(V::splat(other.specific_energy));
        step.mul(self.twice)
    }
}
