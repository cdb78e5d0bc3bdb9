//! The sites where a function of place is smallest, block by block.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::fit::settled;
use super::laid::{Block, Cells};
use crate::populate::Wanted;
use crate::populate::row::Cut;

/// A range of blocks, with a bound of what is in it.
struct Part {
    bound: f64,
    first: [u64; 3],
    end: [u64; 3],
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_bound = other.bound.total_cmp(&self.bound);
        by_bound.then_with(|| other.first.cmp(&self.first))
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Part {}

impl Part {
    /// Both halves across the longest side.
    fn halves(&self) -> [([u64; 3], [u64; 3]); 2] {
        let axis = (0..3)
            .max_by_key(|&a| self.end[a] - self.first[a])
            .unwrap_or(0);
        let middle = u64::midpoint(self.first[axis], self.end[axis]);
        let (mut end, mut first) = (self.end, self.first);
        end[axis] = middle;
        first[axis] = middle;
        [(self.first, end), (first, self.end)]
    }

    fn is_block(&self) -> bool {
        (0..3).all(|a| self.end[a] - self.first[a] == 1)
    }
}

/// The sites that the cuts leave where `value` is smallest, smallest first; see
/// [`crate::populate::search`]. Sites that are fitted are taken for where they end nearly.
pub(in crate::populate) fn search(
    cells: &Cells,
    cuts: &[Cut],
    wanted: Wanted,
    bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
    value: impl Fn(&[f64; 3]) -> f64,
) -> Vec<(f64, [f64; 3])> {
    let mut found: Vec<(f64, [f64; 3])> = Vec::new();
    let mut waiting = BinaryHeap::from([Part {
        bound: f64::NEG_INFINITY,
        first: [0; 3],
        end: cells.blocks(),
    }]);
    while let Some(part) = waiting.pop() {
        #[cfg(test)]
        crate::populate::visits::add();
        let worst = match found.last() {
            Some((worst, _)) if found.len() == wanted.most => *worst,
            _ => wanted.limit,
        };
        if part.bound >= worst || (wanted.any && found.len() == wanted.most) {
            break;
        }
        if !part.is_block() {
            for (first, end) in part.halves() {
                if let Some((lower, upper)) = around(cells, cuts, first, end) {
                    let bound = bound(&lower, &upper).max(part.bound);
                    if bound < worst {
                        waiting.push(Part { bound, first, end });
                    }
                }
            }
            continue;
        }
        for site in cells.sites_of(Block { at: part.first }, cuts) {
            let position = if cells.is_fitted() {
                settled(cells, &site.position)
            } else {
                site.position
            };
            let value = value(&position);
            let worst = match found.last() {
                Some((worst, _)) if found.len() == wanted.most => *worst,
                _ => wanted.limit,
            };
            if value < worst {
                let place = found.partition_point(|(other, _)| *other <= value);
                found.truncate(wanted.most - 1);
                found.insert(place, (value, position));
            }
        }
    }
    found
}

/// A box (m) around what a range of blocks may hold.
fn around(
    cells: &Cells,
    cuts: &[Cut],
    first: [u64; 3],
    end: [u64; 3],
) -> Option<([f64; 3], [f64; 3])> {
    let (middle, half) = cells.middle(first, end);
    let mut aside = cells.turn.abs() * half;
    let moved = if cells.is_fitted() { 1.0 } else { 1e-9 } * cells.spacing;
    for a in 0..cells.dimension {
        aside[a] += moved;
    }
    let (lower, upper) = ((middle - aside).into(), (middle + aside).into());
    let is_cut = cuts.iter().any(|cut| cut.drops(&lower, &upper));
    (!is_cut && cells.solid.distance(&middle) <= half.norm()).then_some((lower, upper))
}

/// Smallest and largest coordinates (m) of the sites, if there are any.
pub(in crate::populate) fn extremes(cells: &Cells, cuts: &[Cut]) -> Option<([f64; 3], [f64; 3])> {
    let wanted = Wanted {
        most: 1,
        limit: f64::INFINITY,
        any: false,
    };
    let (mut lowest, mut highest) = ([0.0; 3], [0.0; 3]);
    for a in 0..cells.dimension {
        let low = search(cells, cuts, wanted, |lower, _| lower[a], |x| x[a]);
        let high = search(cells, cuts, wanted, |_, upper| -upper[a], |x| -x[a]);
        lowest[a] = low.first()?.0;
        highest[a] = -high.first()?.0;
    }
    Some((lowest, highest))
}
