//! Number of particles that ranks would receive of each other in some slabs, counted from particles
//! on any ranks.

use std::cell::RefCell;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use super::least::Least;
use super::near::MARGIN;
use super::needs::Extent;
use super::nested::{Decomposition, NestedSlabs};
use comm::Comm;
use populate::Brick;

/// The halos of all ranks of a decomposition that is thought of. The halo itself would be the same;
/// buffers are kept from one count to the next.
#[derive(Debug, Default)]
pub(super) struct HaloCount {
    /// Of each rank the words of the box around what would be its particles.
    boxes: Least,
    extents: Vec<Extent>,
    /// The owner of each particle.
    owners: Vec<u32>,
    /// Particles that may be near other ranks, by their owners: as words of an owner and a particle.
    order: Vec<u64>,
    /// Particles that each rank would hear of, as threads find them.
    received: Vec<AtomicU64>,
    /// The same of all ranks.
    halos: Vec<u64>,
    /// Particles that ranks would receive in all counts.
    #[cfg(test)]
    pub(super) found: u64,
    /// Searches of space for ranks that are near one.
    #[cfg(test)]
    searches: AtomicU64,
}

thread_local! {
    /// Buffers of a thread: ranks near one, and particles that they would receive of it.
    static NEAR: RefCell<(Vec<usize>, Vec<u64>)> = RefCell::default();
}

/// Particles that a task looks at.
const SHARE: usize = 4096;

/// Ranks whose halos tell of those of all.
const SOME: usize = 8;

/// The word of a particle that no other rank is near to.
const DEEP: u64 = u64::MAX;

/// No place.
const NOWHERE: Brick = Brick {
    lower: [f64::INFINITY; 3],
    upper: [f64::NEG_INFINITY; 3],
};

impl HaloCount {
    /// Counts for particles at `positions` (m), of which each has an `owner` and `reach`es so far (m), on all processes
    /// of `comm`, which need not be the ranks of the slabs. Collective.
    pub(super) fn count(
        &mut self,
        comm: &Comm,
        slabs: &NestedSlabs,
        (positions, owner): (&[[f64; 3]], impl Fn(usize) -> u32 + Sync),
        reach: &(impl Fn(usize) -> f64 + Sync),
    ) {
        self.find_extents(comm, slabs, (positions, owner), reach);
        self.find_halos(comm, slabs, positions, reach);
    }

    /// The most particles of others that any of some ranks would have: no more than the most of all. Collective.
    pub(super) fn of_some(
        &mut self,
        comm: &Comm,
        slabs: &NestedSlabs,
        (positions, owner): (&[[f64; 3]], impl Fn(usize) -> u32 + Sync),
        reach: &(impl Fn(usize) -> f64 + Sync),
    ) -> u64 {
        self.find_extents(comm, slabs, (positions, owner), reach);
        let extents = &self.extents;
        let ranks = 0..slabs.ranks();
        let taken: Vec<usize> = ranks.filter(|&rank| !extents[rank].is_empty()).collect();
        // Even places, of which none is the end, where halos are smaller.
        let places = (0..SOME).map(|k| (2 * k + 1) * taken.len() / (2 * SOME));
        let some = places.filter_map(|place| taken.get(place));
        let some: Vec<(Brick, Extent)> = some
            .map(|&rank| (slabs.region(rank), extents[rank]))
            .collect();
        let tasks = positions.par_chunks(SHARE).enumerate();
        let counts = tasks.map(|(task, positions)| {
            let mut counts = [0; SOME];
            for (k, position) in positions.iter().enumerate() {
                let reach = reach(task * SHARE + k);
                for (count, (region, extent)) in counts.iter_mut().zip(&some) {
                    let is_near = extent.is_near((position, position), reach + extent.reach);
                    *count += u64::from(is_near && !region.holds(position));
                }
            }
            counts
        });
        let add = |a: [u64; SOME], b: [u64; SOME]| std::array::from_fn(|k| a[k] + b[k]);
        // same bits in any order: whole numbers
        let mut counts = counts.reduce(|| [0; SOME], add);
        comm.sum_u64(&mut counts);
        counts.into_iter().max().unwrap_or(0)
    }

    /// After [`Self::count`]: the most particles of others that a rank would have.
    pub(super) fn largest(&self) -> u64 {
        self.halos.iter().copied().max().unwrap_or(0)
    }

