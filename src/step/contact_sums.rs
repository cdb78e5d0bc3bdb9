//! What contact adds up: exact sums, counts and extremes, of each pair of bodies and of all.

use crate::contact::BodyReaction;
use crate::diagnose::exact_sum::ExactSum;

/// Sums of contact over some particles.
#[derive(Debug, Clone)]
pub(super) struct ContactSums {
    /// Whether there is friction or damping, whose heat is summed.
    friction: bool,
    pub energy: ExactSum,
    /// Force of symmetry planes, by stress and by contact.
    pub plane_force: [ExactSum; 3],
    pair_bodies: Vec<[usize; 2]>,
    pub pairs: Vec<PairSums>,
    pub interpenetrated: i64,
    pub closest: f64,
    pub foreign_fraction: f64,
}

/// Sums of a pair of bodies.
#[derive(Debug, Clone)]
pub(super) struct PairSums {
    pub force: [ExactSum; 3],
    pub energy: ExactSum,
    pub heat: ExactSum,
    pub touching: i64,
    pub largest_excess: f64,
    pub closest: f64,
    pub contact_dt: f64,
}

impl Default for PairSums {
    fn default() -> Self {
        Self {
            force: Default::default(),
            energy: ExactSum::default(),
            heat: ExactSum::default(),
            touching: 0,
            largest_excess: 0.0,
            closest: f64::INFINITY,
            contact_dt: f64::INFINITY,
        }
    }
}

impl PairSums {
    fn merge(&mut self, other: &Self) {
        for (force, other) in self.force.iter_mut().zip(&other.force) {
            force.merge(other);
        }
        self.energy.merge(&other.energy);
        self.heat.merge(&other.heat);
        self.touching += other.touching;
        self.largest_excess = self.largest_excess.max(other.largest_excess);
        self.closest = self.closest.min(other.closest);
        self.contact_dt = self.contact_dt.min(other.contact_dt);
    }
}

impl ContactSums {
    pub fn new(pair_bodies: Vec<[usize; 2]>, friction: bool) -> Self {
        Self {
            friction,
            energy: ExactSum::default(),
            plane_force: Default::default(),
            pairs: vec![PairSums::default(); pair_bodies.len()],
            pair_bodies,
            interpenetrated: 0,
            closest: f64::INFINITY,
            foreign_fraction: 0.0,
        }
    }

    pub fn memory(&self) -> usize {
        size_of::<PairSums>() * self.pairs.capacity()
            + size_of::<[usize; 2]>() * self.pair_bodies.capacity()
    }

    pub fn clear(&mut self) {
        self.energy = ExactSum::default();
        self.plane_force = Default::default();
        self.pairs.fill_with(PairSums::default);
        self.interpenetrated = 0;
        self.closest = f64::INFINITY;
        self.foreign_fraction = 0.0;
    }

    /// Adds what other particles add up.
    pub fn merge(&mut self, other: &Self) {
        self.energy.merge(&other.energy);
        for (force, other) in self.plane_force.iter_mut().zip(&other.plane_force) {
            force.merge(other);
        }
        for (pair, other) in self.pairs.iter_mut().zip(&other.pairs) {
            pair.merge(other);
        }
        self.interpenetrated += other.interpenetrated;
        self.closest = self.closest.min(other.closest);
        self.foreign_fraction = self.foreign_fraction.max(other.foreign_fraction);
    }

    #[inline]
    pub fn add_plane_force(&mut self, force: &[f64; 3]) {
        for (sum, &force) in self.plane_force.iter_mut().zip(force) {
            // Most have none.
            if force != 0.0 {
                sum.add(force);
            }
        }
    }

    #[inline]
    pub fn note_particle(&mut self, inside: bool, closest: f64, fraction: f64) {
        self.interpenetrated += i64::from(inside);
        self.closest = self.closest.min(closest);
        self.foreign_fraction = self.foreign_fraction.max(fraction);
    }

    /// Books what a body does to a particle of `body` with excess `excess` and contact step `dt`.
    #[inline]
    pub fn note_pair(&mut self, body: usize, reaction: &BodyReaction, excess: f64, dt: f64) {
        let bodies = [body.min(reaction.body), body.max(reaction.body)];
        let Some(index) = self.pair_bodies.iter().position(|&pair| pair == bodies) else {
            return;
        };
        let pair = &mut self.pairs[index];
        if body == bodies[0] {
            for a in 0..3 {
                pair.force[a].add(reaction.force[a]);
            }
        }
        pair.energy.add(reaction.energy);
        if self.friction {
            pair.heat.add(reaction.heat);
        }
        pair.touching += i64::from(excess > 0.0);
        pair.largest_excess = pair.largest_excess.max(excess);
        pair.closest = pair.closest.min(reaction.closest);
        pair.contact_dt = pair.contact_dt.min(dt);
    }

    /// All exact sums that the case has use for.
    pub fn exact(&mut self) -> impl Iterator<Item = &mut ExactSum> {
        let friction = self.friction;
        let pairs = self.pairs.iter_mut().flat_map(move |pair| {
            let heat = friction.then_some(&mut pair.heat);
            pair.force.iter_mut().chain([&mut pair.energy]).chain(heat)
        });
        [&mut self.energy]
            .into_iter()
            .chain(&mut self.plane_force)
            .chain(pairs)
    }

    /// All counts.
    pub fn counts(&mut self) -> impl Iterator<Item = &mut i64> {
        let pairs = self.pairs.iter_mut().map(|pair| &mut pair.touching);
        [&mut self.interpenetrated].into_iter().chain(pairs)
    }

    /// Words whose smallest over the ranks are all ranks' extremes: positive doubles order as their
    /// bits do, and a largest value is the smallest complement.
    pub fn write_extremes(&self, bits: &mut Vec<u64>) {
        bits.clear();
        bits.extend([self.closest.to_bits(), !self.foreign_fraction.to_bits()]);
        for pair in &self.pairs {
            bits.extend([
                pair.closest.to_bits(),
                pair.contact_dt.to_bits(),
                !pair.largest_excess.to_bits(),
            ]);
        }
    }

    /// Takes the words of [`Self::write_extremes`].
    pub fn read_extremes(&mut self, bits: &[u64]) {
        self.closest = f64::from_bits(bits[0]);
        self.foreign_fraction = f64::from_bits(!bits[1]);
        for (pair, bits) in self.pairs.iter_mut().zip(bits[2..].chunks_exact(3)) {
            pair.closest = f64::from_bits(bits[0]);
            pair.contact_dt = f64::from_bits(bits[1]);
            pair.largest_excess = f64::from_bits(!bits[2]);
        }
    }
}
