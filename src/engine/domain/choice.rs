//! Levels and axes of the cuts of space: chosen so that the fullest halo is small.

use super::balance::Balance;
use super::halo_count::{HaloCount, owned};
use super::nested::NestedSlabs;
use super::rank_speed::RankSpeeds;
use comm::Comm;
use model::Case;

/// The choice of levels and axes for a case that leaves them open. It decides who computes a particle,
/// never what comes out.
#[derive(Debug)]
pub struct Choice {
    dimension: usize,
    /// Number of axes that the case names.
    named: usize,
    halos: HaloCount,
    trial: NestedSlabs,
    /// The largest halo when slabs were compared last.
    seen: Option<u64>,
}

/// Share of the largest halo below which other slabs are worth the messages of more levels, or the
/// way there.
pub(super) const WORTHWHILE: f64 = 0.95;

impl Choice {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let named = case.domain.axes.iter().flatten();
        Self::of(case.dimension, named.count())
    }

    fn of(dimension: usize, named: usize) -> Self {
        Self {
            dimension,
            named,
            halos: HaloCount::default(),
            trial: NestedSlabs::new(0, Vec::new()),
            seen: None,
        }
    }

    /// Looks whether other levels or axes than those of `slabs`, which a balance has just cut, leave a
    /// smaller halo, and takes the fewest levels that more would not better by much. Nothing is
    /// compared while the halo is as large as when that was done last. Owned particles stand at
    /// `positions` (m) with counted `work`, and each `reach`es so far (m). Collective.
    pub fn revise(
        &mut self,
        comm: &Comm,
        slabs: &mut NestedSlabs,
        (balance, rank_speeds): (&mut Balance, &RankSpeeds),
        (positions, work): (&[[f64; 3]], &[u32]),
        reach: impl Fn(usize) -> f64 + Sync,
    ) {
        // Thin slabs that reach over each other take long to count, and are worse than what comes by a factor: then what
        // some ranks have of them is enough.
        let mut is_known = self.seen.is_some();
        let owners = balance.owners(slabs, positions);
        let placed = (positions, |i: usize| owners[i]);
        let mut best = if is_known {
            self.halos.count(comm, slabs, placed, &reach);
            self.halos.largest()
        } else {
            self.halos.of_some(comm, slabs, placed, &reach)
        };
        if self.seen.is_some_and(|seen| is_alike(seen, best)) {
            return;
        }
        let (axes, ranks) = (self.axes(slabs.axes()), slabs.ranks());
        for levels in 1..=self.dimension {
            if slabs.levels() == levels && slabs.axes()[..levels] == axes[..levels] {
                continue;
            }
            let trial = &mut self.trial;
            trial.reset(axes, levels, ranks);
            balance.cut(comm, trial, (positions, work), rank_speeds);
            let owners = balance.owners(trial, positions);
            let placed = (positions, |i: usize| owners[i]);
            self.halos.count(comm, trial, placed, &reach);
            let largest = self.halos.largest();
            if !is_known && !is_worthwhile(largest, best) {
                self.halos
                    .count(comm, slabs, owned(slabs, positions), &reach);
                (is_known, best) = (true, self.halos.largest());
            }
            if is_worthwhile(largest, best) {
                (is_known, best) = (true, largest);
                std::mem::swap(slabs, trial);
            }
        }
        if !is_known {
            self.halos
                .count(comm, slabs, owned(slabs, positions), &reach);
            best = self.halos.largest();
        }
        self.seen = Some(best);
    }

    /// Axes by the lengths of all that was counted last, longest first, but for those that are named;
    /// of nearly the same length in their order so far.
    fn axes(&self, mut axes: [usize; 3]) -> [usize; 3] {
        let lengths = self.halos.lengths();
        for first in [0, 1, 0] {
            let [one, next] = [axes[first], axes[first + 1]];
            if first >= self.named && lengths[one] < WORTHWHILE * lengths[next] {
                axes.swap(first, first + 1);
            }
        }
        axes
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.halos.memory() + 8 * self.trial.faces().len()
    }
}

#[allow(clippy::cast_precision_loss, reason = "far fewer than 2^52")]
fn is_worthwhile(halo: u64, before: u64) -> bool {
    (halo as f64) < WORTHWHILE * before as f64
}

fn is_alike(one: u64, other: u64) -> bool {
    !is_worthwhile(one, other) && !is_worthwhile(other, one)
}

#[cfg(test)]
mod tests {
    use super::super::tally::tally;
    use super::*;
    use particles::Mirrors;

