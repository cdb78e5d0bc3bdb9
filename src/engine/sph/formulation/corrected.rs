//! The corrected formulation: gradients that a smooth function of the neighbours' moments corrects,
//! and forces that are their adjoint.

use rayon::prelude::*;

use super::Formulation;
use super::gradient_sweep::{Gradient, strain};
use super::momentum_sweep::accelerate;
use super::total::{Shown, TotalBodies};
use crate::domain::{InitialLayout, Payload};
use crate::sph::hourglass_update::HourglassUpdate;
use crate::sph::material_update::{Show, Updated};
use crate::sph::shared::{Sums, scratch_of, show_images};
use crate::sph::signal::{SignalSpeed, Signals};
use material::PointBatch;
use model::Case;
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{full, read_all, store_all};
use numerics::lanes::{F64x8, LANES, Lanes};
use particles::neighbours::{Among, Cluster, Groups, Lists};
use particles::{
    GRAIN, MirrorMask, Mirrors, ParticleStore, Scatter, material_points, records_of, resize,
};
use sums::corrected::{CorrectedGradient, CorrectedRecord, Correction};
use sums::limiter::Limiter;
use sums::neighbourhood::Neighbourhood;
use sums::step::{Side, Step};

/// The corrected formulation.
#[derive(Default)]
pub struct Corrected {
    records: Vec<CorrectedRecord>,
    /// Places of the records of this rank's particles.
    places: Vec<u32>,
    /// Those of halo particles.
    received: Vec<CorrectedRecord>,
    /// True if there is no other process that reads of these.
    is_alone: bool,
    /// Stiffness ξ of the hourglass control.
    hourglass: f64,
    /// Bodies of the total form.
    pub(in crate::sph) total: Option<Box<TotalBodies>>,
}

impl Corrected {
    /// Of a case on so many processes.
    #[must_use]
    pub fn new(case: &Case, processes: usize, groups: &Groups, layout: &InitialLayout) -> Self {
        Self {
            is_alone: processes == 1,
            hourglass: case.sph.hourglass,
            total: TotalBodies::new(case, groups, layout).map(Box::new),
            ..Self::default()
        }
    }
}

impl Corrected {
    /// Records of images of the last second sweep, in the order of the lists.
    #[must_use]
    pub fn records(&self) -> &[CorrectedRecord] {
        &self.records
    }

    /// True if all bodies are of the total form.
    fn are_all_total(&self) -> bool {
        self.total.as_ref().is_some_and(|total| total.holds_all())
    }

    fn find_places(&mut self, owned: usize, lists: &Lists) {
        resize(&mut self.places, owned);
        let places = Scatter::new(&mut self.places);
        let images = lists.images().par_iter().enumerate();
        images.with_min_len(GRAIN).for_each(|(place, image)| {
            if image.mirror_mask().is_own() && image.slot() < owned {
                #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
                let place = place as u32;
                // SAFETY: each particle stands at one place.
                unsafe { *places.slot(image.slot()) = place };
            }
        });
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
        // Of bodies of the total form nobody but images and other processes reads records here.
        let alone = self.is_alone && lists.sequence().is_alone();
        if !alone || !self.are_all_total() {
            scratch_of(&mut self.records, lists.images().len());
        }
        let gradient = CorrectedGradients {
            dimension: sums.dimension,
            hourglass: HourglassUpdate {
                dt: step.dt,
                stiffness: self.hourglass,
                displacement: Scatter::new(&mut particles.hourglass_displacement),
            },
            records: Scatter::new(&mut self.records),
        };
        let points = (material_points!(particles), records_of!(particles));
        strain(&gradient, sums, points, lists, step);
        if !alone {
            self.find_places(particles.owned(), lists);
        }
        if let Some(total) = &mut self.total {
            let mut shown = Shown {
                records: &mut self.records,
                spared: alone,
                places: &self.places,
                received: &[],
            };
            total.rates(sums, particles, step, self.hourglass, &mut shown);
        }
    }

    fn forces(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        side: Side,
    ) {
        let (owned, places, received) = (particles.owned(), &self.places, &self.received);
        show_images(
            &mut self.records,
            owned,
            lists,
            side,
            |records, slot, mirror_mask| {
                let shown = match slot.checked_sub(owned) {
                    // SAFETY: images stand at other places, and nobody writes elsewhere.
                    None => unsafe { records.read(places[slot] as usize) },
                    Some(k) => received[k],
                };
                reflected(&shown, mirror_mask)
            },
        );
        sums.terms.show(particles, lists, side);
        accelerate(sums, &self.records, particles, lists, side);
        if let Some(total) = &mut self.total {
            let shown = Shown {
                records: &mut self.records,
                spared: true,
                places: &self.places,
                received: &self.received,
            };
            total.forces(sums, particles, &shown, side);
        }
    }

    fn scratch(&mut self, images: usize) -> &mut [u64] {
        match &mut self.total {
            Some(total) if total.holds_all() => total.scratch(images),
            _ => scratch_of(&mut self.records, images),
        }
    }

    fn payload(&mut self) -> Option<&mut dyn Payload> {
        Some(self)
    }

    fn memory(&self) -> usize {
        (self.records.capacity() + self.received.capacity()) * size_of::<CorrectedRecord>()
            + 4 * self.places.capacity()
            + self.total.as_ref().map_or(0, |total| total.memory())
    }
}

