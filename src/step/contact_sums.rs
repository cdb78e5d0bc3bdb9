//! What contact adds up: exact sums, counts and extremes, of pairs of bodies and of all.

use super::state::{Closest, PairExtremes};
use super::sums::{gather_limbs, scatter_limbs};
use crate::comm::Comm;
use crate::contact::BodyReaction;
use crate::numerics::exact_sum::ExactSum;

/// Number of an unordered pair of bodies among all of `bodies`: these order as `[a, b]`, `a ≤ b`, do.
pub(super) fn pair_key(bodies: usize, a: usize, b: usize) -> usize {
    a.min(b) * bodies + a.max(b)
}

/// Sums of contact over some particles.
#[derive(Debug, Clone, Default)]
pub(super) struct ContactSums {
    pub energy: ExactSum,
    /// Force of symmetry planes, by stress and by contact.
    pub plane_force: [ExactSum; 3],
    pub pairs: PairBook,
    pub interpenetrated: i64,
    pub closest: Option<f64>,
    pub foreign_fraction: f64,
}

/// Sums of those pairs of bodies that have any, by [`pair_key`]. What is let go of is kept for reuse.
#[derive(Debug, Clone, Default)]
pub(super) struct PairBook {
    /// Keys in their order, and where their sums are.
    places: Vec<(usize, usize)>,
    sums: Vec<PairSums>,
}

/// Sums of a pair of bodies.
#[derive(Debug, Clone, Default)]
pub(super) struct PairSums {
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

    fn gather(&mut self, friction: bool, limbs: &mut Vec<i64>) {
        gather_limbs(self.exact(friction), limbs);
        limbs.push(self.touching);
    }

    /// Takes what [`Self::gather`] wrote; returns what is left.
    fn scatter<'a>(&mut self, friction: bool, limbs: &'a [i64]) -> &'a [i64] {
        let rest = scatter_limbs(self.exact(friction), limbs);
        let (touching, rest) = rest.split_at(1);
        self.touching = touching[0];
        rest
    }
}

impl PairBook {
    pub fn clear(&mut self) {
        self.places.clear();
    }

    /// The sums of a pair, of nothing where there were none.
    pub fn entry(&mut self, key: usize) -> &mut PairSums {
        let place = match self.places.binary_search_by_key(&key, |entry| entry.0) {
            Ok(at) => self.places[at].1,
            Err(at) => {
                let place = self.places.len();
                match self.sums.get_mut(place) {
                    Some(sums) => *sums = PairSums::default(),
                    None => self.sums.push(PairSums::default()),
                }
                self.places.insert(at, (key, place));
                place
            }
        };
        &mut self.sums[place]
    }

    /// The sums of a pair, if it has any.
    pub fn get(&self, key: usize) -> Option<&PairSums> {
        let found = self.places.binary_search_by_key(&key, |entry| entry.0);
        found.ok().map(|at| &self.sums[self.places[at].1])
    }

    /// All pairs in the order of their keys.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &PairSums)> {
        self.places.iter().map(|&(key, at)| (key, &self.sums[at]))
    }

    fn memory(&self) -> usize {
        size_of::<(usize, usize)>() * self.places.capacity()
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
        self.pairs.clear();
        self.interpenetrated = 0;
        self.closest = None;
        self.foreign_fraction = 0.0;
    }

    /// Adds what other particles add up.
    pub fn merge(&mut self, other: &Self) {
        self.energy.merge(&other.energy);
        for (force, other) in self.plane_force.iter_mut().zip(&other.plane_force) {
            force.merge(other);
        }
        for (key, sums) in other.pairs.iter() {
            self.pairs.entry(key).merge(sums);
        }
        self.interpenetrated += other.interpenetrated;
        self.closest = least(self.closest, other.closest);
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
        if closest.is_finite() {
            self.closest = least(self.closest, Some(closest));
        }
        self.foreign_fraction = self.foreign_fraction.max(fraction);
    }

    /// Books what another body does to a particle.
    #[inline]
    pub fn note_pair(&mut self, bodies: usize, met: &Met, reaction: &BodyReaction) {
        let pair = self.pairs.entry(pair_key(bodies, met.body, reaction.body));
        if met.body <= reaction.body {
            for a in 0..3 {
                pair.force[a].add(reaction.force[a]);
            }
        }
        pair.energy.add(reaction.energy);
        if reaction.heat != 0.0 {
            pair.heat.add(reaction.heat);
        }
        pair.touching += i64::from(met.excess > 0.0);
        let [a, b] = met.particles;
        let in_order = if met.body == reaction.body {
            a <= b
        } else {
            met.body < reaction.body
        };
        pair.extremes.join(&PairExtremes {
            peak_force: 0.0,
            largest_excess: met.excess,
            closest: reaction.closest.is_finite().then_some(Closest {
                distance: reaction.closest,
                particles: if in_order { [a, b] } else { [b, a] },
            }),
            contact_dt: met.dt.is_finite().then_some(met.dt),
        });
    }
}

/// A particle that meets another body.
pub(super) struct Met {
    pub body: usize,
    /// Its excess.
    pub excess: f64,
    /// Its contact step (s), infinite without force.
    pub dt: f64,
    /// Its identity, and that of the nearest particle of the other body.
    pub particles: [u64; 2],
}

