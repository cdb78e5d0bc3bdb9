//! Records of the stress of particles and images.

use rayon::prelude::*;

use crate::sph::material_update::{Show, Updated};
use crate::sph::shared::show_images;
use numerics::lanes::Lanes;
use particles::Mirrors;
use particles::neighbours::Lists;
use particles::{GRAIN, ParticleStore, Scatter};
use sums::momentum::StressRecord;
use sums::step::Side;

/// Shows stresses as they are updated.
pub(super) struct ShowStress<'a>(Scatter<'a, StressRecord>);

impl<'a> ShowStress<'a> {
    pub fn new(records: &'a mut [StressRecord]) -> Self {
        Self(Scatter::new(records))
    }

    /// Sets what a place shows.
    ///
    /// # Safety
    /// No other thread may read or write what belongs to the place.
    pub unsafe fn set(&self, place: usize, record: StressRecord) {
        // SAFETY: by the contract of this function.
        unsafe { *self.0.slot(place) = record };
    }
}

impl Show for &ShowStress<'_> {
    #[inline(always)]
    unsafe fn show<V: Lanes>(&self, points: &Updated) {
        let after = points.after;
        points.each(|k, _, index| {
            let s = |c: usize| after.deviatoric_stress[c][k];
            let record = StressRecord::new(
                after.pressure[k],
                &[s(0), s(1), s(2), s(3), s(4), s(5)],
                after.density[k],
                after.viscous_speed(k, 1.0),
            );
            // SAFETY: by the contract of this function.
            unsafe { self.set(index, record) };
        });
    }
}

/// Sets the speeds of the artificial viscosity of owned particles.
pub(super) fn set_viscous_speeds(particles: &mut ParticleStore) {
    let ParticleStore {
        viscous_speed,
        sound_speed,
        pressure,
        damage,
        ..
    } = particles;
    let speeds = viscous_speed.par_iter_mut().zip(sound_speed.par_iter());
    let speeds = speeds.zip(pressure.par_iter()).enumerate();
    speeds
        .with_min_len(GRAIN)
        .for_each(|(i, ((speed, &sound), &pressure))| {
            let damage = damage.get(i).copied().unwrap_or(0.0);
            *speed = material::viscous_speed(sound, pressure, damage);
        });
}

/// Stresses of halo particles and their images, or of the images of this rank's particles.
pub(super) fn fill_stresses(
    records: &mut [StressRecord],
    particles: &ParticleStore,
    lists: &Lists,
    side: Side,
) {
    show_images(
        records,
        particles.owned(),
        lists,
        side,
        |_, slot, mirror_mask| {
            StressRecord::new(
                particles.pressure[slot],
                &Mirrors::reflect_symmetric(&particles.deviatoric_stress[slot], mirror_mask),
                particles.density[slot],
                particles.viscous_speed[slot],
            )
        },
    );
}
