//! Input of measures: this rank's particles, and sums over those of all ranks.

use rayon::prelude::*;

use comm::Comm;
use material::FAILED;
use model::{Case, edge};
use numerics::exact_sum::{gather_limbs, scatter_limbs};
use numerics::gathered_sums::{self, GatheredSums};
use numerics::ordered::{disordered, ordered};
use particles::Mirrors;
use particles::{GRAIN, ParticleStore};

/// This rank's matter at a time, by particle.
#[derive(Clone, Copy)]
pub struct Matter<'a> {
    /// The case, of which bodies and materials are used.
    pub case: &'a Case,
    /// Its symmetry planes.
    pub mirrors: Mirrors,
    /// Indices of bodies.
    pub body: &'a [u32],
    /// Positions (m).
    pub position: &'a [[f64; 3]],
    /// Velocities (m/s).
    pub velocity: &'a [[f64; 3]],
    /// Masses (kg).
    pub mass: &'a [f64],
    /// Masses of stress points (kg), which do not move; empty if there are none.
    pub stress_mass: &'a [f64],
    /// Densities (kg/m³).
    pub density: &'a [f64],
    /// Pressures (Pa).
    pub pressure: &'a [f64],
    /// Equivalent plastic strains.
    pub plastic_strain: &'a [f64],
    /// Damage; empty if nothing may fail.
    pub damage: &'a [f64],
}

/// Matter that is kept apart from a store, without stress points.
#[derive(Debug, Default)]
pub struct HeldMatter {
    /// Indices of bodies.
    pub body: Vec<u32>,
    /// Positions (m).
    pub position: Vec<[f64; 3]>,
    /// Velocities (m/s).
    pub velocity: Vec<[f64; 3]>,
    /// Masses (kg).
    pub mass: Vec<f64>,
    /// Densities (kg/m³).
    pub density: Vec<f64>,
    /// Pressures (Pa).
    pub pressure: Vec<f64>,
    /// Equivalent plastic strains.
    pub plastic_strain: Vec<f64>,
    /// Damage; empty if nothing may fail.
    pub damage: Vec<f64>,
}

impl HeldMatter {
    /// As measures take it, of a case.
    #[must_use]
    pub fn of<'a>(&'a self, case: &'a Case) -> Matter<'a> {
        Matter {
            case,
            mirrors: Mirrors::of(case),
            body: &self.body,
            position: &self.position,
            velocity: &self.velocity,
            mass: &self.mass,
            stress_mass: &[],
            density: &self.density,
            pressure: &self.pressure,
            plastic_strain: &self.plastic_strain,
            damage: &self.damage,
        }
    }
}

