//! The second sweep of stress points over the clusters of a task.

use super::from_mirrors::FromMirrors;
use super::neighbourhood::Sources;
use super::scale::Scale;
use super::step::Side;
use super::stress_points::{Pull, Pulled, StressPointRecord};
use crate::with_scale;
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::PairScale;
use numerics::lanes::Lanes;
use particles::MirrorForce;
use particles::neighbours::{Chunk, Cluster};
use particles::{Image, Scatter};

/// Inputs and outputs of the second sweep.
pub struct PullSweep<'a> {
    /// Places, velocities and volumes of all particles and images.
    pub motion: Sources<'a, Scale>,
    /// Records of all particles and images that are stress points.
    pub points: &'a [StressPointRecord],
    /// All particles and images, in the order of the lists.
    pub images: &'a [Image],
    /// Groups below are of velocity particles.
    pub body_groups: usize,
    /// Side of the clusters that are swept.
    pub side: Side,
    /// Its target.
    pub target: PullTarget<'a>,
}

impl PullSweep<'_> {
    /// Sweeps the clusters of a task.
    pub fn sweep(&self, chunk: &Chunk, from_mirrors: &mut FromMirrors) {
        with_scale!(self.motion.scale, scale => instructions().run(PullChunk {
            all: self,
            motion: self.motion.with(scale),
            chunk,
            from_mirrors,
        }));
    }
}

/// Target of the sweep.
pub struct PullTarget<'a> {
    /// Mass (kg).
    pub mass: &'a [f64],
    /// Acceleration (m/s²).
    pub acceleration: Scatter<'a, [f64; 3]>,
    /// Rate of the density (kg/(m³ s)).
    pub density: Scatter<'a, f64>,
    /// Rate of the specific energy (W/kg).
    pub energy: Scatter<'a, f64>,
    /// Power of the stresses (W/kg).
    pub power: Scatter<'a, f64>,
    /// The largest speed of approach (m/s).
    pub approach: Scatter<'a, f64>,
}

impl PullTarget<'_> {
    #[inline(always)]
    fn store(&self, images: &[Image], cluster: &Cluster, pulled: &Pulled) {
        for k in 0..cluster.lanes {
            let i = images[cluster.receivers[k] as usize].slot();
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
    all: &'a PullSweep<'a>,
    motion: Sources<'a, S>,
    chunk: &'a Chunk,
    from_mirrors: &'a mut FromMirrors,
}

impl<S: PairScale> Vectorised for PullChunk<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let all = self.all;
        let FromMirrors { indices, forces } = self.from_mirrors;
        for (cluster, neighbours, among) in self.chunk.iter() {
            if !all.side.takes(among.halo) || cluster.group >= all.body_groups {
                continue;
            }
            let pulled = Self::sum::<V>(self.motion, all.points, cluster, neighbours);
            all.target.store(all.images, cluster, &pulled);
            if !among.mirrors {
                continue;
            }
            // Stress points on this side pull at images too. What all do to the particles on this
            // side adds up to twice the part of those behind a plane along its normal, and to none
            // along the plane.
            for axis in 0..3 {
                let behind = |&j: &u32| all.images[j as usize].mirror_mask().has(axis);
                indices.clear();
                indices.extend(neighbours.iter().copied().filter(behind));
                if indices.is_empty() {
                    continue;
                }
                let part = Self::sum::<V>(self.motion, all.points, cluster, indices).force[axis];
                for k in 0..cluster.lanes {
                    let mut force = [0.0; 3];
                    force[axis] = 2.0 * part.0[k];
                    let i = all.images[cluster.receivers[k] as usize].slot();
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
        points: &[StressPointRecord],
        cluster: &Cluster,
        neighbours: &[u32],
    ) -> Pulled {
        let sums = Pull {
            around: motion.around(cluster.receivers, neighbours),
            points,
        };
        sums.run::<V>()
    }
}
