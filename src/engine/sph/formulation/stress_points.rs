//! Stress points: velocities live on particles, stress on points between them. What these do to
//! velocity particles in the second sweep, and how they follow those. Their first sweep stands in
//! `fit`, what comes between in `moments`.

mod fit;
mod moments;

use rayon::prelude::*;

use super::Formulation;
use crate::sph::shared::{Sums, scratch_of, sources};
use crate::sph::signal::{SignalSpeed, Signals};
use particles::Mirrors;
use particles::neighbours::{CHUNKS_AT_ONCE, Lists};
use particles::{GRAIN, ParticleStore, Scatter, empty, resize};
use sums::from_mirrors::FromMirrors;
use sums::pull_sweep::{PullSweep, PullTarget};
use sums::step::{Side, Step};
use sums::stress_points::{self, StressPointRecord};

/// The formulation by stress points.
#[derive(Debug, Default)]
pub struct StressPoints {
    /// Records of stress points that velocity particles read, kept from step to step.
    records: Vec<StressPointRecord>,
}

impl Formulation for StressPoints {
    fn rates(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        step: &Step,
    ) {
        sums.uncorrected = fit::strain(sums, particles, lists, step);
        moments::find_moments(sums.viscosity, particles);
    }

    fn forces(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        side: Side,
    ) {
        self.show(particles, lists, side);
        let chunks = lists.chunks();
        let from_mirrors = &mut sums.from_mirrors;
        from_mirrors.resize_with(chunks.len(), FromMirrors::default);
        let all = &PullSweep {
            motion: sources(lists, sums.scale),
            points: &self.records,
            images: lists.images(),
            body_groups: lists.groups.of_bodies,
            side,
            target: PullTarget {
                mass: &particles.mass,
                acceleration: Scatter::new(&mut particles.acceleration),
                density: Scatter::new(&mut particles.density),
                energy: Scatter::new(&mut particles.specific_energy),
                power: Scatter::new(&mut particles.d_specific_energy_dt),
                approach: Scatter::new(&mut particles.approach_speed),
            },
        };
        chunks
            .par_iter()
            .zip(from_mirrors)
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|(chunk, from_mirrors)| {
                if side == Side::Inner {
                    empty(&mut from_mirrors.forces);
                }
                all.sweep(chunk, from_mirrors);
                comm::progress();
            });
    }

    /// The rest of the drift of stress points in a step `dt` (s), which have moved by their
    /// velocity and by gravity: their mean velocity in the step is as much later than the last as
    /// that was later than the one before.
    fn drift(&self, particles: &mut ParticleStore, dt: f64, gravity: &[f64; 3]) {
        let points = (
            &mut particles.position,
            &particles.stress_mass,
            &particles.drift_acceleration,
        );
        let points = points.into_par_iter().with_min_len(GRAIN);
        points.for_each(|(x, &mass, acceleration)| {
            if mass > 0.0 {
                for a in 0..3 {
                    x[a] += 0.5 * dt * dt * (acceleration[a] - gravity[a]);
                }
            }
        });
    }

    fn scratch(&mut self, images: usize) -> &mut [u64] {
        scratch_of(&mut self.records, images)
    }

    fn memory(&self) -> usize {
        size_of::<StressPointRecord>() * self.records.capacity()
    }
}

impl SignalSpeed for StressPoints {
    #[inline(always)]
    fn speed(signals: &Signals, i: usize, plain: f64) -> f64 {
        let stable = stress_points::signal(
            signals.fit_norm[i],
            signals.sound_speed[i],
            signals.approach_speed[i],
            &signals.viscosity,
            signals.dimension,
        );
        if stable > plain { stable } else { plain }
    }
}

impl StressPoints {
    /// Records of halo stress points and their images, or of this rank's and theirs.
    fn show(&mut self, particles: &ParticleStore, lists: &Lists, side: Side) {
        let images = lists.images();
        let first = lists.sequence().group(lists.groups.of_bodies).start;
        resize(&mut self.records, images.len());
        let points = self.records[first..].par_iter_mut().zip(&images[first..]);
        points.with_min_len(GRAIN).for_each(|(record, image)| {
            let (i, mirror_mask) = (image.slot(), image.mirror_mask());
            if side.takes(i >= particles.owned()) {
                *record = StressPointRecord {
                    moment: Mirrors::reflect_tensor(&particles.stress_moment[i], mirror_mask),
                    offset: Mirrors::reflect_vector(&particles.stress_offset[i], mirror_mask),
                    density: particles.density[i],
                    heat: particles.stress_heat[i],
                };
            }
        });
    }
}
