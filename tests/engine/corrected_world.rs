//! Clouds to which the sweeps of corrected SPH are applied, and plain sums beside them.

use model::Vec3;
use nalgebra::Matrix3;
use numerics::dispatch::{Instructions, available};
use numerics::kernel::{Kernel, PairScale};
use particles::Mirrors;
use particles::neighbours::Chunk;
use sums::corrected::{Corrected, CorrectedGradient, CorrectedRecord};
use sums::momentum::{Forces, Momentum, Viscosity};
use sums::neighbourhood::Sources;
use sums::terms::PairTerms;

use crate::cloud::{Cloud, Found};
use crate::common::random::Random;

pub type Matrix = Matrix3<f64>;

/// A cloud with its images, each of which has a mass and a density.
pub struct World {
    pub cloud: Cloud,
    pub found: Found,
    pub kernel: Kernel,
    /// By image.
    pub density: Vec<f64>,
    pub sigma: Vec<Matrix>,
}

impl World {
    pub fn new(mut cloud: Cloud, seed: u64) -> Self {
        cloud.owned = cloud.id.len();
        let mut found = cloud.find();
        let mut random = Random::new(seed);
        let own: Vec<([f64; 6], f64, f64)> = (0..cloud.id.len())
            .map(|_| {
                let stress = std::array::from_fn(|_| random.within(-1.0, 1.0));
                (stress, random.within(0.5, 2.0), random.within(0.5, 2.0))
            })
            .collect();
        let (mut density, mut sigma) = (Vec::new(), Vec::new());
        for (image, motion) in found.sequence.images().iter().zip(&mut found.motion) {
            let (stress, mass, rho) = own[image.slot()];
            (motion.mass, motion.volume) = (mass, mass / rho);
            let [xx, yy, zz, xy, mut xz, mut yz] =
                Mirrors::reflect_symmetric(&stress, image.mirror_mask());
            if cloud.dimension < 3 {
                (xz, yz) = (0.0, 0.0);
            }
            sigma.push(Matrix::new(xx, xy, xz, xy, yy, yz, xz, yz, zz));
            density.push(rho);
        }
        Self {
            kernel: Kernel::new(cloud.dimension),
            cloud,
            found,
            density,
            sigma,
        }
    }

    pub fn velocity(&self, i: usize) -> Vec3 {
        Vec3::from(self.found.motion[i].velocity)
    }

    /// The other particles of image i's group within reach, with `x_j − x_i` and `∇W_ij`.
    pub fn near(&self, i: usize) -> Vec<(usize, Vec3, Vec3)> {
        let group = self.cloud.group(self.found.sequence.images()[i].slot());
        let at = |k: usize| Vec3::from(self.found.motion[k].position);
        let h = self.found.sequence.smoothing_lengths();
        let others = self.found.sequence.group(group).filter(|&j| j != i);
        let pairs = others.filter_map(|j| {
            let (r, h) = (at(j) - at(i), 0.5 * (h[i] + h[j]));
            let slope = self.kernel.slope(r.norm(), h);
            (r.norm() < 2.0 * h).then(|| (j, r, -r * (slope / r.norm())))
        });
        pairs.collect()
    }

    /// `M`, one along axes that the cloud does not have.
    pub fn moment(&self, i: usize) -> Matrix {
        let near = self.near(i);
        let volume = |j: usize| self.found.motion[j].volume;
        let mut m: Matrix = (near.iter().map(|&(j, r, g)| r * g.transpose() * volume(j))).sum();
        for a in self.cloud.dimension..3 {
            m[(a, a)] = 1.0;
        }
        m
    }

    /// Square of the mean separation from the neighbours over the mean square.
    pub fn one_sided(&self, i: usize) -> f64 {
        let (mut place, mut square, mut weights) = (Vec3::zeros(), 0.0, 0.0);
        for (j, r, g) in self.near(i) {
            let weight = self.found.motion[j].volume * r.norm() * g.norm();
            place += r * weight;
            square += r.norm_squared() * weight;
            weights += weight;
        }
        place.norm_squared() / (square * weights).max(f64::MIN_POSITIVE)
    }

