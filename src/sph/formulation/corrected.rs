//! The corrected formulation: gradients that a smooth function of the neighbours' moments corrects,
//! and forces that are their adjoint.

use super::Formulation;
use super::gradient_sweep::{Gradient, strain};
use super::momentum_sweep::accelerate;
use crate::domain::Mirrors;
use crate::material::{Material, PointBatch};
use crate::model::Case;
use crate::neighbours::{Among, Cluster, Lists};
use crate::numerics::dispatch::Vectorised;
use crate::numerics::kernel::PairScale;
use crate::numerics::lanes::{F64x8, Lanes};
use crate::particles::{ParticleStore, Scatter, material_points};
use crate::sph::corrected::{CorrectedGradient, CorrectedRecord, Correction};
use crate::sph::hourglass;
use crate::sph::material_update::Show;
use crate::sph::neighbourhood::Neighbourhood;
use crate::sph::signal::{SignalSpeed, Signals};
use crate::sph::step::{Side, Step};
use crate::sph::sums::{Sums, scratch_of, show_images};

/// The corrected formulation.
#[derive(Debug, Default)]
pub struct Corrected {
    records: Vec<CorrectedRecord>,
    /// Stiffness ξ of the hourglass control.
    hourglass: f64,
}

impl Corrected {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        Self {
            records: Vec::new(),
            hourglass: case.sph.hourglass,
        }
    }
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
            dt: step.dt,
            hourglass: self.hourglass,
            materials: &sums.materials,
            material_of_body: &sums.material_of_body,
            body: &particles.body,
            displacement: Scatter::new(&mut particles.hourglass_displacement),
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
        let hourglass = self.hourglass;
        show_images(&mut self.records, particles, lists, side, |base, code| {
            CorrectedRecord::new(
                &Mirrors::reflect_tensor(&particles.pair_stress[base], code),
                &Mirrors::reflect_vector(&particles.hourglass_displacement[base], code),
                hourglass,
                [particles.density[base], particles.sound_speed[base]],
            )
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
    dt: f64,
    hourglass: f64,
    materials: &'a [Material],
    material_of_body: &'a [usize],
    body: &'a [u32],
    displacement: Scatter<'a, [f64; 3]>,
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
            rest: corrected.rest,
            correction: corrected.correction,
        };
        (corrected.gradient, show)
    }
}

/// Shows the stresses of a cluster between their corrections.
struct ShowCorrected<'a> {
    target: &'a CorrectedGradients<'a>,
    rest: [F64x8; 3],
    correction: Correction,
}

impl Show for ShowCorrected<'_> {
    #[inline(always)]
    unsafe fn show(
        &self,
        before: &PointBatch,
        after: &PointBatch,
        k: usize,
        i: usize,
        index: usize,
    ) {
        let target = self.target;
        let s = |c: usize| after.deviatoric_stress[c][k];
        let deviator = [s(0), s(1), s(2), s(3), s(4), s(5)];
        let stress = self.correction.stress(k, after.pressure[k], &deviator);
        let material = &target.materials[target.material_of_body[target.body[i] as usize]];
        let shear_modulus = material.strength.shear_modulus();
        // SAFETY: by the contract of this function.
        let displacement = unsafe { target.displacement.slot(i) };
        if shear_modulus > 0.0 {
            let plastic = after.plastic_strain[k] - before.plastic_strain[k];
            let gradient =
                [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|c: usize| after.velocity_gradient[c][k]);
            let rest = [0, 1, 2].map(|a: usize| self.rest[a].0[k]);
            let kept = if after.damage[k] < 1.0 {
                hourglass::kept(&deviator, 3.0 * shear_modulus * plastic)
            } else {
                0.0
            };
            *displacement =
                hourglass::advance(displacement, &rest, &gradient, target.dt).map(|w| w * kept);
        }
        let state = [after.density[k], after.sound_speed[k]];
        let record = CorrectedRecord::new(&stress, displacement, target.hourglass, state);
        // SAFETY: by the contract of this function.
        unsafe {
            *target.stress.slot(i) = stress;
            *target.records.slot(index) = record;
        }
    }
}
