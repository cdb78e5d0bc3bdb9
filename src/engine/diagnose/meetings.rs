//! Pairs of bodies that have met, and their sums on all ranks.

use crate::contact::{Closest, PairBook, PairExtremes};
use comm::Comm;

/// Steps after which ranks no longer join the sums of a pair that has been near nowhere.
const PATIENCE: u32 = 100;

/// Pairs of bodies that have met since the process started, agreed by all ranks.
#[derive(Debug, Default)]
pub(super) struct Meetings {
    /// In the order of their keys.
    pairs: Vec<Met>,
    words: Vec<u64>,
}

/// A pair of bodies that has met.
#[derive(Debug, Clone, Copy)]
struct Met {
    /// [`pair_key`] of it.
    key: usize,
    /// On this rank since those of all were last joined.
    extremes: PairExtremes,
    /// Steps since it was near anywhere, the same on all ranks.
    apart: u32,
}

impl Met {
    /// True if ranks join its sums.
    fn is_joined(&self) -> bool {
        self.apart < PATIENCE
    }
}

impl Meetings {
    pub fn memory(&self) -> usize {
        size_of::<Met>() * self.pairs.capacity() + 8 * self.words.capacity()
    }

    pub fn keys(&self) -> impl Iterator<Item = usize> {
        self.pairs.iter().map(|pair| pair.key)
    }

    /// Place of a pair, or that at which it would be.
    fn place(&self, key: usize) -> Result<usize, usize> {
        self.pairs.binary_search_by_key(&key, |pair| pair.key)
    }

    /// True if all ranks join the sums of a pair.
    fn joins(&self, key: usize) -> bool {
        self.place(key).is_ok_and(|at| self.pairs[at].is_joined())
    }

    /// Number of pairs that are near on this rank whose sums ranks do not join.
    pub fn news(&self, book: &PairBook) -> usize {
        book.iter().filter(|&(key, _)| !self.joins(key)).count()
    }

    /// Adds the sums of the pairs that ranks join, and whether each is near here, to what they join.
    pub fn gather(&self, book: &mut PairBook, friction: bool, limbs: &mut Vec<i64>) {
        for pair in self.pairs.iter().filter(|pair| pair.is_joined()) {
            limbs.push(book.get(pair.key).is_some().into());
            book.entry(pair.key).gather(friction, limbs);
        }
    }

    /// Takes what the ranks have joined of pairs.
    pub fn scatter(&mut self, book: &mut PairBook, friction: bool, mut limbs: &[i64]) {
        for pair in self.pairs.iter_mut().filter(|pair| pair.is_joined()) {
            let (near, rest) = limbs.split_at(1);
            limbs = book.entry(pair.key).scatter(friction, rest);
            pair.apart = if near[0] > 0 { 0 } else { pair.apart + 1 };
        }
    }

    /// Lets all ranks know the pairs that are near in this step on any of them and whose sums are not joined, and joins those.
    /// Collective.
    pub fn admit(&mut self, comm: &Comm, book: &mut PairBook, friction: bool) {
        let new = book
            .iter()
            .map(|(key, _)| key)
            .filter(|&key| !self.joins(key));
        let mut new: Vec<u64> = new.map(|key| key as u64).collect();
        let mut most = [new.len() as u64];
        comm.max_u64(&mut most);
        new.resize(usize::try_from(most[0]).unwrap_or(0), u64::MAX);
        let mut all = Vec::new();
        comm.all_gather_u64(&new, &mut all);
        all.retain(|&key| key != u64::MAX);
        all.sort_unstable();
        all.dedup();
        let met = |&key: &u64| Met {
            key: usize::try_from(key).unwrap_or(0),
            extremes: PairExtremes::default(),
            apart: 0,
        };
        let mut new = Self {
            pairs: all.iter().map(met).collect(),
            ..Self::default()
        };
        let mut limbs = Vec::new();
        new.gather(book, friction, &mut limbs);
        comm.sum_i64(&mut limbs);
        new.scatter(book, friction, &limbs);
        for pair in new.pairs {
            match self.place(pair.key) {
                Ok(at) => self.pairs[at].apart = 0,
                Err(at) => self.pairs.insert(at, pair),
            }
        }
    }

