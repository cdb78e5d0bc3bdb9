//! The sites of a body where a function of place is smallest, found without visiting the others.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::Wanted;
use super::cells::{self, Cells};
use super::lattice::Stack;
use super::row::cuts;
use crate::model::{Body, SymmetryPlane};

/// A part of the lattice by its indices `first..end`, with a bound of what is in it.
struct Block {
    bound: f64,
    first: [u64; 3],
    end: [u64; 3],
}

/// Those with the smallest bound come first, and among equals those with the first index.
impl Ord for Block {
    fn cmp(&self, other: &Self) -> Ordering {
        let [own, others] = [self, other].map(|b| [b.first[2], b.first[1], b.first[0]]);
        let by_bound = other.bound.total_cmp(&self.bound);
        by_bound.then_with(|| others.cmp(&own))
    }
}

impl PartialOrd for Block {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Block {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Block {}

impl Block {
    /// All of a lattice, if it has any sites.
    fn whole(stack: &Stack) -> Option<Self> {
        stack.counts.iter().all(|&n| n > 0).then_some(Self {
            bound: f64::NEG_INFINITY,
            first: [0; 3],
            end: stack.counts,
        })
    }

    fn is_site(&self) -> bool {
        (0..3).all(|a| self.end[a] - self.first[a] == 1)
    }

    /// Both halves across the longest side; of rings, first one by one.
    fn halves(&self, stack: &Stack) -> [Self; 2] {
        #[allow(clippy::cast_precision_loss)] // indices stay far below 2^52
        let length = |a: &usize| {
            let sites = (self.end[*a] - self.first[*a] - 1) as f64;
            let first = if stack.has_rings() && *a == 1 {
                1e9
            } else {
                1.0
            };
            sites * stack.pitch[*a] * first
        };
        let longest = (0..3).max_by(|a, b| length(a).total_cmp(&length(b)));
        let axis = longest.unwrap_or(0);
        let middle = u64::midpoint(self.first[axis], self.end[axis]);
        let (mut end, mut first) = (self.end, self.first);
        end[axis] = middle;
        first[axis] = middle;
        let (bound, below, above) = (self.bound, self.first, self.end);
        [(below, end), (first, above)].map(|(first, end)| Self { bound, first, end })
    }
}

/// The sites of a body (in a dimension, above all symmetry planes) where `value` is smallest,
/// smallest first. `bound` says what `value` is at least in a box between two corners (m); the
/// tighter it is, the fewer sites are looked at.
pub fn search(
    (body, dimension, symmetry): (&Body, usize, &[SymmetryPlane]),
    wanted: Wanted,
    bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
    value: impl Fn(&[f64; 3]) -> f64,
) -> Vec<(f64, [f64; 3])> {
    let cuts = cuts(symmetry, None);
    if let Some(cells) = Cells::of(body, dimension, symmetry) {
        return cells::search(&cells, &cuts, wanted, bound, value);
    }
    let stack = Stack::new(body, dimension);
    let mut found: Vec<(f64, [f64; 3])> = Vec::new();
    let mut waiting: BinaryHeap<Block> = Block::whole(&stack).into_iter().collect();
    while let Some(block) = waiting.pop() {
        #[cfg(test)]
        super::visits::add();
        let worst = match found.last() {
            Some((worst, _)) if found.len() == wanted.most => *worst,
            _ => wanted.limit,
        };
        if block.bound >= worst {
            break;
        }
        if !block.is_site() {
            for mut half in block.halves(&stack) {
                // Inner rings have fewer sites than rows of the lattice have places.
                if half.first[0] >= stack.sites(half.end[1] - 1) {
                    continue;
                }
                let (lower, upper) = stack.block(half.first, half.end);
                let is_cut = cuts.iter().any(|cut| cut.drops(&lower, &upper));
                if is_cut || !stack.may_hold(&lower, &upper) {
                    continue;
                }
                half.bound = bound(&lower, &upper).max(block.bound);
                if half.bound < worst {
                    waiting.push(half);
                }
            }
            continue;
        }
        let [i, j, k] = block.first;
        let position = stack.position(i, j, k);
        if stack.holds(block.first) && cuts.iter().all(|cut| cut.keeps(&position)) {
            let value = value(&position);
            if value < worst {
                let place = found.partition_point(|(other, _)| *other <= value);
                found.truncate(wanted.most - 1);
                found.insert(place, (value, position));
            }
            if wanted.any && found.len() == wanted.most {
                break;
            }
        }
    }
    found
}
