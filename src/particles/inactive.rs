//! Parts of the store that take no part in steps.

use std::ops::Range;

use rayon::prelude::*;

use super::{GRAIN, ParticleStore};
use numerics::collector::Collector;

/// Particles of a part: those that follow each other in the store, where these fill it.
pub const PART: usize = 64;

/// The inactive parts of a store. Kept from step to step.
#[derive(Debug, Clone, Default)]
pub struct Inactive {
    /// By part; those beyond the last are active.
    parts: Vec<bool>,
    /// By part: the number of calls of [`Self::set`] up to the one that deactivated it last.
    since: Vec<u64>,
    times: u64,
    /// Number of inactive parts.
    count: usize,
    /// The active parts, ascending, with that which owned particles do not fill.
    active: Vec<u32>,
    collector: Collector,
}

/// Owned particles, of which the inactive ones are left out.
#[derive(Debug, Clone, Copy)]
pub struct Active<'a> {
    /// All particles.
    pub particles: &'a ParticleStore,
    /// Those to leave out.
    pub inactive: &'a Inactive,
}

/// As [`Active`], for those who write.
#[derive(Debug)]
pub struct ActiveMut<'a> {
    /// All particles.
    pub particles: &'a mut ParticleStore,
    /// Those to leave out.
    pub inactive: &'a Inactive,
}

impl Active<'_> {
    /// Number of owned particles that are active.
    #[must_use]
    pub fn count(&self) -> usize {
        self.inactive.count_active(self.particles.owned())
    }
}

impl Inactive {
    /// True if all parts are active.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// True if a part is inactive.
    #[inline(always)]
    #[must_use]
    pub fn has(&self, part: usize) -> bool {
        self.parts.get(part).copied().unwrap_or(false)
    }

    /// True if an owned particle is of an inactive part.
    #[inline(always)]
    #[must_use]
    pub fn holds(&self, particle: usize) -> bool {
        self.count > 0 && self.has(particle / PART)
    }

    /// A number that identifies the state of owned particles, from the first of a part on, as long as all of them are
    /// inactive.
    #[must_use]
    pub fn since(&self, places: &Range<usize>) -> Option<u64> {
        let parts = places.start / PART..places.end / PART;
        let is_whole = places.end.is_multiple_of(PART);
        let is_inactive =
            self.count > 0 && is_whole && self.parts.get(parts.clone())?.iter().all(|&is| is);
        let since = is_inactive.then(|| &self.since[parts])?;
        since.iter().max().copied()
    }

    /// The place in the store after the last part that may be inactive.
    #[must_use]
    pub fn end(&self) -> usize {
        PART * self.parts.len()
    }

    /// Number of active ones of so many owned particles.
    #[must_use]
    pub fn count_active(&self, owned: usize) -> usize {
        owned - PART * self.count
    }

    /// Two flags: inactive parts begin at a place in the store, and end at another one.
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

    /// The n-th active particle.
    #[inline(always)]
    #[must_use]
    pub fn nth_active(&self, n: usize) -> usize {
        if self.count == 0 {
            n
        } else {
            // Others may have come since, behind the last part.
            let k = (n / PART).min(self.active.len() - 1);
            PART * self.active[k] as usize + (n - PART * k)
        }
    }

    /// Calls `work` with those k of `0..count` whose particle `first + k` is active; `first` begins a part.
    #[inline(always)]
    pub fn each_active(&self, first: usize, count: usize, mut work: impl FnMut(usize)) {
        for begin in (0..count).step_by(PART) {
            if self.count == 0 || !self.has((first + begin) / PART) {
                for k in begin..count.min(begin + PART) {
                    work(k);
                }
            }
        }
    }

    /// Activates all parts.
    pub fn clear(&mut self) {
        self.parts.fill(false);
        self.count = 0;
    }

    /// Deactivates those of the parts that `owned` particles fill for which `is_inactive` holds, and activates all
    /// others. `is_inactive` is given the number of the part, and whether it is inactive now.
    pub fn set(&mut self, owned: usize, is_inactive: impl Fn(usize, bool) -> bool + Sync) {
        let whole = owned / PART;
        self.parts.resize(whole, false);
        self.since.resize(whole, 0);
        self.times += 1;
        let times = self.times;
        let parts = self.parts.par_iter_mut().zip(&mut self.since);
        let parts = parts.with_min_len(GRAIN).enumerate();
        parts.for_each(|(part, (inactive, since))| {
            let was_inactive = std::mem::replace(inactive, is_inactive(part, *inactive));
            if !was_inactive {
                *since = times;
            }
        });
        #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
        let number = |part: usize| part as u32;
        let parts = &self.parts;
        self.active.clear();
        self.collector
            .extend(&mut self.active, (whole, GRAIN), |part| {
                (!parts[part]).then_some(number(part))
            });
        self.count = whole - self.active.len();
        self.active.push(number(whole));
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.parts.capacity()
            + size_of::<u64>() * self.since.capacity()
            + 4 * self.active.capacity()
            + self.collector.memory()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn active_particles_are_all_but_those_of_inactive_parts() {
        let mut inactive = Inactive::default();
        let owned = 5 * PART + 7;
        let visited = |inactive: &Inactive| {
            let mut found = Vec::new();
            inactive.each_active(0, owned, |i| found.push(i));
            found
        };
        let all: Vec<usize> = (0..owned).collect();
        assert!(
            inactive.is_empty()
                && inactive.count_active(owned) == owned
                && inactive.nth_active(300) == 300
        );
        assert_eq!(visited(&inactive), all);
        inactive.set(owned, |part, _| part == 0 || part >= 3);
        // What does not fill a part is always active.
        let active: Vec<usize> = (PART..3 * PART).chain(5 * PART..owned).collect();
        assert_eq!(visited(&inactive), active);
        assert_eq!(inactive.count_active(owned), active.len());
        let listed: Vec<usize> = (0..active.len()).map(|n| inactive.nth_active(n)).collect();
        assert_eq!(listed, active);
        let more = owned + 2 * PART;
        let listed: Vec<usize> = (0..inactive.count_active(more))
            .map(|n| inactive.nth_active(n))
            .collect();
        assert_eq!(
            listed,
            [&active[..], &(owned..more).collect::<Vec<_>>()].concat()
        );
        let holds = |i: &usize| !inactive.holds(*i);
        assert_eq!(
            all.iter().copied().filter(holds).collect::<Vec<_>>(),
            active
        );
        let place = |part: usize| u32::try_from(PART * part).unwrap();
        assert!(inactive.is_gap(place(3), place(5)) && inactive.is_gap(place(0), place(1)));
        assert!(!inactive.is_gap(place(1), place(3)) && !inactive.is_gap(place(3), place(5) + 1));
        inactive.clear();
        assert_eq!(visited(&inactive), all);
    }
}
