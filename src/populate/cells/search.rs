//! The sites where a function of place is smallest, block by block.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use super::fit::{LAYER, on_layer};
use super::laid::{Block, Cells};
use crate::parts::{Parts, best};
use crate::row::Cut;
use crate::{Site, Wanted};
use model::{Lattice, Vec3};

/// The sites (m) of blocks of a level that have been looked at.
pub(crate) type Seen = Mutex<BTreeMap<[u64; 3], Vec<[f64; 3]>>>;

/// Blocks of a level of what is filled by cells, within some cuts.
struct Blocks<'a> {
    cells: &'a Cells,
    level: usize,
    cuts: &'a [Cut],
    seen: &'a Seen,
}

impl<'a> Blocks<'a> {
    /// Of all levels, with what has been seen of each.
    fn all(cells: &'a Cells, cuts: &'a [Cut], seen: &'a [Seen]) -> Vec<Self> {
        let levels = seen.iter().enumerate();
        levels
            .map(|(level, seen)| Self {
                cells,
                level,
                cuts,
                seen,
            })
            .collect()
    }
}

/// The sites (m) of a block within some cuts, those that are fitted where they end nearly.
fn sites_near(cells: &Cells, block: Block, cuts: &[Cut]) -> Vec<[f64; 3]> {
    let end = |site: Site| {
        if cells.is_fitted() {
            on_layer(cells, &site.position)
        } else {
            site.position
        }
    };
    cells.sites_of(block, cuts).into_iter().map(end).collect()
}

/// All sites (m) within some cuts, those that are fitted where they end nearly.
pub(crate) fn near_sites(cells: &Cells, cuts: &[Cut]) -> Vec<[f64; 3]> {
    let blocks = cells.all_blocks(cuts);
    blocks
        .flat_map(|block| sites_near(cells, block, cuts))
        .collect()
}

impl Parts for Blocks<'_> {
    fn all(&self) -> [u64; 3] {
        self.cells.blocks(self.level)
    }

    fn longest(&self, first: [u64; 3], end: [u64; 3]) -> usize {
        let longest = (0..3).max_by_key(|&a| end[a] - first[a]);
        longest.unwrap_or(0)
    }

    fn around(&self, first: [u64; 3], end: [u64; 3]) -> Option<([f64; 3], [f64; 3])> {
        let cells = self.cells;
        let (middle, half) = cells.middle(self.level, first, end);
        let mut aside = cells.turn.abs() * half;
        let moved = if cells.is_fitted() { 1.0 } else { 1e-9 } * cells.coarsest(self.level);
        for a in 0..cells.dimension {
            aside[a] += moved;
        }
        let (lower, upper) = ((middle - aside).into(), (middle + aside).into());
        let is_cut = self.cuts.iter().any(|cut| cut.drops(&lower, &upper));
        (!is_cut && cells.solid.distance(&middle) <= half.norm()).then_some((lower, upper))
    }

    fn emit(&self, at: [u64; 3], emit: impl FnMut([f64; 3])) {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        let Self {
            cells, level, cuts, ..
        } = *self;
        let block = Block { level, at };
        let sites = seen
            .entry(at)
            .or_insert_with(|| sites_near(cells, block, cuts));
        sites.iter().copied().for_each(emit);
    }
}

/// Nothing seen of any level.
pub(crate) fn unseen(cells: &Cells) -> Vec<Seen> {
    cells.levels.iter().map(|_| Seen::default()).collect()
}

/// The sites where `value` is smallest, smallest first: see [`crate::search`].
pub(crate) fn smallest(
    cells: &Cells,
    cuts: &[Cut],
    seen: &[Seen],
    wanted: Wanted,
    bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
    value: impl Fn(&[f64; 3]) -> f64,
) -> Vec<(f64, [f64; 3])> {
    smallest_of(&Blocks::all(cells, cuts, seen), wanted, bound, value)
}

/// The same of blocks of all levels.
fn smallest_of(
    blocks: &[Blocks],
    wanted: Wanted,
    bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
    value: impl Fn(&[f64; 3]) -> f64,
) -> Vec<(f64, [f64; 3])> {
    let mut nearest: Vec<(f64, [f64; 3])> = Vec::new();
    for level in blocks {
        nearest.extend(best(level, wanted, &bound, &value));
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        nearest.truncate(wanted.most);
    }
    nearest
}

/// Smallest and largest coordinates (m) of the sites, if there are any; of those that are fitted to
/// a billionth of a spacing.
pub(crate) fn extremes(cells: &Cells, cuts: &[Cut]) -> Option<([f64; 3], [f64; 3])> {
    let wanted = Wanted {
        most: 1,
        limit: f64::INFINITY,
        any: false,
    };
    let (mut least, most) = cells.ends;
    for &(a, at) in &cells.planes {
        least[a] = least[a].max(at);
    }
    // No site is fitted farther out than its layer: the search ends there.
    let layer = |lower: &[f64; 3], upper: &[f64; 3]| {
        if cells.is_fitted() {
            (LAYER + 1e-9) * finest(&cells.lattice, lower, upper)
        } else {
            0.0
        }
    };
    // Of a small body all six searches look at the same blocks.
    let seen = unseen(cells);
    let blocks = Blocks::all(cells, cuts, &seen);
    let (mut lowest, mut highest) = ([0.0; 3], [0.0; 3]);
    for a in 0..cells.dimension {
        let low = |lower: &[f64; 3], upper: &[f64; 3]| lower[a].max(least[a] + layer(lower, upper));
        let high =
            |lower: &[f64; 3], upper: &[f64; 3]| -upper[a].min(most[a] - layer(lower, upper));
        let low = smallest_of(&blocks, wanted, low, |x| x[a]);
        let high = smallest_of(&blocks, wanted, high, |x| -x[a]);
        lowest[a] = low.first()?.0;
        highest[a] = -high.first()?.0;
    }
    Some((lowest, highest))
}

/// A bound (m) of the finest spacing in a box (m).
fn finest(lattice: &Lattice, lower: &[f64; 3], upper: &[f64; 3]) -> f64 {
    lattice.grading.map_or(lattice.spacing, |grading| {
        let (lower, upper) = (Vec3::from(*lower), Vec3::from(*upper));
        let (middle, half) = ((lower + upper) * 0.5, (upper - lower) * 0.5);
        let nearest = grading.from.distance(&middle) - half.norm();
        grading.spacing(lattice.spacing, nearest)
    })
}
