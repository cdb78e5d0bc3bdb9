//! Stress points in the step: strain and stress at them in the first sweep, what they do to
//! velocity particles in the second, and how they follow those.

use std::sync::atomic::{AtomicI64, Ordering};

use rayon::prelude::*;

use super::material_update::MaterialUpdate;
use super::search::GRAIN;
use super::simulation::Simulation;
use super::sweeps::{FromMirrors, Sweeps, with_scale};
use crate::domain::Mirrors;
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, Cluster, Image};
use crate::particles::{ParticleStore, Scatter, resize};
use crate::sph::dispatch::{Vectorised, instructions};
use crate::sph::gradient::MotionRecord;
use crate::sph::kernel::PairScale;
use crate::sph::lanes::Lanes;
use crate::sph::momentum::Viscosity;
use crate::sph::normalised::stress_power;
use crate::sph::stress_points::{
    Fitted, LinearFit, Pull, Pulled, StressPointRecord, moment, viscous_stress,
};

/// The quadratic viscosity limits steps by three times the approach speed at a stress point: its
/// rate is `4 (½ h)(α c + 2 β h E)/Δp²`, twice the mean by its slope, and grids alternate by
/// `2/Δp`; pairs of the other forms reach farther.
const APPROACH: f64 = 3.0;

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

/// Fields of stress points, out of the store while the material is updated.
struct Fields {
    moment: Vec<[f64; 9]>,
    offset: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    acceleration: Vec<[f64; 3]>,
}

impl Fields {
    fn take(store: &mut ParticleStore) -> Self {
        Self {
            moment: std::mem::take(&mut store.stress_moment),
            offset: std::mem::take(&mut store.stress_offset),
            velocity: std::mem::take(&mut store.velocity),
            acceleration: std::mem::take(&mut store.drift_acceleration),
        }
    }

    fn give_back(self, store: &mut ParticleStore) {
        store.stress_moment = self.moment;
        store.stress_offset = self.offset;
        store.velocity = self.velocity;
        store.drift_acceleration = self.acceleration;
    }

    fn target(&mut self, dt: f64, gravity: [f64; 3]) -> FitTarget<'_> {
        FitTarget {
            moment: Scatter::new(&mut self.moment),
            offset: Scatter::new(&mut self.offset),
            velocity: Scatter::new(&mut self.velocity),
            acceleration: Scatter::new(&mut self.acceleration),
            incomplete: AtomicI64::new(0),
            dt,
            gravity,
        }
    }
}

/// Where the first sweep writes what it finds at stress points: velocities, and the geometry of
/// fits in place of the moments that follow from it.
struct FitTarget<'a> {
    moment: Scatter<'a, [f64; 9]>,
    offset: Scatter<'a, [f64; 3]>,
    velocity: Scatter<'a, [f64; 3]>,
    acceleration: Scatter<'a, [f64; 3]>,
    incomplete: AtomicI64,
    dt: f64,
    gravity: [f64; 3],
}

impl FitTarget<'_> {
    #[inline(always)]
    fn store(&self, i: usize, k: usize, fitted: &Fitted) {
        let fit = &fitted.fits[k];
        if !fit.complete {
            // same bits in any order: a count
            self.incomplete.fetch_add(1, Ordering::Relaxed);
        }
        // SAFETY: particle `i` belongs to one cluster alone, and this thread has the cluster.
        let (v, drift) = unsafe {
            *self.moment.slot(i) = fit.inverse;
            *self.offset.slot(i) = fit.offset;
            (self.velocity.slot(i), self.acceleration.slot(i))
        };
        for a in 0..3 {
            // Half kicks know gravity alone, as long as the other half is to come.
            let pull = 0.5 * self.dt * self.gravity[a];
            let after = fitted.velocity[a].0[k];
            if self.dt > 0.0 {
                drift[a] = (after - (v[a] - pull)) / self.dt;
            }
            v[a] = after - pull;
        }
    }
}

/// The first sweep over one task's clusters.
struct FitChunk<'a, S> {
    chunk: &'a Chunk,
    sources: &'a [MotionRecord],
    lengths: &'a [f64],
    scale: S,
    dimension: usize,
    body_groups: usize,
    images: &'a [Image],
    update: &'a MaterialUpdate<'a>,
    target: &'a FitTarget<'a>,
}

impl<S: PairScale> Vectorised for FitChunk<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (cluster, neighbours, _) in self.chunk.iter() {
            if cluster.group < self.body_groups {
                self.update.store_free(cluster, neighbours.len());
                continue;
            }
            let sums = LinearFit {
                sources: self.sources,
                lengths: self.lengths,
                receivers: cluster.receivers,
                neighbours,
                scale: self.scale,
                dimension: self.dimension,
            };
            let fitted = sums.run::<V>();
            for k in 0..cluster.lanes {
                let i = self.images[cluster.receivers[k] as usize].base();
                self.target.store(i, k, &fitted);
            }
            self.update
                .apply(cluster, &fitted.gradient, neighbours.len());
        }
    }
}

/// What the second sweep reads.
#[derive(Clone, Copy)]
struct PullSources<'a> {
    motion: &'a [MotionRecord],
    lengths: &'a [f64],
    points: &'a [StressPointRecord],
    images: &'a [Image],
}

