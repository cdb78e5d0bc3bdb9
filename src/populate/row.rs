//! The parts of lattice rows that lie in a body and in a slab.
//!
//! A shape is convex and a coordinate is monotone along a row, so what is left of a row is always
//! one run of indices.

use std::ops::Range;

use super::Slab;
use super::lattice::Stack;
use crate::model::SymmetryPlane;

/// A run of sites `first..end` in row `j` of layer `k`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub j: u64,
    pub k: u64,
    pub first: u64,
    pub end: u64,
}

impl Row {
    pub fn range(self) -> Range<u64> {
        self.first..self.end
    }
}

/// All non-empty runs of a body above the symmetry planes and in the slab, in lattice order.
pub(super) fn rows(
    stack: Stack,
    symmetry: &[SymmetryPlane],
    slab: Option<Slab>,
) -> impl Iterator<Item = Row> + use<> {
    let planes = symmetry.to_vec();
    let [_, rows, layers] = stack.counts;
    let layer_slab = slab.filter(|slab| slab.axis == 2);
    let above = stack;
    (0..layers)
        .filter(move |&k| {
            layer_slab.is_none_or(|slab| {
                let z = above.position(0, 0, k)[2];
                slab.lower <= z && z < slab.upper
            })
        })
        .flat_map(move |k| (0..rows).map(move |j| (j, k)))
        .filter_map(move |(j, k)| {
            let run = shape_run(&stack, j, k);
            let mut row = Row {
                j,
                k,
                first: run.start,
                end: run.end,
            };
            for plane in &planes {
                row.drop_below(&stack, plane.axis.index(), |x| x <= plane.position);
            }
            if let Some(slab) = slab {
                row.drop_below(&stack, slab.axis, |x| x < slab.lower);
                row.drop_above(&stack, slab.axis, |x| x >= slab.upper);
            }
            (row.first < row.end).then_some(row)
        })
}

impl Row {
    /// Drops the sites whose coordinate is too small.
    fn drop_below(&mut self, stack: &Stack, axis: usize, too_small: impl Fn(f64) -> bool) {
        let at = |i| stack.position(i, self.j, self.k)[axis];
        if stack.step()[axis] >= 0.0 {
            self.first = partition(self.range(), |i| too_small(at(i)));
        } else {
            self.end = partition(self.range(), |i| !too_small(at(i)));
        }
    }

    /// Drops the sites whose coordinate is too large.
    fn drop_above(&mut self, stack: &Stack, axis: usize, too_large: impl Fn(f64) -> bool) {
        let at = |i| stack.position(i, self.j, self.k)[axis];
        if stack.step()[axis] >= 0.0 {
            self.end = partition(self.range(), |i| !too_large(at(i)));
        } else {
            self.first = partition(self.range(), |i| too_large(at(i)));
        }
    }
}

/// The run of a whole row that lies in the shape: estimated from the formulas of the line, then
/// settled by the test of the sites at its ends.
fn shape_run(stack: &Stack, j: u64, k: u64) -> Range<u64> {
    let inside = &stack.inside;
    let origin = stack.offset(0, j, k);
    let step = stack.step();
    #[allow(clippy::cast_precision_loss)] // counts stay far below 2^52
    let (mut low, mut high) = (0.0_f64, stack.counts[0] as f64 - 1.0);
    for a in 0..3 {
        if inside.flat[a].is_finite() && step[a] != 0.0 {
            let t = [-inside.flat[a], inside.flat[a]].map(|face| (face - origin[a]) / step[a]);
            low = low.max(t[0].min(t[1]));
            high = high.min(t[0].max(t[1]));
        }
    }
    if inside.radius_squared.is_finite() {
        let dot = |p: [f64; 3], q: [f64; 3]| (0..3).map(|a| inside.round[a] * p[a] * q[a]).sum();
        let (squared, half, rest): (f64, f64, f64) = (
            dot(step, step),
            dot(step, origin),
            dot(origin, origin) - inside.radius_squared,
        );
        if squared > 0.0 {
            let root = (half * half - squared * rest).max(0.0).sqrt();
            low = low.max((-half - root) / squared);
            high = high.min((-half + root) / squared);
        }
    }
    settle(stack, j, k, low, high)
}

/// Indices in `[low, high]`, one more at each side for rounding, less those outside the shape.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped before
fn settle(stack: &Stack, j: u64, k: u64, low: f64, high: f64) -> Range<u64> {
    if high < low - 1.0 || stack.counts[0] == 0 {
        return 0..0;
    }
    let mut first = (low.floor() - 1.0).max(0.0) as u64;
    let mut end = ((high.ceil() + 2.0).max(0.0) as u64).min(stack.counts[0]);
    let contains = |i| stack.inside.contains(stack.offset(i, j, k));
    while first < end && !contains(first) {
        first += 1;
    }
    while first < end && !contains(end - 1) {
        end -= 1;
    }
    first..end
}

/// First index of a range at which `before` is false; `before` is true up to there.
fn partition(range: Range<u64>, before: impl Fn(u64) -> bool) -> u64 {
    let Range { mut start, mut end } = range;
    while start < end {
        let middle = start + (end - start) / 2;
        if before(middle) {
            start = middle + 1;
        } else {
            end = middle;
        }
    }
    start
}
