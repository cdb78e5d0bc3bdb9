//! The parts of lattice rows that lie in a body and in a brick.
//!
//! Shape and hole are convex and a coordinate is monotone along a row, so what is left of a row is
//! one run of indices, or two beside the hole.

use std::ops::Range;

use super::Brick;
use super::lattice::Stack;
use model::SymmetryPlane;

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

/// The part of an axis that a symmetry plane or two sides of a brick leave.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    axis: usize,
    /// Smallest coordinate (m), excluded above a symmetry plane.
    lower: f64,
    is_plane: bool,
    /// Largest coordinate, excluded (m).
    upper: f64,
}

/// The cuts of all symmetry planes and a brick.
pub(super) fn cuts(symmetry: &[SymmetryPlane], brick: Option<Brick>) -> Vec<Cut> {
    let planes = symmetry.iter().map(|plane| Cut {
        axis: plane.axis.index(),
        lower: plane.position,
        is_plane: true,
        upper: f64::INFINITY,
    });
    let mut cuts: Vec<Cut> = planes.collect();
    if let Some(Brick { lower, upper }) = brick {
        let sides = (0..3).map(|axis| Cut {
            axis,
            lower: lower[axis],
            is_plane: false,
            upper: upper[axis],
        });
        cuts.extend(sides.filter(Cut::is_any));
    }
    cuts
}

impl Cut {
    /// `true` if it cuts anything off.
    fn is_any(&self) -> bool {
        self.lower > f64::NEG_INFINITY || self.upper < f64::INFINITY
    }

    fn is_below(&self, x: f64) -> bool {
        x < self.lower || (self.is_plane && x == self.lower)
    }

    fn is_above(&self, x: f64) -> bool {
        x >= self.upper
    }

    /// The same with bricks wider by a length (m) on both sides.
    pub fn widened(&self, by: f64) -> Self {
        let by = if self.is_plane { 0.0 } else { by };
        Self {
            lower: self.lower - by,
            upper: self.upper + by,
            ..*self
        }
    }

    /// `true` if a position (m) is left.
    pub fn keeps(&self, position: &[f64; 3]) -> bool {
        let x = position[self.axis];
        !self.is_below(x) && !self.is_above(x)
    }

    /// `true` if nothing of a box (m) is left.
    pub fn drops(&self, lower: &[f64; 3], upper: &[f64; 3]) -> bool {
        self.is_below(upper[self.axis]) || self.is_above(lower[self.axis])
    }
}

/// All non-empty runs of a body that the cuts leave, in lattice order.
pub(super) fn rows(stack: Stack, cuts: Vec<Cut>) -> impl Iterator<Item = Row> + use<> {
    let rows = stack.counts[1];
    layers(&stack, &cuts)
        .flat_map(move |k| (0..rows).map(move |j| (j, k)))
        .flat_map(move |(j, k)| runs(&stack, &cuts, j, k))
        .filter(|row| row.first < row.end)
}

/// The non-empty runs of one layer.
pub(super) fn rows_of_layer(
    stack: &Stack,
    cuts: &[Cut],
    k: u64,
) -> impl DoubleEndedIterator<Item = Row> {
    (0..stack.counts[1])
        .flat_map(move |j| runs(stack, cuts, j, k))
        .filter(|row| row.first < row.end)
}

/// The layers that the cuts along z leave.
pub(super) fn layers(stack: &Stack, cuts: &[Cut]) -> Range<u64> {
    let z = |k| stack.position(0, 0, k)[2];
    let along = cuts.iter().filter(|cut| cut.axis == 2);
    along.fold(0..stack.counts[2], |layers, cut| {
        let first = partition(layers.clone(), |k| cut.is_below(z(k)));
        first..partition(first..layers.end, |k| !cut.is_above(z(k)))
    })
}

/// The part of row `j` in layer `k` that shape and cuts leave, before and behind a hole; both may
/// be empty.
pub(super) fn runs(stack: &Stack, cuts: &[Cut], j: u64, k: u64) -> [Row; 2] {
    let (step, start) = (stack.step(j), stack.position(0, j, k));
    // Along a row that is normal to an axis the coordinate is the same to the bit.
    let is_across = |cut: &&Cut| step[cut.axis] == 0.0;
    if cuts.iter().filter(is_across).any(|cut| !cut.keeps(&start)) {
        let (first, end) = (0, 0);
        return [Row { j, k, first, end }; 2];
    }
    let mut runs = shape_runs(stack, j, k);
    for cut in cuts.iter().filter(|cut| !is_across(cut)) {
        for run in &mut runs {
            run.cut(stack, cut);
        }
    }
    runs
}

impl Row {
    /// Drops the sites that a cut does not leave.
    fn cut(&mut self, stack: &Stack, cut: &Cut) {
        let at = |i| stack.position(i, self.j, self.k)[cut.axis];
        let step = stack.step(self.j)[cut.axis];
        // Rings are cut at angles, whose steps are not lengths.
        let index = |bound: f64| {
            if stack.has_rings() {
                f64::NAN
            } else {
                (bound - at(0)) / step
            }
        };
        let (first, last) = if step > 0.0 {
            (index(cut.lower), index(cut.upper))
        } else {
            (index(cut.upper), index(cut.lower))
        };
        let (left, right) = if step > 0.0 {
            (Cut::is_below as fn(&Cut, f64) -> bool, Cut::is_above as _)
        } else {
            (Cut::is_above as _, Cut::is_below as fn(&Cut, f64) -> bool)
        };
        self.first = partition_near(first, self.range(), |i| left(cut, at(i)));
        self.end = partition_near(last, self.range(), |i| !right(cut, at(i)));
    }
}

/// The runs of a whole row that lie in the shape, before and behind its hole.
fn shape_runs(stack: &Stack, j: u64, k: u64) -> [Row; 2] {
    super::visits::add(1);
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
    /// The run within flat faces and a radius: estimated from the formulas of the line, then
    /// narrowed by a test of the sites at its ends.
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
        self.narrow(low, high, contains)
    }

    /// Indices in `[low, high]`, one more at each side for rounding, less those that are not
    /// contained.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped before
    fn narrow(&self, low: f64, high: f64, contains: impl Fn([f64; 3]) -> bool) -> Range<u64> {
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

/// [`partition`] where a formula says nearly where that index is, or nothing.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a float cast saturates
fn partition_near(guess: f64, range: Range<u64>, before: impl Fn(u64) -> bool) -> u64 {
    let Range { start, end } = range;
    if guess.is_nan() || start >= end {
        return partition(range, before);
    }
    let guess = guess as u64;
    let low = guess.saturating_sub(1).clamp(start, end);
    let high = guess.saturating_add(3).clamp(start, end);
    let is_in_front = low == start || before(low - 1);
    let is_behind = high == end || !before(high);
    if is_in_front && is_behind {
        (low..high).find(|&i| !before(i)).unwrap_or(high)
    } else {
        partition(range, before)
    }
}

/// First index of a range at which `before` is false; `before` is true up to there.
fn partition(range: Range<u64>, before: impl Fn(u64) -> bool) -> u64 {
    let Range { mut start, mut end } = range;
    // Most cuts leave all of a range, or none.
    if start >= end || !before(start) {
        return start;
    }
    if before(end - 1) {
        return end;
    }
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