/// The smaller one of those there are.
pub(super) fn least(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}

/// Which pairs of bodies have met since the process started, agreed by all ranks, and what each has
/// come to on this rank since the extremes of all were last joined.
#[derive(Debug, Default)]
pub(super) struct Meetings {
    /// By [`pair_key`], in that order.
    pairs: Vec<(usize, PairExtremes)>,
    words: Vec<u64>,
}

impl Meetings {
    pub fn memory(&self) -> usize {
        size_of::<(usize, PairExtremes)>() * self.pairs.capacity() + 8 * self.words.capacity()
    }

    fn keys(&self) -> impl Iterator<Item = usize> {
        self.pairs.iter().map(|pair| pair.0)
    }

    /// Where a pair stands, or would.
    fn place(&self, key: usize) -> Result<usize, usize> {
        self.pairs.binary_search_by_key(&key, |pair| pair.0)
    }

    fn has(&self, key: usize) -> bool {
        self.place(key).is_ok()
    }

    /// How many pairs have met on this rank of which not all ranks know.
    pub fn news(&self, book: &PairBook) -> usize {
        book.iter().filter(|&(key, _)| !self.has(key)).count()
    }

    /// Adds the sums of all pairs that all ranks know to what ranks join.
    pub fn gather(&self, book: &mut PairBook, friction: bool, limbs: &mut Vec<i64>) {
        self.keys()
            .for_each(|key| book.entry(key).gather(friction, limbs));
    }

    /// Takes what the ranks have joined; returns what is left of `limbs`.
    pub fn scatter<'a>(&self, book: &mut PairBook, friction: bool, limbs: &'a [i64]) -> &'a [i64] {
        self.keys()
            .fold(limbs, |rest, key| book.entry(key).scatter(friction, rest))
    }

    /// Lets all ranks know the pairs that met in this step on any of them, and joins their sums.
    /// Collective.
    pub fn admit(&mut self, comm: &Comm, book: &mut PairBook, friction: bool) {
        let new = book
            .iter()
            .map(|(key, _)| key)
            .filter(|&key| !self.has(key));
        let mut new: Vec<u64> = new.map(|key| key as u64).collect();
        let mut most = [new.len() as u64];
        comm.max_u64(&mut most);
        new.resize(usize::try_from(most[0]).unwrap_or(0), u64::MAX);
        let mut all = Vec::new();
        comm.all_gather_u64(&new, &mut all);
        all.retain(|&key| key != u64::MAX);
        all.sort_unstable();
        all.dedup();
        let met = |&key: &u64| (usize::try_from(key).unwrap_or(0), PairExtremes::default());
        let mut new = Self {
            pairs: all.iter().map(met).collect(),
            ..Self::default()
        };
        let mut limbs = Vec::new();
        new.gather(book, friction, &mut limbs);
        comm.sum_i64(&mut limbs);
        new.scatter(book, friction, &limbs);
        self.pairs.append(&mut new.pairs);
        self.pairs.sort_unstable_by_key(|pair| pair.0);
    }

    /// Keeps the extremes of a step. Not all that have met need be near each other now.
    pub fn note(&mut self, book: &PairBook) {
        for (key, sums) in book.iter() {
            if let Ok(at) = self.place(key) {
                self.pairs[at].1.join(&sums.extremes);
            }
        }
    }

    /// The extremes of all ranks since they were last joined, by key. Collective.
    pub fn join(&mut self, comm: &Comm) -> impl Iterator<Item = (usize, PairExtremes)> {
        let mut words = std::mem::take(&mut self.words);
        let bits = |value: Option<f64>| value.map_or(u64::MAX, f64::to_bits);
        let value = |bits: u64| (bits != u64::MAX).then(|| f64::from_bits(bits));
        words.clear();
        for (_, pair) in &self.pairs {
            words.extend([
                bits(pair.closest.map(|closest| closest.distance)),
                bits(pair.contact_dt),
                !pair.largest_excess.to_bits(),
            ]);
        }
        comm.min_u64(&mut words);
        for ((_, pair), words) in self.pairs.iter_mut().zip(words.chunks_exact(3)) {
            let distance = value(words[0]);
            pair.closest = (pair.closest).filter(|own| Some(own.distance) == distance);
            (pair.contact_dt, pair.largest_excess) = (value(words[1]), f64::from_bits(!words[2]));
            // Whoever has no such pair takes one that is larger than any.
            let unknown = distance.map(|distance| Closest {
                distance,
                particles: [u64::MAX; 2],
            });
            pair.closest = pair.closest.or(unknown);
        }
        // The smallest identity in the first body, then in the second among its partners.
        for k in 0..2 {
            words.clear();
            let pairs = self.pairs.iter().map(|(_, pair)| pair.closest);
            words.extend(pairs.map(|closest| closest.map_or(u64::MAX, |c| c.particles[k])));
            comm.min_u64(&mut words);
            for ((_, pair), &id) in self.pairs.iter_mut().zip(&words) {
                if let Some(closest) = &mut pair.closest {
                    if k == 0 && closest.particles[0] != id {
                        closest.particles[1] = u64::MAX;
                    }
                    closest.particles[k] = id;
                }
            }
        }
        self.words = words;
        self.pairs
            .iter_mut()
            .map(|(key, pair)| (*key, std::mem::take(pair)))
    }
}
