//! Number of particles that ranks would receive of each other in some slabs, counted from particles
//! on any ranks.

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
    /// Particles that each rank would hear of, as threads find them.
    received: Vec<AtomicU64>,
    /// The same of all ranks.
    halos: Vec<u64>,
    /// Particles that ranks would receive in all counts.
    #[cfg(test)]
    pub(super) found: u64,
}

/// Particles that a task looks at.
const SHARE: usize = 4096;

/// Ranks whose halos tell of those of all.
const SOME: usize = 8;

/// No place.
const NOWHERE: Brick = Brick {
    lower: [f64::INFINITY; 3],
    upper: [f64::NEG_INFINITY; 3],
};

impl HaloCount {
    /// Counts for particles at `positions` (m), of which each `reach`es so far (m), on all processes
    /// of `comm`, which need not be the ranks of the slabs. Collective.
    pub(super) fn count(
        &mut self,
        comm: &Comm,
        slabs: &NestedSlabs,
        positions: &[[f64; 3]],
        reach: &(impl Fn(usize) -> f64 + Sync),
    ) {
        self.find_extents(comm, slabs, positions, reach);
        self.find_halos(comm, slabs, positions, reach);
    }

    /// The most particles of others that any of some ranks would have: no more than the most of all. Collective.
    pub(super) fn of_some(
        &mut self,
        comm: &Comm,
        slabs: &NestedSlabs,
        positions: &[[f64; 3]],
        reach: &(impl Fn(usize) -> f64 + Sync),
    ) -> u64 {
        self.find_extents(comm, slabs, positions, reach);
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
        positions: &[[f64; 3]],
        reach: &(impl Fn(usize) -> f64 + Sync),
    ) {
        self.boxes.begin(Extent::WORDS * slabs.ranks());
        let boxes = &self.boxes;
        let tasks = positions.par_chunks(SHARE).enumerate();
        tasks.for_each(|(task, positions)| {
            // Those of one rank follow each other: each run is told once.
            let (mut owner, mut region, mut extent) = (0, NOWHERE, Extent::EMPTY);
            for (k, position) in positions.iter().enumerate() {
                if !region.holds(position) {
                    lower_box(boxes, owner, extent);
                    owner = slabs.owner(position);
                    (region, extent) = (slabs.region(owner), Extent::EMPTY);
                }
                extent.add(position, reach(task * SHARE + k));
            }
            lower_box(boxes, owner, extent);
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
        let (received, extents) = (&self.received, &self.extents);
        let farthest = extents.iter().map(|extent| extent.reach);
        let farthest = farthest.fold(0.0, f64::max);
        let tasks = positions.par_chunks(SHARE).enumerate();
        tasks.for_each(|(task, positions)| {
            let (mut owner, mut region, mut deep) = (0, NOWHERE, NOWHERE);
            for (k, position) in positions.iter().enumerate() {
                if deep.holds(position) {
                    continue;
                }
                if !region.holds(position) {
                    owner = slabs.owner(position);
                    region = slabs.region(owner);
                    deep = region.widened(-2.0 * MARGIN * farthest);
                }
                let reach = reach(task * SHARE + k);
                slabs.near_place(position, reach + farthest, |other| {
                    let there = &extents[other];
                    let is_near = there.is_near((position, position), reach + there.reach);
                    if is_near && other != owner {
                        received[other].fetch_add(1, Relaxed);
                    }
                });
            }
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

    /// Bytes allocated.
    pub(super) fn memory(&self) -> usize {
        self.boxes.memory()
            + 8 * (self.received.capacity() + self.halos.capacity())
            + size_of::<Extent>() * self.extents.capacity()
    }
}

/// Joins what a task has found of a rank, if anything, with what the others have.
fn lower_box(boxes: &Least, rank: usize, extent: Extent) {
    if !extent.is_empty() {
        boxes.lower(Extent::WORDS * rank, extent.words());
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

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
            count.count(&Comm::solo(), &NestedSlabs::new(0, vec![0.5; 40]), &positions, &|_| 1.0);
            count.count(&Comm::solo(), &slabs, &positions, &|i| reach[i]);
            let all = (positions.as_slice(), reach.as_slice());
            let counted = tally(&slabs, &Mirrors::default(), all, |_| {});
            let counted: Vec<u64> = counted.iter().map(|tally| tally.halo).collect();
            prop_assert_eq!(&count.halos, &counted);
            prop_assert_eq!(count.largest(), counted.into_iter().max().unwrap());
            let some = count.of_some(&Comm::solo(), &slabs, &positions, &|i| reach[i]);
            prop_assert!(some <= count.largest());
            let few = (0..slabs.ranks()).filter(|&rank| !count.extents[rank].is_empty()).count() <= SOME;
            prop_assert!(!few || some == count.largest());
        }
    }
}
