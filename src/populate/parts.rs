//! Looking for the sites where a function of place is smallest, part by part of a filling.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::Wanted;

/// A filling of which parts are ranges of three indices.
pub(super) trait Parts {
    /// Ends of the indices of the whole.
    fn all(&self) -> [u64; 3];

    /// The axis across which a part is halved.
    fn longest(&self, first: [u64; 3], end: [u64; 3]) -> usize;

    /// A box (m) around the sites of a part; nothing if it has none.
    fn around(&self, first: [u64; 3], end: [u64; 3]) -> Option<([f64; 3], [f64; 3])>;

    /// Tells the sites (m) of a part of one index each.
    fn emit(&self, at: [u64; 3], emit: impl FnMut([f64; 3]));
}

/// A part, with a bound of what is in it.
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
    fn is_smallest(&self) -> bool {
        (0..3).all(|a| self.end[a] - self.first[a] == 1)
    }

    fn halves(&self, axis: usize) -> [([u64; 3], [u64; 3]); 2] {
        let middle = u64::midpoint(self.first[axis], self.end[axis]);
        let (mut end, mut first) = (self.end, self.first);
        end[axis] = middle;
        first[axis] = middle;
        [(self.first, end), (first, self.end)]
    }
}

/// The sites with the smallest values so far.
pub(super) struct Nearest {
    wanted: Wanted,
    found: Vec<(f64, [f64; 3])>,
}

impl Nearest {
    pub fn new(wanted: Wanted) -> Self {
        let found = Vec::new();
        Self { wanted, found }
    }

    /// Values from this one on are of no use.
    pub fn worst(&self) -> f64 {
        let last = self.found.last().filter(|_| self.is_full());
        last.map_or(self.wanted.limit, |(worst, _)| *worst)
    }

    pub fn is_full(&self) -> bool {
        self.found.len() == self.wanted.most
    }

    /// Takes a site (m) with its value, if it is of use.
    pub fn offer(&mut self, value: f64, position: [f64; 3]) {
        if value < self.worst() {
            let slot = self.found.partition_point(|(other, _)| *other <= value);
            self.found.truncate(self.wanted.most - 1);
            self.found.insert(slot, (value, position));
        }
    }

    /// Smallest first.
    pub fn found(self) -> Vec<(f64, [f64; 3])> {
        self.found
    }
}

/// The sites where `value` is smallest, smallest first, and no larger than a limit.
pub(super) fn best(
    parts: &impl Parts,
    wanted: Wanted,
    bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
    value: impl Fn(&[f64; 3]) -> f64,
) -> Vec<(f64, [f64; 3])> {
    let mut nearest = Nearest::new(wanted);
    let whole = Block {
        bound: f64::NEG_INFINITY,
        first: [0; 3],
        end: parts.all(),
    };
    let is_any = whole.end.iter().all(|&n| n > 0);
    let mut waiting: BinaryHeap<Block> = is_any.then_some(whole).into_iter().collect();
    while let Some(block) = waiting.pop() {
        super::visits::add(1);
        let worst = nearest.worst();
        if block.bound >= worst {
            break;
        }
        if !block.is_smallest() {
            for (first, end) in block.halves(parts.longest(block.first, block.end)) {
                if let Some((lower, upper)) = parts.around(first, end) {
                    let bound = bound(&lower, &upper).max(block.bound);
                    if bound < worst {
                        waiting.push(Block { bound, first, end });
                    }
                }
            }
            continue;
        }
        parts.emit(block.first, |position| {
            nearest.offer(value(&position), position);
        });
        if wanted.any && nearest.is_full() {
            break;
        }
    }
    nearest.found()
}