impl<'a> Matter<'a> {
    /// The owned particles of a store.
    #[must_use]
    pub fn of(case: &'a Case, mirrors: &'a Mirrors, particles: &'a ParticleStore) -> Self {
        let owned = particles.owned();
        let held = |values: &'a [f64]| &values[..owned.min(values.len())];
        Self {
            case,
            mirrors: *mirrors,
            body: &particles.body[..owned],
            position: &particles.position[..owned],
            velocity: &particles.velocity[..owned],
            mass: &particles.mass[..owned],
            stress_mass: held(&particles.stress_mass),
            density: &particles.density[..owned],
            pressure: &particles.pressure[..owned],
            plastic_strain: &particles.plastic_strain[..owned],
            damage: held(&particles.damage),
        }
    }

    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.body.len()
    }

    /// True if there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.body.is_empty()
    }

    /// Index of a particle's body.
    #[must_use]
    pub fn body_of(&self, i: usize) -> usize {
        self.body[i] as usize
    }

    /// Volume (m³) of a particle.
    #[must_use]
    pub fn volume(&self, i: usize) -> f64 {
        let stress_mass = self.stress_mass.get(i).copied().unwrap_or_default();
        (self.mass[i] + stress_mass) / self.density[i]
    }

    /// Edge (m) of a cube of that volume, in two dimensions of a square.
    #[must_use]
    pub fn size(&self, i: usize) -> f64 {
        edge(self.volume(i), self.case.dimension)
    }

    /// True if a particle has failed.
    #[must_use]
    pub fn has_failed(&self, i: usize) -> bool {
        self.damage.get(i).is_some_and(|&damage| damage >= FAILED)
    }

    /// A particle's positions (m) and velocities (m/s), those of its images with them.
    pub fn images(&self, i: usize) -> impl Iterator<Item = ([f64; 3], [f64; 3])> {
        let (x, v) = (&self.position[i], &self.velocity[i]);
        self.mirrors.masks().map(move |mirror_mask| {
            (
                self.mirrors.reflect_position(x, mirror_mask),
                Mirrors::reflect_vector(v, mirror_mask),
            )
        })
    }

    /// Sums over the particles of all ranks: `terms` adds terms of one. Collective.
    pub fn sums<const N: usize>(
        &self,
        comm: &Comm,
        terms: impl Fn(usize, &mut GatheredSums<N>) + Sync,
    ) -> [f64; N] {
        let of_chunk = |mut sums: GatheredSums<N>, chunk: usize| {
            for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(self.len()) {
                terms(i, &mut sums);
            }
            sums
        };
        let chunks = (0..self.len().div_ceil(GRAIN)).into_par_iter();
        // same bits in any order: exact sums
        let mut sums = chunks
            .fold(GatheredSums::default, of_chunk)
            .map(GatheredSums::into_sums)
            .reduce(gathered_sums::none, gathered_sums::merged);
        let mut limbs = Vec::new();
        gather_limbs(sums.iter_mut(), &mut limbs);
        comm.sum_i64(&mut limbs);
        scatter_limbs(sums.iter_mut(), &limbs);
        sums.map(|sum| sum.value())
    }

    /// Largest values over the particles of all ranks: `terms` raises them by one; −∞ where there is
    /// none. Collective.
    pub fn largest<const N: usize>(
        &self,
        comm: &Comm,
        terms: impl Fn(usize, &mut [f64; N]) + Sync,
    ) -> [f64; N] {
        let none = || [f64::NEG_INFINITY; N];
        let of_chunk = |mut most: [f64; N], chunk: usize| {
            for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(self.len()) {
                terms(i, &mut most);
            }
            most
        };
        let join = |mut most: [f64; N], others: [f64; N]| {
            most.iter_mut().zip(others).for_each(|(a, b)| raise(a, b));
            most
        };
        let chunks = (0..self.len().div_ceil(GRAIN)).into_par_iter();
        // same bits in any order: some value among all
        let most = chunks.fold(none, of_chunk).reduce(none, join);
        let mut words = most.map(ordered);
        comm.max_u64(&mut words);
        words.map(disordered)
    }

    /// Largest values by bin over the particles of all ranks: `terms` raises bins by one; −∞ where there is none.
    /// Collective.
    #[must_use]
    pub fn largest_by_bin(
        &self,
        comm: &Comm,
        bins: usize,
        terms: impl Fn(usize, &mut [f64]) + Sync,
    ) -> Vec<f64> {
        let none = || vec![f64::NEG_INFINITY; bins];
        let of_chunk = |mut most: Vec<f64>, chunk: usize| {
            for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(self.len()) {
                terms(i, &mut most);
            }
            most
        };
        let join = |mut most: Vec<f64>, others: Vec<f64>| {
            most.iter_mut().zip(others).for_each(|(a, b)| raise(a, b));
            most
        };
        let chunks = (0..self.len().div_ceil(GRAIN)).into_par_iter();
        // same bits in any order: some value among all
        let most = chunks.fold(none, of_chunk).reduce(none, join);
        let mut words: Vec<u64> = most.into_iter().map(ordered).collect();
        comm.max_u64(&mut words);
        words.into_iter().map(disordered).collect()
    }

    /// Counts by bin over the particles of all ranks: `terms` adds to bins. Collective.
    #[must_use]
    pub fn counts(
        &self,
        comm: &Comm,
        bins: usize,
        terms: impl Fn(usize, &mut [i64]) + Sync,
    ) -> Vec<i64> {
        let none = || vec![0; bins];
        let of_chunk = |mut counts: Vec<i64>, chunk: usize| {
            for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(self.len()) {
                terms(i, &mut counts);
            }
            counts
        };
        let join = |mut counts: Vec<i64>, others: Vec<i64>| {
            counts.iter_mut().zip(others).for_each(|(a, b)| *a += b);
            counts
        };
        let chunks = (0..self.len().div_ceil(GRAIN)).into_par_iter();
        // same bits in any order: whole numbers
        let mut counts = chunks.fold(none, of_chunk).reduce(none, join);
        comm.sum_i64(&mut counts);
        counts
    }
}

/// Raises a largest value. What is no number has been refused by the choice of the step; zero has one sign.
pub fn raise(most: &mut f64, value: f64) {
    *most = if value > *most { value + 0.0 } else { *most };
}
