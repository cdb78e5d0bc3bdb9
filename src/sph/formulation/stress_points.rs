//! Stress points: velocities live on particles, stress on points between them. What these do to
//! velocity particles in the second sweep, and how they follow those. Their first sweep stands in
//! `fit`, what comes between in `moments`.

mod fit;
mod moments;

use rayon::prelude::*;

use super::Formulation;
use crate::domain::{MirrorForce, Mirrors};
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, Cluster, Lists};
use crate::numerics::dispatch::{Vectorised, instructions};
use crate::numerics::kernel::PairScale;
use crate::numerics::lanes::Lanes;
use crate::particles::{GRAIN, Image, ParticleStore, Scatter, empty, resize};
use crate::sph::neighbourhood::Sources;
use crate::sph::scale::with_scale;
use crate::sph::signal::{SignalSpeed, Signals};
use crate::sph::step::{Side, Step};
use crate::sph::stress_points::{self, Pull, Pulled, StressPointRecord};
use crate::sph::sums::{FromMirrors, Sums, scratch_of, sources};

/// The formulation by stress points.
#[derive(Debug, Default)]
pub struct StressPoints {
    /// What stress points show to velocity particles, kept from step to step.
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
        let set = instructions();
        let (chunks, images) = (lists.chunks(), lists.images());
        let Sums {
            scale,
            from_mirrors,
            ..
        } = sums;
        from_mirrors.resize_with(chunks.len(), FromMirrors::default);
        let target = &PullTarget {
            images,
            mass: &particles.mass,
            acceleration: Scatter::new(&mut particles.acceleration),
            density: Scatter::new(&mut particles.density),
            energy: Scatter::new(&mut particles.specific_energy),
            power: Scatter::new(&mut particles.d_specific_energy_dt),
            approach: Scatter::new(&mut particles.approach_speed),
        };
        let shown = PullSources {
            points: &self.records,
            images,
        };
        let body_groups = lists.groups.of_bodies;
        with_scale!(*scale, scale => chunks
        .par_iter()
        .zip(from_mirrors)
        .with_max_len(CHUNKS_AT_ONCE)
        .for_each(|(chunk, from_mirrors)| {
            if side == Side::Inner {
                empty(&mut from_mirrors.forces);
            }
            let (motion, sources) = (sources(lists, scale), shown);
            set.run(PullChunk { chunk, side, body_groups, motion, sources, target, from_mirrors });
        }));
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
            let (i, code) = (image.base(), image.code());
            if side.takes(i >= particles.owned()) {
                *record = StressPointRecord {
                    moment: Mirrors::reflect_tensor(&particles.stress_moment[i], code),
                    offset: Mirrors::reflect_vector(&particles.stress_offset[i], code),
                    density: particles.density[i],
                    heat: particles.stress_heat[i],
                };
            }
        });
    }
}

/// What the second sweep reads.
#[derive(Clone, Copy)]
struct PullSources<'a> {
    points: &'a [StressPointRecord],
    images: &'a [Image],
}

/// Where it writes.
struct PullTarget<'a> {
    images: &'a [Image],
    mass: &'a [f64],
    acceleration: Scatter<'a, [f64; 3]>,
    density: Scatter<'a, f64>,
    energy: Scatter<'a, f64>,
    power: Scatter<'a, f64>,
    approach: Scatter<'a, f64>,
}

impl PullTarget<'_> {
    #[inline(always)]
    fn store(&self, cluster: &Cluster, pulled: &Pulled) {
        for k in 0..cluster.lanes {
            let i = self.images[cluster.receivers[k] as usize].base();
            let per_mass = 1.0 / self.mass[i];
            let f = |a: usize| per_mass * pulled.force[a].0[k];
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            unsafe {
                *self.acceleration.slot(i) = [f(0), f(1), f(2)];
                *self.energy.slot(i) -= per_mass * pulled.heat.0[k];
                *self.power.slot(i) = 0.0;
                *self.approach.slot(i) = 0.0;
                if pulled.density.0[k] > 0.0 {
                    *self.density.slot(i) = pulled.density.0[k];
                }
            }
        }
    }
}

/// The second sweep over one task's clusters.
struct PullChunk<'a, S> {
    chunk: &'a Chunk,
    side: Side,
    body_groups: usize,
    motion: Sources<'a, S>,
    sources: PullSources<'a>,
    target: &'a PullTarget<'a>,
    from_mirrors: &'a mut FromMirrors,
}

impl<S: PairScale> Vectorised for PullChunk<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let FromMirrors { indices, forces } = self.from_mirrors;
        for (cluster, neighbours, among) in self.chunk.iter() {
            if !self.side.takes(among.halo) || cluster.group >= self.body_groups {
                continue;
            }
            let pulled = Self::sum::<V>(self.motion, &self.sources, cluster, neighbours);
            self.target.store(cluster, &pulled);
            if !among.mirrors {
                continue;
            }
            // Stress points on this side pull at images too. What all do to the particles on this
            // side adds up to twice the part of those behind a plane along its normal, and to none
            // along the plane.
            for axis in 0..3 {
                let behind = |&j: &u32| self.sources.images[j as usize].code() >> axis & 1 == 1;
                indices.clear();
                indices.extend(neighbours.iter().copied().filter(behind));
                if indices.is_empty() {
                    continue;
                }
                let part = Self::sum::<V>(self.motion, &self.sources, cluster, indices).force[axis];
                for k in 0..cluster.lanes {
                    let mut force = [0.0; 3];
                    force[axis] = 2.0 * part.0[k];
                    let i = self.sources.images[cluster.receivers[k] as usize].base();
                    forces.push(MirrorForce {
                        particle: i,
                        force,
                        couple: [0.0; 3],
                    });
                }
            }
        }
    }
}

impl<S: PairScale> PullChunk<'_, S> {
    #[inline(always)]
    fn sum<V: Lanes>(
        motion: Sources<S>,
        sources: &PullSources,
        cluster: &Cluster,
        neighbours: &[u32],
    ) -> Pulled {
        let sums = Pull {
            around: motion.around(cluster.receivers, neighbours),
            points: sources.points,
        };
        sums.run::<V>()
    }
}
