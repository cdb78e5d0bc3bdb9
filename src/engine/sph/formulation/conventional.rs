//! The conventional formulation: plain sums over pairs.

use super::Formulation;
use super::gradient_sweep::{Gradient, strain};
use super::momentum_sweep::accelerate;
use super::stresses::{ShowStress, fill_stresses, set_viscous_speeds};
use crate::sph::shared::{Sums, scratch_of};
use crate::sph::signal::{SignalSpeed, Signals};
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lanes::{F64x8, LANES, Lanes};
use particles::neighbours::{Among, Cluster, Lists};
use particles::{ParticleStore, material_points, records_of};
use sums::gradient::VelocityGradient;
use sums::momentum::StressRecord;
use sums::neighbourhood::Neighbourhood;
use sums::step::{Side, Step};

/// The conventional formulation.
#[derive(Debug, Default)]
pub struct Conventional {
    records: Vec<StressRecord>,
}

impl Formulation for Conventional {
    fn rates(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        step: &Step,
    ) {
        let gradient = PlainGradient(ShowStress::new(&mut self.records));
        let points = (material_points!(particles), records_of!(particles));
        strain(&gradient, sums, points, lists, step);
        set_viscous_speeds(particles);
    }

    fn forces(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        side: Side,
    ) {
        fill_stresses(&mut self.records, particles, lists, side);
        sums.terms.show(particles, lists, side);
        accelerate(sums, &self.records, particles, lists, side);
    }

    fn scratch(&mut self, images: usize) -> &mut [u64] {
        scratch_of(&mut self.records, images)
    }

    fn memory(&self) -> usize {
        self.records.capacity() * size_of::<StressRecord>()
    }
}

impl SignalSpeed for Conventional {
    #[inline(always)]
    fn speed(_: &Signals, _: usize, plain: f64) -> f64 {
        plain
    }
}

/// Plain gradients.
struct PlainGradient<'a>(ShowStress<'a>);

impl Gradient for PlainGradient<'_> {
    type Show<'b, S: PairScale>
        = &'b ShowStress<'b>
    where
        Self: 'b;

    #[inline(always)]
    fn of<'b, V: Lanes, S: PairScale>(
        &'b self,
        _: &Cluster,
        among: Among,
        around: Neighbourhood<'b, S>,
        _: impl FnOnce() -> u8,
    ) -> ([F64x8; 9], &'b ShowStress<'b>) {
        let gradient = if among.moving {
            VelocityGradient { around }.run::<V>()
        } else {
            // No relative velocity: the sum would be this, to the bit.
            [F64x8([0.0; LANES]); 9]
        };
        (gradient, &self.0)
    }

    unsafe fn show_resting(&self, place: usize, [density, sound_speed]: [f64; 2]) {
        let record = StressRecord::new(0.0, &[0.0; 6], density, sound_speed);
        // SAFETY: by the contract of this function.
        unsafe { self.0.set(place, record) };
    }
}
