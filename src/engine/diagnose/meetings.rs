//! Pairs of bodies that have met, and their sums on all ranks.

use crate::contact::{Closest, PairBook, PairExtremes};
use comm::Comm;

/// Pairs of bodies that have met since the process started, agreed by all ranks, and the extremes
/// of each on this rank since those of all were last joined.
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

    pub fn keys(&self) -> impl Iterator<Item = usize> {
        self.pairs.iter().map(|pair| pair.0)
    }

    /// Place of a pair, or that at which it would be.
    fn place(&self, key: usize) -> Result<usize, usize> {
        self.pairs.binary_search_by_key(&key, |pair| pair.0)
    }

    fn has(&self, key: usize) -> bool {
        self.place(key).is_ok()
    }

    /// Number of pairs that have met on this rank of which not all ranks know.
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