    /// `L₀`, and the sum of the sizes of its terms.
    pub fn plain_gradient(&self, i: usize, velocity: impl Fn(usize) -> Vec3) -> (Matrix, f64) {
        let (mut gradient, mut size) = (Matrix::zeros(), 0.0);
        for (j, _, g) in self.near(i) {
            let v = (velocity(j) - velocity(i)) * self.found.motion[j].volume;
            gradient += v * g.transpose();
            size += v.norm() * g.norm();
        }
        (gradient, size)
    }

    /// Mean velocity of the neighbours that a velocity gradient does not explain.
    pub fn rest(&self, i: usize, expected: &Matrix) -> Vec3 {
        let (mut sum, mut weights) = (Vec3::zeros(), 0.0);
        for (j, r, g) in self.near(i) {
            let weight = self.found.motion[j].volume * r.norm() * g.norm();
            sum += (self.velocity(j) - self.velocity(i) - expected * r) * weight;
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { sum }
    }

    pub fn sources<S>(&self, scale: S) -> Sources<'_, S> {
        Sources {
            records: &self.found.motion,
            lengths: self.found.sequence.smoothing_lengths(),
            scale,
        }
    }

    /// No hourglass displacement anywhere.
    pub fn straight(&self) -> Vec<Vec3> {
        vec![Vec3::zeros(); self.found.motion.len()]
    }

    /// The first sweep, with the same bits by all instruction sets.
    pub fn rates<S: PairScale>(
        &self,
        scale: S,
        plain: u8,
        mut check: impl FnMut(&[u32], &Corrected),
    ) {
        let chunks = self.found.clusters.chunks();
        for (cluster, list, _) in chunks.iter().flat_map(Chunk::iter) {
            let all: Vec<Corrected> = (available().iter())
                .map(|set| {
                    set.run(CorrectedGradient {
                        around: self.sources(scale).around(cluster.receivers, list),
                        dimension: self.cloud.dimension,
                        plain,
                    })
                })
                .collect();
            for other in &all {
                assert_eq!(other.gradient, all[0].gradient);
                assert_eq!(other.rest, all[0].rest);
                assert_eq!(other.correction.outer, all[0].correction.outer);
                assert_eq!(other.correction.inner, all[0].correction.inner);
            }
            check(&cluster.receivers[..cluster.lanes], &all[0]);
        }
    }

    /// The second sweep with stresses `P` between corrections and this α and speed of the artificial viscosity, the same
    /// bits by all instruction sets.
    pub fn forces<S: PairScale>(
        &self,
        scale: S,
        pair_stress: &[Matrix],
        hourglass: &[Vec3],
        [alpha, viscous_speed]: [f64; 2],
        mut visit: impl FnMut(usize, usize, &Forces),
    ) {
        let records: Vec<_> = (pair_stress.iter().zip(&self.density).zip(hourglass))
            .map(|((p, &density), &hourglass)| CorrectedRecord {
                stress: p.transpose().as_slice().try_into().unwrap(),
                hourglass: hourglass.into(),
                density,
                viscous_speed,
                viscous_share: 1.0,
            })
            .collect();
        let chunks = self.found.clusters.chunks();
        for (cluster, list, _) in chunks.iter().flat_map(Chunk::iter) {
            let sums = |set: Instructions| {
                set.run(Momentum::<S, CorrectedRecord, false> {
                    around: self.sources(scale).around(cluster.receivers, list),
                    stresses: &records,
                    viscosity: Viscosity {
                        alpha,
                        beta: 2.0 * alpha,
                        negligible: 0.0,
                    },
                    terms: PairTerms::default(),
                })
            };
            let first = sums(available()[0]);
            for set in available() {
                assert_eq!(sums(set).acceleration, first.acceleration, "{}", set.name());
                assert_eq!(sums(set).power, first.power, "{}", set.name());
            }
            for (k, &place) in cluster.receivers[..cluster.lanes].iter().enumerate() {
                visit(k, place as usize, &first);
            }
        }
    }
}
