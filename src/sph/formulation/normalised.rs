//! The normalised formulation: corrected gradients in the first sweep, and the power of stresses whose
//! forces are their adjoint.

use rayon::prelude::*;

use super::Formulation;
use super::momentum_sweep::accelerate;
use crate::domain::Mirrors;
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, Lists};
use crate::numerics::dispatch::{Vectorised, instructions};
use crate::numerics::kernel::PairScale;
use crate::numerics::lanes::Lanes;
use crate::particles::{GRAIN, Image, ParticleStore, Scatter, material_points, resize};
use crate::sph::material_update::MaterialUpdate;
use crate::sph::neighbourhood::Sources;
use crate::sph::normalised::{Correction, NormalisedGradient, NormalisedRecord};
use crate::sph::options::NORMALISED;
use crate::sph::signal::{SignalSpeed, Signals};
use crate::sph::step::{Side, Step};
use crate::sph::sums::{Sums, sources, with_scale};

/// How much corrections enlarge gradients at surfaces of lattices, which steps need not heed.
const SURFACE_CORRECTION: f64 = 2.0;

/// The normalised formulation.
#[derive(Debug, Default)]
pub struct Normalised {
    records: Vec<NormalisedRecord>,
}

impl Formulation for Normalised {
    fn rates(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        step: &Step,
    ) {
        let set = instructions();
        let (scale, dimension, images) = (sums.scale, sums.dimension, lists.images());
        let corrections = &CorrectionTarget {
            matrix: Scatter::new(&mut particles.gradient_correction),
            shift: Scatter::new(&mut particles.gradient_shift),
            norm: Scatter::new(&mut particles.correction_norm),
        };
        let update = &MaterialUpdate::new(material_points!(particles), sums, lists, step.dt);
        let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
        with_scale!(scale, scale => chunks.for_each(|chunk| {
            let motion = sources(lists, scale);
            set.run(NormalisedChunk { chunk, motion, dimension, images, update, corrections });
        }));
        let norms = particles.correction_norm.par_iter().with_min_len(GRAIN);
        let uncorrected = norms.filter(|&&norm| norm == 0.0).count();
        sums.uncorrected = i64::try_from(uncorrected).unwrap_or(i64::MAX);
    }

    fn forces(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        side: Side,
    ) {
        sums.fill_stresses(particles, lists, side);
        let images = lists.images();
        resize(&mut self.records, images.len());
        let records = self.records.par_iter_mut().zip(images);
        records.with_min_len(GRAIN).for_each(|(shown, &image)| {
            if side.takes(image.base() >= particles.owned()) {
                *shown = record(particles, image);
            }
        });
        sums.terms.show(particles, lists, side);
        let set = sums.terms.set() | NORMALISED;
        accelerate(sums, (set, &self.records), particles, lists, side);
    }

    fn memory(&self) -> usize {
        self.records.capacity() * size_of::<NormalisedRecord>()
    }
}

impl SignalSpeed for Normalised {
    /// A correction that enlarges gradients more than those of plain surfaces do raises frequencies as
    /// much.
    #[inline(always)]
    fn speed(signals: &Signals, i: usize, plain: f64) -> f64 {
        plain * (signals.correction_norm[i] / SURFACE_CORRECTION).max(1.0)
    }
}

/// Where the first sweep writes corrections.
struct CorrectionTarget<'a> {
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
struct NormalisedChunk<'a, S> {
    chunk: &'a Chunk,
    motion: Sources<'a, S>,
    dimension: usize,
    images: &'a [Image],
    update: &'a MaterialUpdate<'a>,
    corrections: &'a CorrectionTarget<'a>,
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

/// What an image shows of its stress and correction.
fn record(store: &ParticleStore, image: Image) -> NormalisedRecord {
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
