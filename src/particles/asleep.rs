//! Parts of the store that take no part in steps.

use std::ops::Range;

use rayon::prelude::*;

use super::GRAIN;
use numerics::collector::Collector;

/// Particles of a part: those that follow each other in the store, where these fill it.
pub const PART: usize = 64;

/// Which parts of a store sleep. Kept from step to step.
#[derive(Debug, Clone, Default)]
pub struct Asleep {
    /// By part; those beyond the last are awake.
    parts: Vec<bool>,
    /// By part: how often parts had been told to sleep when it fell asleep last.
    since: Vec<u64>,
    times: u64,
    /// How many sleep.
    count: usize,
    /// The parts that are awake, ascending, with that which owned particles do not fill.
    awake: Vec<u32>,
    collector: Collector,
}

impl Asleep {
    /// Whether none does.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Whether a part does.
    #[inline(always)]
    #[must_use]
    pub fn has(&self, part: usize) -> bool {
        self.parts.get(part).copied().unwrap_or(false)
    }

    /// Whether an owned particle is of a part that does.
    #[inline(always)]
    #[must_use]
    pub fn holds(&self, particle: usize) -> bool {
        self.count > 0 && self.has(particle / PART)
    }

    /// A number that stands for what owned particles, from the first of a part on, are as long as all of them sleep.
    #[must_use]
    pub fn since(&self, places: &Range<usize>) -> Option<u64> {
        let parts = places.start / PART..places.end / PART;
        let is_whole = places.end.is_multiple_of(PART);
        let asleep =
            self.count > 0 && is_whole && self.parts.get(parts.clone())?.iter().all(|&is| is);
        let since = asleep.then(|| &self.since[parts])?;
        since.iter().max().copied()
    }

    /// The place in the store after the last part that may sleep.
    #[must_use]
    pub fn end(&self) -> usize {
        PART * self.parts.len()
    }

    /// How many of so many owned particles are awake.
    #[must_use]
    pub fn awake(&self, owned: usize) -> usize {
        owned - PART * self.count
    }

    /// Whether parts sleep that begin at a place in the store, and that end at another one.
    #[must_use]
    pub fn is_gap(&self, from: u32, to: u32) -> bool {
        let part = |place: u32| {
            (place as usize)
                .is_multiple_of(PART)
                .then_some(place as usize / PART)
        };
        self.count > 0
            && match (part(from), part(to)) {
                (Some(first), Some(end)) => self.has(first) && self.has(end - 1),
                _ => false,
            }
    }

    /// The n-th owned particle that is awake.
    #[inline(always)]
    #[must_use]
    pub fn nth(&self, n: usize) -> usize {
        if self.count == 0 {
            n
        } else {
            // Others may have come since, behind the last part.
            let k = (n / PART).min(self.awake.len() - 1);
            PART * self.awake[k] as usize + (n - PART * k)
        }
    }

    /// Calls `work` with `0..count` but for those k whose particle `first + k` sleeps; `first` begins a part.
    #[inline(always)]
    pub fn each_awake(&self, first: usize, count: usize, mut work: impl FnMut(usize)) {
        for begin in (0..count).step_by(PART) {
            if self.count == 0 || !self.has((first + begin) / PART) {
                for k in begin..count.min(begin + PART) {
                    work(k);
                }
            }
        }
    }

    /// Wakes all.
    pub fn clear(&mut self) {
        self.parts.fill(false);
        self.count = 0;
    }

    /// Has those of the parts sleep that so many owned particles fill and `sleeps` takes, which is told whether a part
    /// sleeps now.
    pub fn set(&mut self, owned: usize, sleeps: impl Fn(usize, bool) -> bool + Sync) {
        let whole = owned / PART;
        self.parts.resize(whole, false);
        self.since.resize(whole, 0);
        self.times += 1;
        let times = self.times;
        let parts = self.parts.par_iter_mut().zip(&mut self.since);
        let parts = parts.with_min_len(GRAIN).enumerate();
        parts.for_each(|(part, (asleep, since))| {
            let was_asleep = std::mem::replace(asleep, sleeps(part, *asleep));
            if !was_asleep {
                *since = times;
            }
        });
        #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
        let number = |part: usize| part as u32;
        let parts = &self.parts;
        self.awake.clear();
        self.collector
            .extend(&mut self.awake, (whole, GRAIN), |part| {
                (!parts[part]).then_some(number(part))
            });
        self.count = whole - self.awake.len();
        self.awake.push(number(whole));
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.parts.capacity()
            + size_of::<u64>() * self.since.capacity()
            + 4 * self.awake.capacity()
            + self.collector.memory()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_awake_is_all_but_the_parts_that_sleep() {
        let mut asleep = Asleep::default();
        let owned = 5 * PART + 7;
        let visited = |asleep: &Asleep| {
            let mut found = Vec::new();
            asleep.each_awake(0, owned, |i| found.push(i));
            found
        };
        let all: Vec<usize> = (0..owned).collect();
        assert!(asleep.is_empty() && asleep.awake(owned) == owned && asleep.nth(300) == 300);
        assert_eq!(visited(&asleep), all);
        asleep.set(owned, |part, _| part == 0 || part >= 3);
        // What does not fill a part never sleeps.
        let awake: Vec<usize> = (PART..3 * PART).chain(5 * PART..owned).collect();
        assert_eq!(visited(&asleep), awake);
        assert_eq!(asleep.awake(owned), awake.len());
        let listed: Vec<usize> = (0..awake.len()).map(|n| asleep.nth(n)).collect();
        assert_eq!(listed, awake);
        let more = owned + 2 * PART;
        let listed: Vec<usize> = (0..asleep.awake(more)).map(|n| asleep.nth(n)).collect();
        assert_eq!(
            listed,
            [&awake[..], &(owned..more).collect::<Vec<_>>()].concat()
        );
        let holds = |i: &usize| !asleep.holds(*i);
        assert_eq!(all.iter().copied().filter(holds).collect::<Vec<_>>(), awake);
        let place = |part: usize| u32::try_from(PART * part).unwrap();
        assert!(asleep.is_gap(place(3), place(5)) && asleep.is_gap(place(0), place(1)));
        assert!(!asleep.is_gap(place(1), place(3)) && !asleep.is_gap(place(3), place(5) + 1));
        asleep.clear();
        assert_eq!(visited(&asleep), all);
    }
}
