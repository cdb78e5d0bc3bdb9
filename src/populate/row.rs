//! The parts of lattice rows that lie in a body and in a slab.
//!
//! Shape and hole are convex and a coordinate is monotone along a row, so what is left of a row is
//! one run of indices, or two beside the hole.

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
        .flat_map(move |(j, k)| shape_runs(&stack, j, k))
        .filter_map(move |mut row| {
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
        if stack.step(self.j)[axis] >= 0.0 {
            self.first = partition(self.range(), |i| too_small(at(i)));
        } else {
            self.end = partition(self.range(), |i| !too_small(at(i)));
        }
    }

    /// Drops the sites whose coordinate is too large.
    fn drop_above(&mut self, stack: &Stack, axis: usize, too_large: impl Fn(f64) -> bool) {
        let at = |i| stack.position(i, self.j, self.k)[axis];
        if stack.step(self.j)[axis] >= 0.0 {
            self.end = partition(self.range(), |i| !too_large(at(i)));
        } else {
            self.first = partition(self.range(), |i| too_large(at(i)));
        }
    }
}

/// The runs of a whole row that lie in the shape, before and behind its hole.
fn shape_runs(stack: &Stack, j: u64, k: u64) -> [Row; 2] {
    let inside = &stack.inside;
    let row = |first, end| Row { j, k, first, end };
    if stack.has_rings() {
        return [row(0, stack.sites(j)), row(0, 0)];
    }
    let line = Line {
        stack,
        j,
        k,
        origin: stack.offset(0, j, k),
    };
    let shape = line.run(inside.flat, inside.radius_squared, |o| inside.contains(o));
    let mut runs = [row(shape.start, shape.end), row(shape.end, shape.end)];
    if inside.hole_squared > 0.0 {
        let hole = line.run([f64::INFINITY; 3], inside.hole_squared, |o| {
            inside.hollows(o)
        });
        if hole.start < hole.end {
            runs = [row(shape.start, hole.start), row(hole.end, shape.end)];
        }
    }
    runs
}

/// One row of the lattice.
struct Line<'a> {
    stack: &'a Stack,
    j: u64,
    k: u64,
    /// Vector from the centre to the first site (m).
    origin: [f64; 3],
}

impl Line<'_> {
    /// The run within flat faces and a radius: estimated from the formulas of the line, then settled
    /// by a test of the sites at its ends.
    fn run(
        &self,
        flat: [f64; 3],
        radius_squared: f64,
        contains: impl Fn([f64; 3]) -> bool,
    ) -> Range<u64> {
        let (stack, origin, step) = (self.stack, self.origin, self.stack.step(self.j));
        let round = &stack.inside.round;
        #[allow(clippy::cast_precision_loss)] // counts stay far below 2^52
        let (mut low, mut high) = (0.0_f64, stack.counts[0] as f64 - 1.0);
        for a in 0..3 {
            if flat[a].is_finite() && step[a] != 0.0 {
                let t = [-flat[a], flat[a]].map(|face| (face - origin[a]) / step[a]);
                low = low.max(t[0].min(t[1]));
                high = high.min(t[0].max(t[1]));
            }
        }
        if radius_squared.is_finite() {
            let dot = |p: [f64; 3], q: [f64; 3]| (0..3).map(|a| round[a] * p[a] * q[a]).sum();
            let (squared, half, rest): (f64, f64, f64) = (
                dot(step, step),
                dot(step, origin),
                dot(origin, origin) - radius_squared,
            );
            if squared > 0.0 {
                let root = (half * half - squared * rest).max(0.0).sqrt();
                low = low.max((-half - root) / squared);
                high = high.min((-half + root) / squared);
            }
        }
        self.settle(low, high, contains)
    }

    /// Indices in `[low, high]`, one more at each side for rounding, less those that are not
    /// contained.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped before
    fn settle(&self, low: f64, high: f64, contains: impl Fn([f64; 3]) -> bool) -> Range<u64> {
        let Self { stack, j, k, .. } = *self;
        if high < low - 1.0 || stack.counts[0] == 0 {
            return 0..0;
        }
        let mut first = (low.floor() - 1.0).max(0.0) as u64;
        let mut end = ((high.ceil() + 2.0).max(0.0) as u64).min(stack.counts[0]);
        let contains = |i| contains(stack.offset(i, j, k));
        while first < end && !contains(first) {
            first += 1;
        }
        while first < end && !contains(end - 1) {
            end -= 1;
        }
        first..end
    }
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