    /// After [`Self::count`]: lengths of the box around all particles (m).
    pub(super) fn lengths(&self) -> [f64; 3] {
        let join = |all: Extent, one: &Extent| all.join(*one);
        let all = self.extents.iter().fold(Extent::EMPTY, join);
        std::array::from_fn(|a| all.upper[a] - all.lower[a])
    }

    fn find_extents(
        &mut self,
        comm: &Comm,
        slabs: &NestedSlabs,
        (positions, owner): (&[[f64; 3]], impl Fn(usize) -> u32 + Sync),
        reach: &(impl Fn(usize) -> f64 + Sync),
    ) {
        self.boxes.begin(Extent::WORDS * slabs.ranks());
        self.owners.resize(positions.len(), 0);
        let boxes = &self.boxes;
        let owners = self.owners.par_chunks_mut(SHARE);
        let tasks = positions.par_chunks(SHARE).zip(owners).enumerate();
        tasks.for_each(|(task, (positions, owners))| {
            // Those of one rank follow each other: each run is told once.
            let (mut rank, mut extent) = (0, Extent::EMPTY);
            for (k, (position, of)) in positions.iter().zip(owners).enumerate() {
                *of = owner(task * SHARE + k);
                if *of != rank {
                    lower_box(boxes, rank, extent);
                    (rank, extent) = (*of, Extent::EMPTY);
                }
                extent.add(position, reach(task * SHARE + k));
            }
            lower_box(boxes, rank, extent);
        });
        self.boxes.join(comm);
        self.extents.clear();
        let extents = self.boxes.words().chunks_exact(Extent::WORDS);
        self.extents.extend(extents.map(Extent::of_words));
    }

    fn find_halos(
        &mut self,
        comm: &Comm,
        slabs: &NestedSlabs,
        positions: &[[f64; 3]],
        reach: &(impl Fn(usize) -> f64 + Sync),
    ) {
        self.received.clear();
        self.received.resize_with(slabs.ranks(), AtomicU64::default);
        let farthest = self.extents.iter().map(|extent| extent.reach);
        let farthest = farthest.fold(0.0, f64::max);
        self.sort(slabs, positions, 2.0 * MARGIN * farthest);
        let (received, extents) = (&self.received, &self.extents);
        #[cfg(test)]
        let searches = &self.searches;
        let tasks = self.order.par_chunks(SHARE);
        tasks.for_each(|words| {
            let (mut near, mut counts) = NEAR.take();
            let parts = words.chunk_by(|one, other| one >> 32 == other >> 32);
            for part in parts.filter(|part| part[0] != DEEP) {
                let owner = (part[0] >> 32) as usize;
                let mine = &extents[owner];
                near.clear();
                #[cfg(test)]
                searches.fetch_add(1, Relaxed);
                slabs.near(owner, 2.0 * farthest, |other| {
                    if mine.may_need(&extents[other]) {
                        near.push(other);
                    }
                });
                counts.clear();
                counts.resize(near.len(), 0);
                for word in part {
                    #[expect(clippy::cast_possible_truncation, reason = "as it was made")]
                    let i = (word & u64::from(u32::MAX)) as usize;
                    let (position, reach) = (&positions[i], reach(i));
                    for (count, &other) in counts.iter_mut().zip(&near) {
                        let there = &extents[other];
                        let is_near = there.is_near((position, position), reach + there.reach);
                        *count += u64::from(is_near);
                    }
                }
                for (&other, &count) in near.iter().zip(&counts) {
                    received[other].fetch_add(count, Relaxed);
                }
            }
            NEAR.set((near, counts));
        });
        self.halos.clear();
        let received = self.received.iter_mut().map(|received| *received.get_mut());
        self.halos.extend(received);
        comm.sum_u64(&mut self.halos);
        #[cfg(test)]
        {
            self.found += self.halos.iter().sum::<u64>();
        }
    }

    /// Puts particles in the order of their owners; of those that no other rank is nearer to than some depth (m) none
    /// is looked at.
    fn sort(&mut self, slabs: &NestedSlabs, positions: &[[f64; 3]], depth: f64) {
        self.order.resize(positions.len(), DEEP);
        let order = self.order.par_chunks_mut(SHARE);
        let tasks = order
            .zip(positions.par_chunks(SHARE))
            .zip(self.owners.par_chunks(SHARE));
        tasks
            .enumerate()
            .for_each(|(task, ((order, positions), owners))| {
                let (mut last, mut deep) = (u32::MAX, NOWHERE);
                for (k, ((word, position), &owner)) in
                    order.iter_mut().zip(positions).zip(owners).enumerate()
                {
                    if owner != last {
                        deep = slabs.region(owner as usize).widened(-depth);
                        last = owner;
                    }
                    *word = if deep.holds(position) {
                        DEEP
                    } else {
                        u64::from(owner) << 32 | (task * SHARE + k) as u64
                    };
                }
            });
        self.order.par_sort_unstable();
    }

