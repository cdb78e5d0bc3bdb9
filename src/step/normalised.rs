//! The normalised form of the SPH sums in the step: corrected gradients in the first sweep, and the
//! power of stresses whose forces are their adjoint.

use rayon::prelude::*;

use super::material_update::MaterialUpdate;
use super::search::GRAIN;
use super::simulation::Simulation;
use crate::domain::Mirrors;
use crate::neighbours::Chunk;
use crate::numerics::dispatch::Vectorised;
use crate::numerics::lanes::Lanes;
use crate::particles::{Image, ParticleStore, Scatter};
use crate::sph::kernel::PairScale;
use crate::sph::neighbourhood::Sources;
use crate::sph::normalised::{Correction, NormalisedGradient, NormalisedRecord, stress_power};

/// The fields that hold corrections, out of the store while the first sweep writes it.
pub(super) struct CorrectionFields {
    matrix: Vec<[f64; 9]>,
    shift: Vec<[f64; 3]>,
    norm: Vec<f64>,
}

impl CorrectionFields {
    pub(super) fn take(store: &mut ParticleStore) -> Self {
        Self {
            matrix: std::mem::take(&mut store.gradient_correction),
            shift: std::mem::take(&mut store.gradient_shift),
            norm: std::mem::take(&mut store.correction_norm),
        }
    }

    pub(super) fn give_back(self, store: &mut ParticleStore) {
        store.gradient_correction = self.matrix;
        store.gradient_shift = self.shift;
        store.correction_norm = self.norm;
    }

    /// For the writes of a sweep.
    pub(super) fn target(&mut self) -> CorrectionTarget<'_> {
        CorrectionTarget {
            matrix: Scatter::new(&mut self.matrix),
            shift: Scatter::new(&mut self.shift),
            norm: Scatter::new(&mut self.norm),
        }
    }
}

/// Where the first sweep writes corrections.
pub(super) struct CorrectionTarget<'a> {
    matrix: Scatter<'a, [f64; 9]>,
    shift: Scatter<'a, [f64; 3]>,
    norm: Scatter<'a, f64>,
}

impl CorrectionTarget<'_> {
    #[inline(always)]
    fn store(&self, i: usize, correction: &Correction) {
        // SAFETY: particle `i` belongs to one cluster alone, and this thread has the cluster.
        unsafe {
            *self.matrix.slot(i) = correction.matrix;
            *self.shift.slot(i) = correction.shift;
            *self.norm.slot(i) = correction.norm;
        }
    }
}

/// The first sweep over one task's clusters, with corrected gradients. Those of particles that move
/// alike are zero too, but their corrections are of use.
pub(super) struct NormalisedChunk<'a, S> {
    pub(super) chunk: &'a Chunk,
    pub(super) motion: Sources<'a, S>,
    pub(super) dimension: usize,
    pub(super) images: &'a [Image],
    pub(super) update: &'a MaterialUpdate<'a>,
    pub(super) corrections: &'a CorrectionTarget<'a>,
}

impl<S: PairScale> Vectorised for NormalisedChunk<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (cluster, neighbours, _) in self.chunk.iter() {
            let sums = NormalisedGradient {
                around: self.motion.around(cluster.receivers, neighbours),
                dimension: self.dimension,
            };
            let corrected = sums.run::<V>();
            for k in 0..cluster.lanes {
                let i = self.images[cluster.receivers[k] as usize].base();
                self.corrections.store(i, &corrected.corrections[k]);
            }
            self.update
                .apply(cluster, &corrected.gradient, neighbours.len());
        }
    }
}

/// The power that stresses put into heat.
pub(super) struct StressPower<'a> {
    pressure: &'a [f64],
    deviatoric_stress: &'a [[f64; 6]],
    velocity_gradient: &'a [[f64; 9]],
    density: &'a [f64],
}

impl<'a> StressPower<'a> {
    /// From fields of the store.
    pub(super) fn new(
        pressure: &'a [f64],
        deviatoric_stress: &'a [[f64; 6]],
        velocity_gradient: &'a [[f64; 9]],
        predicted_density: &'a [f64],
    ) -> Self {
        Self {
            pressure,
            deviatoric_stress,
            velocity_gradient,
            density: predicted_density,
        }
    }

    /// Of owned particle `i` (W/kg).
    #[inline(always)]
    pub(super) fn of(&self, i: usize) -> f64 {
        stress_power(
            self.pressure[i],
            &self.deviatoric_stress[i],
            &self.velocity_gradient[i],
            self.density[i],
        )
    }
}

/// What an image shows of its stress and correction.
pub(super) fn record(store: &ParticleStore, image: Image) -> NormalisedRecord {
    let (i, code) = (image.base(), image.code());
    let own = NormalisedRecord::new(
        store.pressure[i],
        &store.deviatoric_stress[i],
        &store.gradient_correction[i],
        &store.gradient_shift[i],
    );
    NormalisedRecord {
        stress: Mirrors::reflect_tensor(&own.stress, code),
        shift: Mirrors::reflect_vector(&own.shift, code),
    }
}

impl Simulation {
    /// How many of this rank's particles have a gradient without correction.
    pub(super) fn count_uncorrected(&mut self) {
        let norms = &self.store.correction_norm;
        let count = norms
            .par_iter()
            .with_min_len(GRAIN)
            .filter(|&&norm| norm == 0.0)
            .count();
        self.sums.uncorrected = i64::try_from(count).unwrap_or(i64::MAX);
    }
}
