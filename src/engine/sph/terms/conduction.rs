//! Artificial conduction between approaching particles (Noh 1987; Monaghan 1997).

use rayon::prelude::*;

use super::TermRecord;
use crate::sph::neighbourhood::gather;
use numerics::lanes::{LANES, Lanes};
use particles::{GRAIN, ParticleStore};

/// Specific energies of owned particles in the middle of a step `dt` (s).
pub(super) fn prepare(particles: &mut ParticleStore, dt: f64) {
    let owned = particles.owned();
    particles.predicted_energy[..owned]
        .par_iter_mut()
        .with_min_len(GRAIN)
        .zip((&particles.specific_energy, &particles.d_specific_energy_dt))
        .for_each(|(predicted, (e, de))| *predicted = e + 0.5 * dt * de);
}

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