/// Their records.
impl Payload for Corrected {
    fn size(&self) -> usize {
        size_of::<CorrectedRecord>()
    }

    fn of(&self, particle: usize) -> &[u8] {
        bytemuck::bytes_of(&self.records[self.places[particle] as usize])
    }

    fn received(&mut self, halo: usize) -> &mut [u8] {
        resize(&mut self.received, halo);
        bytemuck::cast_slice_mut(&mut self.received)
    }
}

impl SignalSpeed for Corrected {
    #[inline(always)]
    fn speed(signals: &Signals, i: usize, plain: f64) -> f64 {
        signals
            .correction_norm
            .get(i)
            .map_or(plain, |norm| norm * plain)
    }
}

/// Corrected gradients, and where stresses between corrections go.
struct CorrectedGradients<'a> {
    dimension: usize,
    hourglass: HourglassUpdate<'a>,
    records: Scatter<'a, CorrectedRecord>,
}

impl Gradient for CorrectedGradients<'_> {
    type Show<'b, S: PairScale>
        = ShowCorrected<'b, S>
    where
        Self: 'b;

    #[inline(always)]
    fn of<'b, V: Lanes, S: PairScale>(
        &'b self,
        _: &Cluster,
        among: Among,
        around: Neighbourhood<'b, S>,
        failed: impl FnOnce() -> u8,
    ) -> ([F64x8; 9], ShowCorrected<'b, S>) {
        let sums = CorrectedGradient {
            around,
            dimension: self.dimension,
            plain: failed(),
        };
        let zero = F64x8([0.0; LANES]);
        let (gradient, rest, limiter, correction) = if among.moving {
            let corrected = sums.run::<V>();
            (
                corrected.gradient,
                corrected.rest,
                corrected.limiter,
                Some(corrected.correction),
            )
        } else {
            // No relative velocity: the sums would be these, and nobody may need the correction.
            ([zero; 9], [zero; 3], Limiter::RESTING, None)
        };
        let show = ShowCorrected {
            target: self,
            rest,
            limiter,
            correction,
            sums,
        };
        (gradient, show)
    }

    unsafe fn show_resting(&self, place: usize, [density, sound_speed]: [f64; 2]) {
        // SAFETY: by the contract of this function.
        unsafe {
            *self.records.slot(place) = CorrectedRecord::new(
                &[0.0; 9],
                &[0.0; 3],
                self.hourglass.stiffness,
                [density, sound_speed, 0.0, 0.0],
            );
        }
    }
}

/// Record of the image `mirror_mask` of a particle with this record.
fn reflected(record: &CorrectedRecord, mirror_mask: MirrorMask) -> CorrectedRecord {
    CorrectedRecord {
        stress: Mirrors::reflect_tensor(&record.stress, mirror_mask),
        hourglass: Mirrors::reflect_vector(&record.hourglass, mirror_mask),
        ..*record
    }
}

/// Shows the stresses of a cluster between their corrections.
struct ShowCorrected<'a, S> {
    target: &'a CorrectedGradients<'a>,
    rest: [F64x8; 3],
    /// Limiters of the viscosity.
    limiter: Limiter,
    /// Once it is known.
    correction: Option<Correction>,
    sums: CorrectedGradient<'a, S>,
}

impl<S: PairScale> Show for ShowCorrected<'_, S> {
    #[inline(always)]
    unsafe fn show<V: Lanes>(&self, points: &Updated) {
        let (target, after) = (self.target, points.after);
        let deviator: [V; 6] = read_all(&after.deviatoric_stress);
        let pressure = V::read(&after.pressure);
        let mut sigma = full(&deviator);
        for a in 0..3 {
            sigma[4 * a] = sigma[4 * a].sub(pressure);
        }
        let stress = if let Some(correction) = &self.correction {
            correction.apply(&sigma)
        } else if is_free(after) {
            [V::splat(0.0); 9]
        } else {
            self.sums.run::<V>().correction.apply(&sigma)
        };
        let stress = store_all(&stress);
        if points.shear_modulus > 0.0 {
            // SAFETY: by the contract of this function.
            unsafe {
                target.hourglass.advance::<V>(points, &deviator, &self.rest);
            }
        }
        let dt = V::splat(target.hourglass.dt).max(V::splat(f64::MIN_POSITIVE));
        let strained = V::read(&after.plastic_strain).sub(V::read(&points.before.plastic_strain));
        let share = (self.limiter).both(V::read(&after.sound_speed), strained.div(dt));
        points.each(|k, i, index| {
            let mut own = [0.0; 9];
            for c in 0..9 {
                own[c] = stress[c].0[k];
            }
            let viscous_speed = after.viscous_speed(k, self.limiter.linear.0[k]);
            let sound_speed = after.sound_speed[k];
            let state = [after.density[k], sound_speed, viscous_speed, share.0[k]];
            // SAFETY: by the contract of this function.
            unsafe {
                let displacement = target.hourglass.displacement.slot(i);
                let stiffness = target.hourglass.stiffness;
                *target.records.slot(index) =
                    CorrectedRecord::new(&own, displacement, stiffness, state);
            }
        });
    }
}

/// True if no point bears stress.
#[inline(always)]
fn is_free(after: &PointBatch) -> bool {
    after.pressure == [0.0; LANES] && after.deviatoric_stress == [[0.0; LANES]; 6]
}
