//! Labels of what hangs together, over all ranks.

use rayon::prelude::*;

use super::merger::{Merger, Row};
use crate::domain::Halo;
use comm::Comm;
use numerics::collector::Collector;
use particles::connected::{SHARE, Set, Sets};

/// Mark of sets that another rank may have joined with some of its own.
pub(super) const TOUCHES: u32 = 1 << 31;

/// Connected component of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Member {
    /// Smallest id of it all.
    pub label: u64,
    /// Marks of it all: the symmetry planes that it reaches across.
    pub planes: u32,
    /// Its particles on all ranks.
    pub count: u64,
    /// True if other ranks have some of it.
    pub crosses: bool,
}

/// Connected components of particles: labels are the smallest id of all that hangs together. Kept
/// from one search to the next.
///
/// A search is [`Self::begin`], links between this rank's particles, halo particles and their images
/// ([`Self::sets`]), [`Self::finish`].
#[derive(Default)]
pub struct Labels {
    members: Members,
    pub(super) merger: Merger,
    /// Labels of particles on their own rank.
    sent: Vec<u64>,
    collector: Collector,
}

/// Connected components of all particles.
#[derive(Debug, Default)]
pub struct Members {
    /// Particles of this rank, then halo particles.
    sets: Sets,
    /// Sets that have particles of this rank and of others: root, whole count.
    crossing: Vec<(u32, u64)>,
}

impl Labels {
    /// Bytes for each particle, halo particles included.
    pub const BYTES: usize = Sets::BYTES + size_of::<u64>();

    /// Begins with `n` particles, halo particles included, each by itself.
    pub fn begin(&mut self, n: usize) {
        self.members.sets.reset(n);
    }

    /// Sets that links join: particles of this rank, then halo particles.
    #[must_use]
    pub fn sets(&self) -> &Sets {
        &self.members.sets
    }

    /// Connected components, after [`Self::finish`].
    #[must_use]
    pub fn members(&self) -> &Members {
        &self.members
    }

    /// Labels what the links have joined, given the `ids` of this rank's particles and of halo
    /// particles after them. Without a halo there is one rank. Collective.
    pub fn finish(&mut self, comm: &Comm, halo: Option<&mut Halo>, ids: &[u64], owned: usize) {
        let Members { sets, crossing } = &mut self.members;
        sets.finish(ids, owned);
        crossing.clear();
        let Some(halo) = halo.filter(|_| comm.size() > 1) else {
            return;
        };
        let place = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
        let known = &*sets;
        self.sent.resize(ids.len(), 0);
        let labels = self.sent.par_iter_mut().enumerate().with_min_len(SHARE);
        labels.for_each(|(i, label)| *label = known.set(place(i)).label);
        halo.exchange_values(comm, &mut self.sent);
        let (sent, collector) = (&self.sent, &mut self.collector);
        // A root is the smallest of its set: halo particles that nothing here is linked with are by
        // themselves.
        let linked = |i: usize| Some(known.set(place(owned + i))).filter(|set| set.count > 0);
        let halo = (ids.len() - owned, SHARE);
        let rows = &mut self.merger.rows;
        rows.clear();
        collector.extend(rows, halo, |i| {
            linked(i).map(|set| Row {
                label: set.label,
                other: sent[owned + i],
                marks: 0,
                count: 0,
            })
        });
        rows.par_sort_unstable();
        rows.dedup();
        let crosses = |set: Set| (set.root, 0);
        collector.extend(crossing, halo, |i| linked(i).map(crosses));
        collector.extend(crossing, (owned, SHARE), |i| {
            let set = Some(known.set(place(i)));
            let touches = |set: &Set| set.root == place(i) && set.marks & TOUCHES != 0;
            set.filter(touches).map(crosses)
        });
        crossing.par_sort_unstable();
        crossing.dedup();
        rows.extend(crossing.iter().map(|&(root, _)| {
            let set = known.set(root);
            Row {
                label: set.label,
                other: set.label,
                marks: (set.marks & !TOUCHES).into(),
                count: set.count.into(),
            }
        }));
        self.merger.merge(comm);
        for (root, count) in crossing {
            let set = sets.set(*root);
            if let Some(row) = self.merger.of(set.label) {
                *count = row.count;
                let marks = u32::try_from(row.marks).unwrap_or(u32::MAX);
                sets.rename(*root, row.other, marks);
            }
        }
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.members.sets.memory()
            + self.merger.memory()
            + 8 * self.sent.capacity()
            + self.collector.memory()
            + size_of::<(u32, u64)>() * self.members.crossing.capacity()
    }
}

impl Members {
    /// Connected component of a particle of this rank.
    #[must_use]
    pub fn of(&self, i: usize) -> Member {
        let set = self.sets.set(u32::try_from(i).unwrap_or(u32::MAX));
        let crossing = (self.crossing).binary_search_by_key(&set.root, |(root, _)| *root);
        Member {
            label: set.label,
            planes: set.marks & !TOUCHES,
            count: crossing.map_or(set.count.into(), |at| self.crossing[at].1),
            crosses: crossing.is_ok(),
        }
    }
}