/// Where it writes.
struct PullTarget<'a> {
    images: &'a [Image],
    mass: &'a [f64],
    acceleration: Scatter<'a, [f64; 3]>,
    density: Scatter<'a, f64>,
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
    sources: PullSources<'a>,
    scale: S,
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
            let pulled = Self::sum::<V>(&self.sources, self.scale, cluster, neighbours);
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
                let part = Self::sum::<V>(&self.sources, self.scale, cluster, places).force[axis];
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
        sources: &PullSources,
        scale: S,
        cluster: &Cluster,
        neighbours: &[u32],
    ) -> Pulled {
        let sums = Pull {
            sources: sources.motion,
            lengths: sources.lengths,
            points: sources.points,
            receivers: cluster.receivers,
            neighbours,
            scale,
        };
        sums.run::<V>()
    }
}

impl Simulation {
    /// First sweep: velocities and strain rates at stress points, material and moments there.
    pub(super) fn strain_stress_points(&mut self, dt: f64) {
        let set = instructions();
        let mut fields = Fields::take(&mut self.store);
        let update = &MaterialUpdate::new(
            &mut self.store,
            &mut self.sweeps.stresses,
            self.search.sequence.images(),
            &self.case.materials,
            &self.sweeps.material_of_body,
            &self.contact.rigid,
            dt,
        );
        let target = &fields.target(dt, self.loads.gravity);
        let sources = &self.search.motion[..];
        let lengths = self.search.sequence.smoothing_lengths();
        let images = self.search.sequence.images();
        let (dimension, body_groups) = (self.case.dimension, self.contact.body_groups);
        let chunks = self.search.clusters.chunks().par_iter();
        let chunks = chunks.with_max_len(CHUNKS_AT_ONCE);
        with_scale!(self.sweeps.scale, scale => chunks.for_each(|chunk| {
            set.run(FitChunk {
                chunk, sources, lengths, scale, dimension, body_groups, images, update, target,
            });
        }));
        self.sums.uncorrected = target.incomplete.load(Ordering::Relaxed);
        fields.give_back(&mut self.store);
        self.find_moments();
    }

    /// Moments of this rank's stress points from their stress, that of viscosity included, and
    /// their power.
    fn find_moments(&mut self) {
        let viscosity = self.sweeps.viscosity;
        let store = &mut self.store;
        let owned = store.owned();
        let point = PointView {
            stress_mass: &store.stress_mass,
            predicted_density: &store.predicted_density,
            density: &store.density,
            pressure: &store.pressure,
            deviatoric_stress: &store.deviatoric_stress,
            velocity_gradient: &store.velocity_gradient,
            sound_speed: &store.sound_speed,
            smoothing_length: &store.smoothing_length,
            viscosity,
        };
        (
            &mut store.stress_moment[..owned],
            &mut store.stress_offset[..owned],
            &mut store.d_specific_energy_dt,
            &mut store.approach_speed,
        )
            .into_par_iter()
            .with_min_len(GRAIN)
            .enumerate()
            .for_each(|(i, (moment, offset, power, approach))| {
                if point.stress_mass[i] > 0.0 {
                    (*power, *approach) = point.stress(i, moment, offset);
                } else {
                    (*moment, *offset) = ([0.0; 9], [0.0; 3]);
                }
            });
    }

    /// Second sweep: what stress points do to the velocity particles of the clusters that have halo
    /// particles among their neighbours, or of those that have none.
    pub(super) fn pull_by_stress_points(&mut self, halo: bool) {
        self.fill_stress_points(halo);
        let set = instructions();
        let chunks = self.search.clusters.chunks();
        let images = self.search.sequence.images();
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
            power: Scatter::new(&mut store.d_specific_energy_dt),
            approach: Scatter::new(&mut store.approach_speed),
        };
        let sources = PullSources {
            motion: &self.search.motion,
            lengths: self.search.sequence.smoothing_lengths(),
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
            set.run(PullChunk { chunk, halo, body_groups, sources, scale, target, from_mirrors });
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

/// What the stress of a stress point depends on.
struct PointView<'a> {
    stress_mass: &'a [f64],
    predicted_density: &'a [f64],
    density: &'a [f64],
    pressure: &'a [f64],
    deviatoric_stress: &'a [[f64; 6]],
    velocity_gradient: &'a [[f64; 9]],
    sound_speed: &'a [f64],
    smoothing_length: &'a [f64],
    viscosity: Viscosity,
}

impl PointView<'_> {
    /// Turns the geometry of the fit of point `i` into its moment; gives its power (W/kg) and the
    /// approach speed for the time step (m/s).
    #[inline]
    fn stress(&self, i: usize, inverse: &mut [f64; 9], offset: &mut [f64; 3]) -> (f64, f64) {
        let l = &self.velocity_gradient[i];
        let (mut total, approach) = viscous_stress(
            l,
            self.density[i],
            self.sound_speed[i],
            self.smoothing_length[i],
            &self.viscosity,
        );
        for c in 0..6 {
            total[c] += self.deviatoric_stress[i][c];
        }
        let pressure = self.pressure[i];
        let density = self.predicted_density[i];
        let power = stress_power(pressure, &total, l, density);
        for a in 0..3 {
            total[a] -= pressure;
        }
        let volume = self.stress_mass[i] / density;
        (*inverse, *offset) = moment(&total, volume, inverse, offset);
        (power, APPROACH * approach)
    }
}