    /// Keeps the extremes of a step. Not all that have met need be near each other now.
    pub fn note(&mut self, book: &PairBook) {
        for (key, sums) in book.iter() {
            if let Ok(at) = self.place(key) {
                self.pairs[at].extremes.join(&sums.extremes);
            }
        }
    }

    /// The extremes of all ranks since they were last joined, by key. Collective.
    pub fn join(&mut self, comm: &Comm) -> impl Iterator<Item = (usize, PairExtremes)> {
        let mut words = std::mem::take(&mut self.words);
        let bits = |value: Option<f64>| value.map_or(u64::MAX, f64::to_bits);
        let value = |bits: u64| (bits != u64::MAX).then(|| f64::from_bits(bits));
        words.clear();
        for Met { extremes: pair, .. } in &self.pairs {
            words.extend([
                bits(pair.closest.map(|closest| closest.distance)),
                bits(pair.contact_dt),
                !pair.largest_excess.to_bits(),
            ]);
        }
        comm.min_u64(&mut words);
        for (pair, words) in self.pairs.iter_mut().zip(words.chunks_exact(3)) {
            let pair = &mut pair.extremes;
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
            let pairs = self.pairs.iter().map(|pair| pair.extremes.closest);
            words.extend(pairs.map(|closest| closest.map_or(u64::MAX, |c| c.particles[k])));
            comm.min_u64(&mut words);
            for (pair, &id) in self.pairs.iter_mut().zip(&words) {
                if let Some(closest) = &mut pair.extremes.closest {
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
            .map(|pair| (pair.key, std::mem::take(&mut pair.extremes)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use comm::{Machine, virtual_ranks};

    /// Pairs that are near for a time, on other ranks each, are all that ranks join.
    #[test]
    fn what_has_flown_apart_is_joined_no_more() {
        virtual_ranks(3, Machine::IDEAL, |comm| {
            let mut meetings = Meetings::default();
            let mut lengths = Vec::new();
            for step in 0..400 {
                let mut book = PairBook::default();
                let mut note = |key: usize, until: u64, rank: usize| {
                    if step < until && comm.rank() == rank {
                        book.entry(key).touching = 3;
                    }
                };
                note(4, 400, 0);
                note(7, 100, 1);
                note(7, 100, 2);
                note(9, 20, 1);
                if step == 300 && comm.rank() == 2 {
                    book.entry(9).touching = 5;
                }
                let mut limbs = vec![i64::try_from(meetings.news(&book)).unwrap()];
                meetings.gather(&mut book, false, &mut limbs);
                lengths.push(limbs.len());
                comm.sum_i64(&mut limbs);
                meetings.scatter(&mut book, false, &limbs[1..]);
                if limbs[0] > 0 {
                    meetings.admit(comm, &mut book, false);
                }
                let touching = [4, 7, 9].map(|key| book.get(key).map_or(0, |sums| sums.touching));
                let of_last = [(20, 3), (300, 5)].map(|(at, n)| {
                    let is_near = if at == 20 { step < at } else { step == at };
                    i64::from(is_near) * n
                });
                let expected = [3, if step < 100 { 6 } else { 0 }, of_last.iter().sum()];
                assert_eq!(touching, expected, "{step}");
                meetings.note(&book);
            }
            let pair = (lengths[1] - 1) / 3;
            let expected = |step: u64| match step {
                0 => 0,
                1..120 => 3,
                120..200 | 301..400 => 2,
                200..301 => 1,
                _ => unreachable!(),
            };
            for (step, length) in (0..).zip(lengths) {
                assert_eq!(length, 1 + expected(step) * pair, "{step}");
            }
            assert_eq!(meetings.keys().collect::<Vec<_>>(), [4, 7, 9]);
        });
    }
}
