//! Exact sums over what is no part of a driven body.

use std::ops::Range;

use rayon::prelude::*;

use super::Loads;
use numerics::exact_sum::ExactSum;
use numerics::gathered_sums::{self, GatheredSums};
use particles::{Active, Block, GRAIN, KeptBlocks, ParticleStore};

impl Loads {
    /// Exact sums of `terms` of this rank's particles that are no part of a driven body.
    pub(crate) fn sum_free<const N: usize>(
        &self,
        particles: &ParticleStore,
        terms: impl Fn(usize) -> [f64; N] + Sync,
    ) -> [ExactSum; N] {
        self.sum_where(particles, |_| true, terms)
    }

    /// The same of those that are `meant`.
    pub(super) fn sum_where<const N: usize>(
        &self,
        particles: &ParticleStore,
        meant: impl Fn(usize) -> bool + Sync,
        terms: impl Fn(usize) -> [f64; N] + Sync,
    ) -> [ExactSum; N] {
        sum_over(particles.owned(), |i| {
            (meant(i) && self.is_free(particles, i)).then(|| terms(i))
        })
    }

    /// As [`Self::sum_free`], with the `kept` sums of inactive particles, whose terms stay as they are.
    pub(crate) fn sum_kept<const N: usize>(
        &self,
        active: Active,
        kept: &mut KeptBlocks<[ExactSum; N]>,
        terms: impl Fn(usize) -> [f64; N] + Sync,
    ) -> [ExactSum; N] {
        let add = |places: Range<usize>, sums: &mut GatheredSums<N>| {
            let free = places.filter(|&i| self.is_free(active.particles, i));
            free.for_each(|i| sums.add(&terms(i)));
        };
        let of_block = |mut sums: GatheredSums<N>, mut block: Block<'_, [ExactSum; N]>| {
            let of_inactive = |places| {
                let mut sums = GatheredSums::default();
                add(places, &mut sums);
                Some(sums.into_sums())
            };
            match block.kept(of_inactive) {
                Some(kept) => sums.merge_sums(kept),
                None => add(block.places(), &mut sums),
            }
            sums
        };
        all(
            kept.each(active.particles.owned(), active.inactive),
            of_block,
        )
    }

    /// True if a particle is no part of a driven body.
    fn is_free(&self, particles: &ParticleStore, i: usize) -> bool {
        !self.has_motions() || !self.is_driven(particles.load[i])
    }
}

/// Exact sums of the terms of those of the particles `0..owned` that have any.
pub(crate) fn sum_over<const N: usize>(
    owned: usize,
    terms: impl Fn(usize) -> Option<[f64; N]> + Sync,
) -> [ExactSum; N] {
    let of_chunk = |mut sums: GatheredSums<N>, chunk: usize| {
        let all = (chunk * GRAIN..((chunk + 1) * GRAIN).min(owned)).filter_map(&terms);
        all.for_each(|terms| sums.add(&terms));
        sums
    };
    all((0..owned.div_ceil(GRAIN)).into_par_iter(), of_chunk)
}

/// Sums that `add` makes over pieces of the store.
fn all<const N: usize, P: Send>(
    pieces: impl ParallelIterator<Item = P>,
    add: impl Fn(GatheredSums<N>, P) -> GatheredSums<N> + Sync + Send,
) -> [ExactSum; N] {
    pieces
        // same bits in any order: exact sums are integers
        .fold(GatheredSums::default, add)
        .map(GatheredSums::into_sums)
        // same bits in any order, as above
        .reduce(gathered_sums::none, gathered_sums::merged)
}
