//! The normalised formulation: corrected gradients in the first sweep, and the power of stresses
//! whose forces are their adjoint.

use rayon::prelude::*;

use super::Formulation;
use super::gradient_sweep::{Gradient, strain};
use super::momentum_sweep::accelerate;
use super::stresses::set_viscous_speeds;
use crate::sph::shared::{Sums, scratch_of};
use crate::sph::signal::{SignalSpeed, Signals};
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lanes::{F64x8, Lanes};
use particles::Mirrors;
use particles::neighbours::{Among, Cluster, Lists};
use particles::{GRAIN, Image, ParticleStore, Scatter, material_points, records_of, resize};
use sums::neighbourhood::Neighbourhood;
use sums::normalised::{NormalisedGradient, NormalisedRecord};
use sums::step::{Side, Step};

/// Factor of corrected gradients at surfaces of lattices, which steps need not heed.
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
        let gradient = NormalisedGradients {
            dimension: sums.dimension,
            images: lists.images(),
            matrix: Scatter::new(&mut particles.gradient_correction),
            shift: Scatter::new(&mut particles.gradient_shift),
            norm: Scatter::new(&mut particles.correction_norm),
        };
        let points = (material_points!(particles), records_of!(particles));
        strain(&gradient, sums, points, lists, step);
        set_viscous_speeds(particles);
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
        let images = lists.images();
        resize(&mut self.records, images.len());
        let records = self.records.par_iter_mut().zip(images);
        records.with_min_len(GRAIN).for_each(|(shown, &image)| {
            if side.takes(image.slot() >= particles.owned()) {
                *shown = record(particles, image);
            }
        });
        sums.terms.show(particles, lists, side);
        accelerate(sums, &self.records, particles, lists, side);
    }

    fn scratch(&mut self, images: usize) -> &mut [u64] {
        scratch_of(&mut self.records, images)
    }

    fn memory(&self) -> usize {
        self.records.capacity() * size_of::<NormalisedRecord>()
    }
}

impl SignalSpeed for Normalised {
    /// A correction that enlarges gradients more than those of plain surfaces do raises frequencies
    /// as much.
    #[inline(always)]
    fn speed(signals: &Signals, i: usize, plain: f64) -> f64 {
        plain * (signals.correction_norm[i] / SURFACE_CORRECTION).max(1.0)
    }
}

/// Corrected gradients, and where corrections go. Gradients of particles that move alike are zero
/// too, but their corrections are of use.
struct NormalisedGradients<'a> {
    dimension: usize,
    images: &'a [Image],
    matrix: Scatter<'a, [f64; 9]>,
    shift: Scatter<'a, [f64; 3]>,
    norm: Scatter<'a, f64>,
}

impl Gradient for NormalisedGradients<'_> {
    type Show<'b, S: PairScale>
        = ()
    where
        Self: 'b;

    #[inline(always)]
    fn of<'b, V: Lanes, S: PairScale>(
        &'b self,
        cluster: &Cluster,
        _: Among,
        around: Neighbourhood<'b, S>,
        _: impl FnOnce() -> u8,
    ) -> ([F64x8; 9], ()) {
        let sums = NormalisedGradient {
            around,
            dimension: self.dimension,
        };
        let corrected = sums.run::<V>();
        for (k, correction) in corrected.corrections[..cluster.lanes].iter().enumerate() {
            let i = self.images[cluster.receivers[k] as usize].slot();
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            unsafe {
                *self.matrix.slot(i) = correction.matrix;
                *self.shift.slot(i) = correction.shift;
                *self.norm.slot(i) = correction.norm;
            }
        }
        (corrected.gradient, ())
    }
}

/// Record of the stress and correction of an image.
fn record(particles: &ParticleStore, image: Image) -> NormalisedRecord {
    let (i, mirror_mask) = (image.slot(), image.mirror_mask());
    let own = NormalisedRecord::new(
        (particles.pressure[i], &particles.deviatoric_stress[i]),
        &particles.gradient_correction[i],
        &particles.gradient_shift[i],
        [particles.density[i], particles.viscous_speed[i]],
    );
    NormalisedRecord {
        stress: Mirrors::reflect_tensor(&own.stress, mirror_mask),
        shift: Mirrors::reflect_vector(&own.shift, mirror_mask),
        ..own
    }
}
