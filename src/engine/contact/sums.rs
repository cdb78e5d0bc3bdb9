//! Sums of contact: exact sums, counts and extremes, of pairs of bodies and of all.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::force::BodyForce;
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use numerics::gathered_sums::{self, GatheredSums};
use numerics::vector::cross;
use particles::MirrorForce;

/// Extremes of a pair of bodies in an interval of steps.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PairExtremes {
    /// Largest magnitude of the force between the two that are computed (N).
    pub peak_force: f64,
    /// The same without what images behind symmetry planes cancel (N).
    #[serde(default)]
    pub peak_along: f64,
    /// Largest excess.
    pub largest_excess: f64,
    /// The nearest two particles; absent when none was in reach.
    pub closest: Option<Closest>,
    /// The smallest contact criterion (s); absent without contact force.
    pub contact_dt: Option<f64>,
}

impl PairExtremes {
    /// Takes those of another interval, or of other particles, in.
    pub(crate) fn join(&mut self, other: &Self) {
        self.peak_force = self.peak_force.max(other.peak_force);
        self.peak_along = self.peak_along.max(other.peak_along);
        self.largest_excess = self.largest_excess.max(other.largest_excess);
        self.closest = match (self.closest, other.closest) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        self.contact_dt = least(self.contact_dt, other.contact_dt);
    }
}

/// Two particles of two bodies that are near each other, or one and the other's mirror image.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Closest {
    /// Their distance in mean spacings.
    pub distance: f64,
    /// Their identities, in the order of the bodies.
    pub particles: [u64; 2],
}

impl Closest {
    /// The nearer two; the smaller identities of two that are as near.
    fn min(self, other: Self) -> Self {
        let order = |c: &Self| (c.distance.to_bits(), c.particles);
        if order(&other) < order(&self) {
            other
        } else {
            self
        }
    }
}

/// Number of an unordered pair of bodies among all of `bodies`: these order as `[a, b]`, `a ≤ b`,
/// do.
pub(crate) fn pair_key(bodies: usize, a: usize, b: usize) -> usize {
    a.min(b) * bodies + a.max(b)
}

/// The pair of a number, see [`pair_key`].
pub(crate) fn pair_of(bodies: usize, key: usize) -> [usize; 2] {
    [key / bodies, key % bodies]
}

/// Sums of contact over some particles.
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactSums {
    pub energy: ExactSum,
    /// Force of symmetry planes, by stress and by contact.
    pub plane_force: [ExactSum; 3],
    /// Torque about the origin of symmetry planes, rigid surfaces and gravity.
    pub outside_torque: [ExactSum; 3],
    pub pairs: PairBook,
    pub interpenetrated: i64,
    pub closest: Option<f64>,
    pub foreign_fraction: f64,
}

/// Sums of those pairs of bodies that have any, by [`pair_key`]. What is let go of is kept for
/// reuse.
#[derive(Debug, Clone, Default)]
pub(crate) struct PairBook {
    /// Keys in their order, and where their sums are.
    indices: Vec<(usize, usize)>,
    sums: Vec<PairSums>,
}

/// Sums of a pair of bodies.
#[derive(Debug, Clone, Default)]
pub(crate) struct PairSums {
    pub force: [ExactSum; 3],
    pub energy: ExactSum,
    pub heat: ExactSum,
    pub touching: i64,
    /// Of these particles in this step, not of all ranks.
    pub extremes: PairExtremes,
}

impl PairSums {
    fn merge(&mut self, other: &Self) {
        for (force, other) in self.force.iter_mut().zip(&other.force) {
            force.merge(other);
        }
        self.energy.merge(&other.energy);
        self.heat.merge(&other.heat);
        self.touching += other.touching;
        self.extremes.join(&other.extremes);
    }

    /// All exact sums; that of heat with friction or damping alone.
    fn exact(&mut self, friction: bool) -> impl Iterator<Item = &mut ExactSum> {
        let heat = friction.then_some(&mut self.heat);
        self.force.iter_mut().chain([&mut self.energy]).chain(heat)
    }

    pub(crate) fn gather(&mut self, friction: bool, limbs: &mut Vec<i64>) {
        gather_limbs(self.exact(friction), limbs);
        limbs.push(self.touching);
    }

    /// Takes what [`Self::gather`] wrote; returns what is left.
    pub(crate) fn scatter<'a>(&mut self, friction: bool, limbs: &'a [i64]) -> &'a [i64] {
        let rest = scatter_limbs(self.exact(friction), limbs);
        let (touching, rest) = rest.split_at(1);
        self.touching = touching[0];
        rest
    }
}

impl PairBook {
    pub fn clear(&mut self) {
        self.indices.clear();
    }

    /// The sums of a pair, of nothing where there were none.
    pub fn entry(&mut self, key: usize) -> &mut PairSums {
        let index = match self.indices.binary_search_by_key(&key, |entry| entry.0) {
            Ok(at) => self.indices[at].1,
            Err(at) => {
                let index = self.indices.len();
                match self.sums.get_mut(index) {
                    Some(sums) => *sums = PairSums::default(),
                    None => self.sums.push(PairSums::default()),
                }
                self.indices.insert(at, (key, index));
                index
            }
        };
        &mut self.sums[index]
    }

