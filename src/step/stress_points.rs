//! Stress points in the step: what they do to velocity particles in the second sweep, and how they
//! follow those. Their first sweep stands in `stress_fit`, what comes between in `stress_moments`.

use rayon::prelude::*;

use super::search::GRAIN;
use super::simulation::Simulation;
use super::sweeps::{FromMirrors, Sweeps, with_scale};
use crate::domain::Mirrors;
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, Cluster};
use crate::numerics::dispatch::{Vectorised, instructions};
use crate::numerics::lanes::Lanes;
use crate::particles::{Image, Scatter, resize};
use crate::sph::kernel::PairScale;
use crate::sph::neighbourhood::Sources;
use crate::sph::stress_points::{Pull, Pulled, StressPointRecord};

/// What stress points show to velocity particles, kept from step to step.
#[derive(Debug, Default)]
pub(super) struct StressPoints {
    records: Vec<StressPointRecord>,
}

impl StressPoints {
    pub(super) fn memory(&self) -> usize {
        size_of::<StressPointRecord>() * self.records.capacity()
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
    /// Only clusters with halo particles among their neighbours, or only those without.
    halo: bool,
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
        let FromMirrors { places, forces } = self.from_mirrors;
        for (cluster, neighbours, among) in self.chunk.iter() {
            if among.halo != self.halo || cluster.group >= self.body_groups {
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
                places.clear();
                places.extend(neighbours.iter().copied().filter(behind));
                if places.is_empty() {
                    continue;
                }
                let part = Self::sum::<V>(self.motion, &self.sources, cluster, places).force[axis];
                for k in 0..cluster.lanes {
                    let mut force = [0.0; 3];
                    force[axis] = 2.0 * part.0[k];
                    forces.push(force);
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

impl Simulation {
    /// Second sweep: what stress points do to the velocity particles of the clusters that have halo
    /// particles among their neighbours, or of those that have none.
    pub(super) fn pull_by_stress_points(&mut self, halo: bool) {
        self.fill_stress_points(halo);
        let set = instructions();
        let search = &self.search;
        let chunks = search.clusters.chunks();
        let images = search.sequence.images();
        let Sweeps {
            scale,
            from_mirrors,
            ..
        } = &mut self.sweeps;
        from_mirrors.resize_with(chunks.len(), FromMirrors::default);
        let store = &mut self.store;
        let target = &PullTarget {
            images,
            mass: &store.mass,
            acceleration: Scatter::new(&mut store.acceleration),
            density: Scatter::new(&mut store.density),
            energy: Scatter::new(&mut store.specific_energy),
            power: Scatter::new(&mut store.d_specific_energy_dt),
            approach: Scatter::new(&mut store.approach_speed),
        };
        let sources = PullSources {
            points: &self.stress_points.records,
            images,
        };
        let body_groups = self.contact.body_groups;
        with_scale!(*scale, scale => chunks
        .par_iter()
        .zip(from_mirrors)
        .with_max_len(CHUNKS_AT_ONCE)
        .for_each(|(chunk, from_mirrors)| {
            if !halo {
                from_mirrors.forces.clear();
            }
            let motion = search.sources(scale);
            set.run(PullChunk { chunk, halo, body_groups, motion, sources, target, from_mirrors });
        }));
    }

    /// Records of halo stress points and their images, or of this rank's and theirs.
    fn fill_stress_points(&mut self, halo: bool) {
        let (store, sequence) = (&self.store, &self.search.sequence);
        let images = sequence.images();
        let first = sequence.group(self.contact.body_groups).start;
        let records = &mut self.stress_points.records;
        resize(records, images.len());
        let points = records[first..].par_iter_mut().zip(&images[first..]);
        points.with_min_len(GRAIN).for_each(|(record, image)| {
            let (i, code) = (image.base(), image.code());
            if (i >= store.owned()) == halo {
                *record = StressPointRecord {
                    moment: Mirrors::reflect_tensor(&store.stress_moment[i], code),
                    offset: Mirrors::reflect_vector(&store.stress_offset[i], code),
                    density: store.density[i],
                    heat: store.stress_heat[i],
                };
            }
        });
    }

    /// The rest of the drift of stress points in a step `dt` (s), which have moved by their velocity
    /// and by gravity: their mean velocity in the step is as much later than the last as that was
    /// later than the one before.
    pub(super) fn drift_stress_points(&mut self, dt: f64) {
        let gravity = self.loads.gravity;
        let store = &mut self.store;
        let points = (
            &mut store.position,
            &store.stress_mass,
            &store.drift_acceleration,
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
}
