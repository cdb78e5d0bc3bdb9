//! Self-gravity of all particles: a tree of quadrupoles whose bits do not depend on ranks and threads (Barnes & Hut 1986,
//! Nature 324, 446; Hernquist 1987, Astrophysical Journal Supplement 64, 715).
//!
//! Cells are those of a cube around all particles. Which of them counts as one body for a particle follows from the cell that
//! the particle lies in, so from places alone. Their moments are sums of whole numbers.

mod cube;
mod essential;
mod moments;
mod pull;
mod tree;
mod trees;

#[cfg(test)]
mod tests;

use rayon::prelude::*;

use crate::contact::ContactSums;
use crate::diagnose::RunState;
use crate::loads::sum_over;
use crate::sph::Smoothing;
use comm::{Comm, Traffic};
use cube::Cube;
use model::Case;
use numerics::exact_sum::ExactSum;
use numerics::vector::cross;
use particles::{GRAIN, Mirrors, ParticleStore, Scatter, resize};
use tree::Point;
use trees::Trees;

/// Bytes that the trees take for an owned particle, and for one of a halo, if there is a halo: twice as many are told. Cells hold
/// some fifteen particles.
pub const BYTES: [usize; 2] = {
    let point = size_of::<Point>() + tree::BYTES_OF_BIN / 15;
    [2 * point + size_of::<[f64; 3]>(), 6 * point]
};

/// Self-gravity of a case that has it.
pub struct SelfGravity {
    options: model::SelfGravity,
    /// Lengths that soften it: those of the start, so that the force has a potential.
    smoothing: Smoothing,
    trees: Trees,
    /// Acceleration by images behind symmetry planes (m/s²), if there are any.
    of_images: Vec<[f64; 3]>,
    /// Potential energy (J).
    energy: ExactSum,
    /// Force (N) of all on all without that of images, which the error of the tree makes.
    force: [ExactSum; 3],
}

impl SelfGravity {
    /// Of a case, if it has self-gravity.
    pub(crate) fn new(case: &Case) -> Option<Self> {
        case.loads.self_gravity.map(|options| Self {
            options,
            smoothing: Smoothing::new(case),
            trees: Trees::default(),
            of_images: Vec::new(),
            energy: ExactSum::default(),
            force: Default::default(),
        })
    }

    /// Bytes allocated.
    pub(crate) fn memory(&self) -> usize {
        self.trees.memory() + size_of::<[f64; 3]>() * self.of_images.capacity()
    }

    /// Messages and bytes that this rank has sent for it.
    pub(crate) fn traffic(&self) -> Traffic {
        self.trees.traffic()
    }

    /// Accelerations and potentials of the particles where they are. Adds the forces of images, and the torque of all, to
    /// `outside`. Collective.
    pub(crate) fn act(
        &mut self,
        comm: &Comm,
        particles: &mut ParticleStore,
        mirrors: &Mirrors,
        outside: &mut ContactSums,
    ) {
        self.show(particles);
        let cube = self.trees.grow(comm, &self.options, mirrors);
        self.pull(&cube, particles, mirrors);
        self.sum(particles, outside);
    }

    /// The sums over this rank's particles, to be joined with those of others.
    pub(crate) fn exact(&mut self) -> impl Iterator<Item = &mut ExactSum> {
        self.force.iter_mut().chain([&mut self.energy])
    }

    /// Books the sums of all ranks, after the second half of a step `dt` (s).
    pub(crate) fn book(&self, state: &mut RunState, dt: f64) {
        state.self_gravity_energy = self.energy.value();
        for a in 0..3 {
            state.tree_force[a] = self.force[a].value();
            state.tree_impulse[a] += 0.5 * dt * state.tree_force[a];
        }
    }

    /// Gives the particles to the trees.
    fn show(&mut self, particles: &ParticleStore) {
        let smoothing = &self.smoothing;
        let points = self.trees.points();
        resize(points, particles.owned());
        let points = points.par_iter_mut().with_min_len(GRAIN).enumerate();
        points.for_each(|(i, point)| {
            let mass = particles.mass[i];
            *point = Point {
                key: 0,
                id: particles.id[i],
                position: particles.position[i],
                mass,
                length: smoothing.at_start(particles.body[i] as usize, mass),
                index: i as u64,
            };
        });
    }

    /// What the trees exert on the particles.
    fn pull(&mut self, cube: &Cube, particles: &mut ParticleStore, mirrors: &Mirrors) {
        let images = if mirrors.is_empty() {
            0
        } else {
            particles.owned()
        };
        resize(&mut self.of_images, images);
        let scaled = |pull: f64| self.options.constant * pull;
        let accelerations = Scatter::new(&mut particles.gravity_acceleration);
        let potentials = Scatter::new(&mut particles.gravity_potential);
        let of_images = Scatter::new(&mut self.of_images);
        self.trees.pull(cube, mirrors, |point, [own, image]| {
            let i = usize::try_from(point.index).unwrap_or(usize::MAX);
            let [x, y, z, depth] = own;
            let [u, v, w, depth_of_images] = image;
            // SAFETY: each particle is received once.
            unsafe {
                *accelerations.slot(i) = [x + u, y + v, z + w].map(scaled);
                *potentials.slot(i) = scaled(depth + depth_of_images);
                if !of_images.is_empty() {
                    *of_images.slot(i) = [u, v, w].map(scaled);
                }
            }
        });
    }

    /// Sums over this rank's particles.
    fn sum(&mut self, particles: &ParticleStore, outside: &mut ContactSums) {
        let of_images = &self.of_images;
        let [energy, sums @ ..] = sum_over(particles.owned(), |i| {
            let mass = particles.mass[i];
            let force = |a: &[f64; 3]| a.map(|a| mass * a);
            let whole = force(&particles.gravity_acceleration[i]);
            let [x, y, z] = whole;
            let [u, v, w] = force(of_images.get(i).unwrap_or(&[0.0; 3]));
            let [a, b, c] = cross(&particles.position[i], &whole);
            let energy = 0.5 * mass * particles.gravity_potential[i];
            Some([energy, x, y, z, -u, -v, -w, u, v, w, a, b, c])
        });
        let [x, y, z, less_x, less_y, less_z, u, v, w, a, b, c] = sums;
        (self.energy, self.force) = (energy, [x, y, z]);
        let merge = |sums: &mut [ExactSum; 3], parts: [ExactSum; 3]| {
            for (sum, part) in sums.iter_mut().zip(&parts) {
                sum.merge(part);
            }
        };
        merge(&mut self.force, [less_x, less_y, less_z]);
        merge(&mut outside.plane_force, [u, v, w]);
        merge(&mut outside.outside_torque, [a, b, c]);
    }
}