    /// Bytes allocated.
    pub(super) fn memory(&self) -> usize {
        self.boxes.memory()
            + 8 * (self.received.capacity() + self.halos.capacity() + self.order.capacity())
            + 4 * self.owners.capacity()
            + size_of::<Extent>() * self.extents.capacity()
    }
}

/// Positions (m), and who owns each in some slabs.
pub(super) fn owned<'a>(
    slabs: &'a NestedSlabs,
    positions: &'a [[f64; 3]],
) -> (&'a [[f64; 3]], impl Fn(usize) -> u32 + Sync) {
    let owner = |i: usize| u32::try_from(slabs.owner(&positions[i])).expect("few ranks");
    (positions, owner)
}

/// Joins what a task has found of a rank, if anything, with what the others have.
fn lower_box(boxes: &Least, rank: u32, extent: Extent) {
    if !extent.is_empty() {
        boxes.lower(Extent::WORDS * rank as usize, extent.words());
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::balance::Balance;
    use super::super::rank_speed::RankSpeeds;
    use super::super::tally::tally;
    use super::*;
    use particles::Mirrors;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        /// Halos are those that the halo's own code finds, whatever the slabs.
        #[test]
        fn halos_are_those_of_the_exchange(
            places in prop::collection::vec((prop::array::uniform3(-9_i8..=9), 1_u8..8), 1..120),
            faces in prop::collection::vec(-8_i8..=8, 0..30),
            levels in 1_usize..=3,
            first in 0_usize..3,
        ) {
            let axes = [first, (first + 1) % 3, (first + 2) % 3];
            let faces = faces.iter().map(|&face| 0.7 * f64::from(face)).collect();
            let slabs = NestedSlabs::of_any(axes, levels, faces);
            let (positions, reach): (Vec<[f64; 3]>, Vec<f64>) = places
                .iter()
                .map(|(x, reach)| (x.map(f64::from), 0.25 * f64::from(*reach)))
                .unzip();
            let mut count = HaloCount::default();
            // What was counted before does not matter.
            let before = NestedSlabs::new(0, vec![0.5; 40]);
            count.count(&Comm::solo(), &before, owned(&before, &positions), &|_| 1.0);
            count.count(&Comm::solo(), &slabs, owned(&slabs, &positions), &|i| reach[i]);
            let all = (positions.as_slice(), reach.as_slice());
            let counted = tally(&slabs, &Mirrors::default(), all, |_| {});
            let counted: Vec<u64> = counted.iter().map(|tally| tally.halo).collect();
            prop_assert_eq!(&count.halos, &counted);
            prop_assert_eq!(count.largest(), counted.into_iter().max().unwrap());
            let some = count.of_some(&Comm::solo(), &slabs, owned(&slabs, &positions), &|i| reach[i]);
            prop_assert!(some <= count.largest());
            let few = (0..slabs.ranks()).filter(|&rank| !count.extents[rank].is_empty()).count() <= SOME;
            prop_assert!(!few || some == count.largest());
        }
    }

    /// However particles are ordered, space is searched for each rank and not for each particle.
    #[test]
    fn halos_take_a_search_a_rank() {
        const SIDE: u32 = 24;
        let all = SIDE.pow(3);
        let positions: Vec<[f64; 3]> = (0..all)
            .map(|k| k.wrapping_mul(7919) % all)
            .map(|k| [k % SIDE, k / SIDE % SIDE, k / (SIDE * SIDE)].map(f64::from))
            .collect();
        let ranks = 512;
        let mut slabs = NestedSlabs::on_first([0, 1, 2], 3, ranks);
        let work = vec![1; positions.len()];
        let even = RankSpeeds::default();
        Balance::default().cut(&Comm::solo(), &mut slabs, (&positions, &work), &even);
        let mut count = HaloCount::default();
        count.count(&Comm::solo(), &slabs, owned(&slabs, &positions), &|_| 1.3);
        assert!(count.largest() > 100);
        let tasks = positions.len().div_ceil(SHARE);
        let searches = *count.searches.get_mut();
        assert!(searches <= (ranks + tasks) as u64, "{searches}");
    }
}