    /// So many layers along each axis, a metre apart.
    fn lattice(layers: [u32; 3]) -> Vec<[f64; 3]> {
        let all = 0..layers.iter().product();
        let [x, y, _] = layers;
        all.map(|n: u32| [n % x, n / x % y, n / (x * y)].map(f64::from))
            .collect()
    }

    /// Half of the range of two particles (m).
    const REACH: f64 = 1.3;

    /// Balances slabs and revises them.
    fn revise(choice: &mut Choice, slabs: &mut NestedSlabs, positions: &[[f64; 3]]) {
        let (work, even, solo) = (
            vec![1; positions.len()],
            RankSpeeds::default(),
            Comm::solo(),
        );
        let (mut balance, all) = (Balance::default(), (positions, work.as_slice()));
        balance.cut(&solo, slabs, all, &even);
        choice.revise(&solo, slabs, (&mut balance, &even), all, |_| REACH);
    }

    /// The largest halo of particles in slabs of so many levels along the first of some axes.
    fn largest(slabs: &mut NestedSlabs, positions: &[[f64; 3]]) -> u64 {
        let (work, even) = (vec![1; positions.len()], RankSpeeds::default());
        Balance::default().cut(&Comm::solo(), slabs, (positions, &work), &even);
        let reach = vec![REACH; positions.len()];
        let tallies = tally(slabs, &Mirrors::default(), (positions, &reach), |_| {});
        tallies.iter().map(|tally| tally.halo).max().unwrap()
    }

    #[test]
    fn a_block_is_cut_along_three_axes_a_plate_along_two_and_a_rod_along_one() {
        for (layers, ranks, levels) in [
            ([24, 24, 24], 8, 3),
            ([60, 60, 4], 16, 2),
            ([400, 4, 4], 8, 1),
        ] {
            let positions = lattice(layers);
            let mut slabs = NestedSlabs::on_first([0, 1, 2], 1, ranks);
            revise(&mut Choice::of(3, 0), &mut slabs, &positions);
            assert_eq!((slabs.levels(), slabs.axes()), (levels, [0, 1, 2]));
            // As a count of all levels says.
            let of = |levels| {
                largest(
                    &mut NestedSlabs::on_first([0, 1, 2], levels, ranks),
                    &positions,
                )
            };
            let halos = [1, 2, 3].map(of);
            let least = *halos.iter().min().unwrap();
            assert!(!is_worthwhile(least, halos[levels - 1]), "{halos:?}");
        }
    }

    /// Slabs of one level, which reach over each other the more the more ranks there are, are counted of some ranks alone.
    #[test]
    #[allow(clippy::cast_precision_loss, reason = "few particles")]
    fn the_work_of_a_choice_grows_as_particles_do() {
        let each = |layers: u32| {
            // No two particles lie in one layer.
            let width = f64::from(layers);
            let turned = |[x, y, z]: [f64; 3]| {
                [x + (y + z / width) / width, y + z / width, z].map(|x| x + 0.5)
            };
            let positions: Vec<[f64; 3]> = lattice([layers; 3]).into_iter().map(turned).collect();
            let ranks = positions.len() / 27;
            let mut slabs = NestedSlabs::on_first([0, 1, 2], 1, ranks);
            let mut choice = Choice::of(3, 0);
            revise(&mut choice, &mut slabs, &positions);
            assert_eq!(slabs.levels(), 3);
            choice.halos.found as f64 / positions.len() as f64
        };
        let [few, many] = [12, 24].map(each);
        assert!(many < 1.8 * few, "{few} {many}");
    }

    /// Cuts follow a body that spreads along another axis; one that stays as it is keeps its slabs.
    #[test]
    fn slabs_follow_what_spreads() {
        let mut choice = Choice::of(3, 0);
        let mut slabs = NestedSlabs::on_first([0, 1, 2], 1, 16);
        let [plate, rod] = [[60, 60, 4], [4, 4, 900]].map(lattice);
        for (positions, levels, axes) in [
            (&plate, 2, [0, 1, 2]),
            (&plate, 2, [0, 1, 2]),
            (&rod, 1, [2, 0, 1]),
            (&rod, 1, [2, 0, 1]),
            (&plate, 2, [0, 1, 2]),
        ] {
            revise(&mut choice, &mut slabs, positions);
            assert_eq!(slabs.levels(), levels);
            assert_eq!(slabs.axes()[..levels], axes[..levels]);
        }
        // An axis that the case names stays the first.
        let mut slabs = NestedSlabs::on_first([0, 1, 2], 1, 16);
        revise(&mut Choice::of(3, 1), &mut slabs, &rod);
        assert_eq!(slabs.axis(0), 0);
    }
}
