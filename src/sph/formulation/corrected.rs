//! The corrected formulation: gradients that a smooth function of the neighbours' moments corrects,
//! and forces that are their adjoint.

use super::Formulation;
use super::gradient_sweep::{Gradient, strain};
use super::momentum_sweep::accelerate;
use crate::domain::Mirrors;
use crate::material::PointBatch;
use crate::neighbours::{Among, Cluster, Lists};
use crate::numerics::dispatch::Vectorised;
use crate::numerics::kernel::PairScale;
use crate::numerics::lanes::{F64x8, Lanes};
use crate::particles::{ParticleStore, Scatter, material_points};
use crate::sph::corrected::{CorrectedGradient, CorrectedRecord, Correction};
use crate::sph::material_update::Show;
use crate::sph::neighbourhood::Neighbourhood;
use crate::sph::signal::{SignalSpeed, Signals};
use crate::sph::step::{Side, Step};
use crate::sph::sums::{Sums, scratch_of, show_images};

/// The corrected formulation.
#[derive(Debug, Default)]
pub struct Corrected {
    records: Vec<CorrectedRecord>,
}

impl Formulation for Corrected {
    fn rates(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        step: &Step,
    ) {
        let gradient = CorrectedGradients {
            dimension: sums.dimension,
            stress: Scatter::new(&mut particles.pair_stress),
            records: Scatter::new(&mut self.records),
        };
        strain(&gradient, sums, material_points!(particles), lists, step.dt);
    }

    fn forces(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        side: Side,
    ) {
        show_images(&mut self.records, particles, lists, side, |base, code| {
            CorrectedRecord {
                stress: Mirrors::reflect_tensor(&particles.pair_stress[base], code),
                density: particles.density[base],
                sound_speed: particles.sound_speed[base],
            }
        });
        sums.terms.show(particles, lists, side);
        let set = sums.terms.set();
        accelerate(sums, (set, &self.records, &[]), particles, lists, side);
    }

    fn scratch(&mut self, images: usize) -> &mut [u64] {
        scratch_of(&mut self.records, images)
    }

    fn memory(&self) -> usize {
        self.records.capacity() * size_of::<CorrectedRecord>()
    }
}

impl SignalSpeed for Corrected {
    #[inline(always)]
    fn speed(_: &Signals, _: usize, plain: f64) -> f64 {
        plain
    }
}

/// Corrected gradients, and where stresses between corrections go.
struct CorrectedGradients<'a> {
    dimension: usize,
    stress: Scatter<'a, [f64; 9]>,
    records: Scatter<'a, CorrectedRecord>,
}

impl Gradient for CorrectedGradients<'_> {
    type Show<'b>
        = ShowCorrected<'b>
    where
        Self: 'b;

    #[inline(always)]
    fn of<V: Lanes, S: PairScale>(
        &self,
        _: &Cluster,
        _: Among,
        around: Neighbourhood<S>,
        failed: impl FnOnce() -> u8,
    ) -> ([F64x8; 9], ShowCorrected<'_>) {
        let corrected = CorrectedGradient {
            around,
            dimension: self.dimension,
            plain: failed(),
        }
        .run::<V>();
        let show = ShowCorrected {
            target: self,
            correction: corrected.correction,
        };
        (corrected.gradient, show)
    }
}

/// Shows the stresses of a cluster between their corrections.
struct ShowCorrected<'a> {
    target: &'a CorrectedGradients<'a>,
    correction: Correction,
}

impl Show for ShowCorrected<'_> {
    #[inline(always)]
    unsafe fn show(&self, after: &PointBatch, k: usize, i: usize, index: usize) {
        let s = |c: usize| after.deviatoric_stress[c][k];
        let stress =
            self.correction
                .stress(k, after.pressure[k], &[s(0), s(1), s(2), s(3), s(4), s(5)]);
        let record = CorrectedRecord {
            stress,
            density: after.density[k],
            sound_speed: after.sound_speed[k],
        };
        // SAFETY: by the contract of this function.
        unsafe {
            *self.target.stress.slot(i) = stress;
            *self.target.records.slot(index) = record;
        }
    }
}