    /// The sums of a pair, if it has any.
    pub fn get(&self, key: usize) -> Option<&PairSums> {
        let found = self.indices.binary_search_by_key(&key, |entry| entry.0);
        found.ok().map(|at| &self.sums[self.indices[at].1])
    }

    /// All pairs in the order of their keys.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &PairSums)> {
        self.indices.iter().map(|&(key, at)| (key, &self.sums[at]))
    }

    fn memory(&self) -> usize {
        size_of::<(usize, usize)>() * self.indices.capacity()
            + size_of::<PairSums>() * self.sums.capacity()
    }
}

impl ContactSums {
    pub fn memory(&self) -> usize {
        self.pairs.memory()
    }

    pub fn clear(&mut self) {
        self.energy = ExactSum::default();
        self.plane_force = Default::default();
        self.outside_torque = Default::default();
        self.pairs.clear();
        self.interpenetrated = 0;
        self.closest = None;
        self.foreign_fraction = 0.0;
    }

    /// Adds what other particles add up.
    pub fn merge(&mut self, other: &Self) {
        self.energy.merge(&other.energy);
        let mine = self.plane_force.iter_mut().chain(&mut self.outside_torque);
        for (sum, other) in mine.zip(other.plane_force.iter().chain(&other.outside_torque)) {
            sum.merge(other);
        }
        for (key, sums) in other.pairs.iter() {
            self.pairs.entry(key).merge(sums);
        }
        self.interpenetrated += other.interpenetrated;
        self.closest = least(self.closest, other.closest);
        self.foreign_fraction = self.foreign_fraction.max(other.foreign_fraction);
    }

    /// Adds what images behind symmetry planes do to particles at `positions` (m), some for each task.
    pub fn add_plane_forces<'a, F: Iterator<Item = &'a MirrorForce>>(
        &mut self,
        forces: impl ParallelIterator<Item = F>,
        positions: &[[f64; 3]],
    ) {
        let of_task = |forces: F| {
            let mut sums = GatheredSums::<9>::default();
            // Where matter bears no stress yet there is nothing to add.
            let acts = |force: &&MirrorForce| [force.force, force.couple] != [[0.0; 3]; 2];
            for force in forces.filter(acts) {
                let [x, y, z] = force.force;
                let [a, b, c] = cross(&positions[force.particle], &force.force);
                let [u, v, w] = force.couple;
                sums.add(&[x, y, z, a, b, c, u, v, w]);
            }
            sums.into_sums()
        };
        let sums = forces
            .map(of_task)
            // same bits in any order: exact sums are integers
            .reduce(gathered_sums::none, gathered_sums::merged);
        let [x, y, z, torques @ ..] = &sums;
        for (sum, part) in self.plane_force.iter_mut().zip([x, y, z]) {
            sum.merge(part);
        }
        for (k, part) in torques.iter().enumerate() {
            self.outside_torque[k % 3].merge(part);
        }
    }

    /// Adds a force (N) of images behind symmetry planes on a particle at `position` (m).
    #[inline]
    pub fn add_plane_force(&mut self, force: &[f64; 3], position: &[f64; 3]) {
        // Most have none.
        if *force == [0.0; 3] {
            return;
        }
        for (sum, &force) in self.plane_force.iter_mut().zip(force) {
            sum.add(force);
        }
        self.add_outside_force(force, position);
    }

    /// Adds the torque of a force (N) from outside on a particle at `position` (m).
    #[inline]
    pub fn add_outside_force(&mut self, force: &[f64; 3], position: &[f64; 3]) {
        for (sum, torque) in self.outside_torque.iter_mut().zip(cross(position, force)) {
            sum.add(torque);
        }
    }

    #[inline]
    pub fn note_particle(&mut self, inside: bool, closest: f64, fraction: f64) {
        self.interpenetrated += i64::from(inside);
        if closest.is_finite() {
            self.closest = least(self.closest, Some(closest));
        }
        self.foreign_fraction = self.foreign_fraction.max(fraction);
    }

    /// Books what another body does to a particle with an excess and a contact step (s), if there
    /// is force, and the identities of the particle and the nearest one of that body.
    #[inline]
    pub fn note_pair(
        &mut self,
        bodies: usize,
        force: &BodyForce,
        [particle, nearest]: [u64; 2],
        excess: f64,
        dt: Option<f64>,
    ) {
        let [body, other] = force.bodies;
        let pair = self.pairs.entry(pair_key(bodies, body, other));
        if body <= other {
            for a in 0..3 {
                pair.force[a].add(force.force[a]);
            }
        }
        pair.energy.add(force.energy);
        if force.heat != 0.0 {
            pair.heat.add(force.heat);
        }
        // Joints book apart from what meets.
        pair.touching += i64::from(excess > 0.0 && force.closest.is_finite());
        let in_order = (body, particle) <= (other, nearest);
        pair.extremes.join(&PairExtremes {
            peak_force: 0.0,
            peak_along: 0.0,
            largest_excess: excess,
            closest: force.closest.is_finite().then_some(Closest {
                distance: force.closest,
                particles: if in_order {
                    [particle, nearest]
                } else {
                    [nearest, particle]
                },
            }),
            contact_dt: dt.filter(|dt| dt.is_finite()),
        });
    }
}

/// The smaller one of those there are.
pub(crate) fn least(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}
