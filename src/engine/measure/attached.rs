//! The part of a body that hangs together: its largest piece, of voxels that share faces.

use super::mask::Mask;
use super::voxels::{HALF, UNIT};
use super::window::Window;
use crate::fragments::Sets;

/// Voxels of a column that follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Run {
    /// The first of them.
    begin: u32,
    /// After the last.
    end: u32,
}

/// The largest piece of what fills a window, by columns along its last coordinate.
#[derive(Debug)]
pub struct Attached {
    /// Its window.
    pub window: Window,
    /// Fractions by voxel of the columns that are kept, in [`UNIT`]s.
    fractions: Vec<u16>,
    /// The kept column that each column is or is the image of.
    images: Vec<usize>,
    runs: Vec<Run>,
    /// Beginning of the runs of each column, and the end of those of the last.
    columns: Vec<usize>,
    /// Columns that have not held the body at the start, beside its rim and in holes that it is made with, or that its rim
    /// has left as it was drawn inwards.
    outside: Vec<bool>,
}

/// Adds the runs of a column.
fn add_runs(column: impl Iterator<Item = bool>, runs: &mut Vec<Run>) {
    let mut begin = None;
    for (k, is_in) in (0_u32..).zip(column.chain([false])) {
        match (begin, is_in) {
            (None, true) => begin = Some(k),
            (Some(first), false) => {
                runs.push(Run {
                    begin: first,
                    end: k,
                });
                begin = None;
            }
            _ => {}
        }
    }
}

/// Adds what the runs of a column leave out, from its beginning to its end.
fn add_gaps(column: &[Run], end: u32, gaps: &mut Vec<Run>) {
    let mut begin = 0;
    for run in column {
        if run.begin > begin {
            gaps.push(Run {
                begin,
                end: run.begin,
            });
        }
        begin = run.end;
    }
    if begin < end {
        gaps.push(Run { begin, end });
    }
}

impl Attached {
    /// The largest piece of a body that at the start has left some columns out, of what the columns hold that are
    /// kept; of several as large that which comes first.
    #[must_use]
    pub fn new(window: Window, fractions: Vec<u16>, outside: &[bool]) -> Self {
        let (mut kept, mut begins) = (Vec::new(), vec![0]);
        for column in fractions.chunks_exact(window.depth()) {
            if column.iter().any(|&f| f >= HALF) {
                add_runs(column.iter().map(|&f| f >= HALF), &mut kept);
            }
            begins.push(kept.len());
        }
        let images: Vec<usize> = window.images().collect();
        let outside: Vec<bool> = images.iter().map(|&image| outside[image]).collect();
        let empty = |column: usize| begins[images[column]] == begins[images[column] + 1];
        let drawn_in = drawn_in([window.counts[0], window.counts[1]], &outside, empty);
        let outside = outside.iter().zip(&drawn_in).map(|(a, b)| *a || *b);
        let outside: Vec<bool> = outside.collect();
        let (mut runs, mut columns) = (Vec::new(), vec![0]);
        for &image in &images {
            runs.extend_from_slice(&kept[begins[image]..begins[image + 1]]);
            columns.push(runs.len());
        }
        let is_largest = largest(&window, &runs, &columns);
        let mut own = Vec::new();
        let mut begins = vec![0];
        for pair in columns.windows(2) {
            let all = pair[0]..pair[1];
            own.extend(all.filter(|&run| is_largest[run]).map(|run| runs[run]));
            begins.push(own.len());
        }
        Self {
            window,
            fractions,
            runs: own,
            columns: begins,
            outside,
            images,
        }
    }

    fn column(&self, column: usize) -> &[Run] {
        &self.runs[self.columns[column]..self.columns[column + 1]]
    }

    /// True if it holds a voxel.
    #[must_use]
    pub fn holds(&self, [i, j, k]: [usize; 3]) -> bool {
        let column = self.column(i * self.window.counts[1] + j);
        column
            .iter()
            .any(|run| (run.begin as usize..run.end as usize).contains(&k))
    }

    /// True if it holds a voxel or one that touches it.
    #[must_use]
    pub fn holds_near(&self, voxel: [usize; 3]) -> bool {
        let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        let [i, j, k] = std::array::from_fn(|a| around(voxel[a], self.window.counts[a]));
        i.into_iter()
            .any(|i| (j.clone()).any(|j| k.clone().any(|k| self.holds([i, j, k]))))
    }

    fn mask(&self, yes: impl Fn(&[Run]) -> bool) -> Mask {
        let columns = 0..self.window.counts[0] * self.window.counts[1];
        let inside = |column: usize| !self.outside[column] && yes(self.column(column));
        let values = columns.map(inside).collect();
        Mask::new([self.window.counts[0], self.window.counts[1]], values)
    }

    /// Columns of the body that hold none of it.
    #[must_use]
    pub fn open(&self) -> Mask {
        self.mask(<[Run]>::is_empty)
    }

    /// Columns of the body that hold none of it from one height (m) of the last coordinate to another.
    #[must_use]
    pub fn open_between(&self, low: f64, high: f64) -> Mask {
        let within = self.between(low, high);
        self.mask(|runs| !runs.iter().any(&within))
    }

    /// Columns of the body that hold some of it there.
    #[must_use]
    pub fn filled_between(&self, low: f64, high: f64) -> Mask {
        let within = self.between(low, high);
        self.mask(|runs| runs.iter().any(&within))
    }

    /// True if a run has voxels whose middles lie between two heights (m); at least that which holds the middle of
    /// both.
    fn between(&self, low: f64, high: f64) -> impl Fn(&Run) -> bool {
        let place = |height: f64| (height - self.window.lower[2]) / self.window.edge;
        let (mut first, mut last) = ((place(low) - 0.5).ceil(), (place(high) - 0.5).floor());
        if last < first {
            first = place(0.5 * (low + high)).floor();
            last = first;
        }
        move |run| f64::from(run.begin) <= last && f64::from(run.end) > first
    }

    /// True if what it leaves open leads from above it to below it, elsewhere than around its rim.
    #[must_use]
    pub fn is_open(&self) -> bool {
        let depth = u32::try_from(self.window.depth()).unwrap_or(u32::MAX);
        let (mut runs, mut columns) = (Vec::new(), vec![0]);
        let around = self.open().at_border();
        for (column, &is_around) in around.iter().enumerate() {
            if !is_around && !self.outside[column] {
                add_gaps(self.column(column), depth, &mut runs);
            }
            columns.push(runs.len());
        }
        let roots = roots(&self.window, &runs, &columns);
        let above = runs.iter().map(|run| run.end == depth);
        let below = runs.iter().map(|run| run.begin == 0);
        let mut sides = vec![[false; 2]; runs.len()];
        for ((&root, above), below) in roots.iter().zip(above).zip(below) {
            let [up, down] = &mut sides[root as usize];
            *up |= above;
            *down |= below;
        }
        sides.contains(&[true; 2])
    }

    /// True if a voxel lies below all of it in its column, or beside it in an open one.
    #[must_use]
    pub fn is_below(&self, [i, j, k]: [usize; 3]) -> bool {
        let column = self.column(i * self.window.counts[1] + j);
        column.first().is_none_or(|run| k < run.begin as usize)
    }

    /// Columns with a gap of two voxels or more between parts of it.
    #[must_use]
    pub fn parted(&self) -> Mask {
        self.mask(|runs| runs.windows(2).any(|pair| pair[1].begin >= pair[0].end + 2))
    }

    /// True if a column has held the body at the start.
    #[must_use]
    pub fn is_of_body(&self, column: usize) -> bool {
        !self.outside[column]
    }

    /// Its ends in each column, upwards and downwards (m): there the fraction passes a half.
    pub fn ends(&self) -> impl Iterator<Item = Option<[f64; 2]>> {
        let depth = self.window.depth();
        (self.images.iter().enumerate()).map(move |(column, image)| {
            let fractions = &self.fractions[image * depth..(image + 1) * depth];
            let runs = self.column(column);
            let (first, last) = (runs.first()?, runs.last()?);
            let low = first.begin as usize;
            let high = last.end as usize - 1;
            let below = low.checked_sub(1).map_or(0, |k| fractions[k]);
            let above = fractions.get(high + 1).copied().unwrap_or(0);
            Some([
                self.height(low) - self.past(fractions[low], below),
                self.height(high) + self.past(fractions[high], above),
            ])
        })
    }

    /// Height (m) of the middle of a voxel.
    fn height(&self, k: usize) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let k = k as f64;
        self.window.lower[2] + (k + 0.5) * self.window.edge
    }

    /// Distance (m) beyond the middle of a voxel to a fraction of a half, towards an emptier one.
    fn past(&self, inside: u16, outside: u16) -> f64 {
        let (inside, outside) = (f64::from(inside), f64::from(outside.min(HALF - 1)));
        // A voxel fuller than full says nothing about where its face is.
        let inside = inside.min(f64::from(UNIT));
        self.window.edge * (inside - f64::from(HALF)) / (inside - outside)
    }
}

/// Columns that a probe of three by three reaches from outside the rim through empty ones: a rim that has been drawn inwards
/// leaves them, and narrow cracks do not let it in.
fn drawn_in(counts: [usize; 2], outside: &[bool], empty: impl Fn(usize) -> bool) -> Vec<bool> {
    let [rows, across] = counts;
    let around = |column: usize| {
        let near = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        let (i, j) = (column / across, column % across);
        near(i, rows).flat_map(move |i| near(j, across).map(move |j| i * across + j))
    };
    let columns = 0..rows * across;
    let free = |column: usize| outside[column] || empty(column);
    let probe: Vec<bool> = columns.clone().map(|c| around(c).all(free)).collect();
    let reached = Mask::new(counts, probe.clone()).at_border();
    let reaches = |column: usize| probe[column] && reached[column];
    columns.map(|c| free(c) && around(c).any(reaches)).collect()
}

/// The first run of the piece that each run belongs to.
fn roots(window: &Window, runs: &[Run], columns: &[usize]) -> Vec<u32> {
    let mut sets = Sets::default();
    sets.reset(runs.len());
    let [rows, across, _] = window.counts;
    let index = |run: usize| u32::try_from(run).unwrap_or(u32::MAX);
    let join = |a: usize, b: usize| {
        let (mut p, mut q) = (columns[a], columns[b]);
        while p < columns[a + 1] && q < columns[b + 1] {
            if runs[p].begin < runs[q].end && runs[q].begin < runs[p].end {
                sets.join(index(p), index(q));
            }
            if runs[p].end < runs[q].end {
                p += 1;
            } else {
                q += 1;
            }
        }
    };
    for i in 0..rows {
        for j in 0..across {
            let column = i * across + j;
            if i + 1 < rows {
                join(column, column + across);
            }
            if j + 1 < across {
                join(column, column + 1);
            }
        }
    }
    (0..runs.len()).map(|run| sets.root(index(run))).collect()
}

/// Flags of the runs that belong to the largest piece.
fn largest(window: &Window, runs: &[Run], columns: &[usize]) -> Vec<bool> {
    let roots = roots(window, runs, columns);
    let mut sizes = vec![0_u64; runs.len()];
    for (run, &root) in runs.iter().zip(&roots) {
        sizes[root as usize] += u64::from(run.end - run.begin);
    }
    let most = sizes.iter().copied().max().unwrap_or_default();
    let best = sizes.iter().position(|&size| size == most);
    roots
        .iter()
        .map(|&root| Some(root as usize) == best)
        .collect()
}

#[cfg(test)]
#[allow(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::*;

    /// A window of unit voxels, filled where told.
    fn filled(counts: [usize; 3], yes: impl Fn([usize; 3]) -> bool) -> Attached {
        let [n, m, d] = counts;
        let window = Window::new([0.0; 3], counts.map(|c| c as f64), 1.0, [None; 2]);
        assert_eq!(window.counts, counts);
        let all = (0..n * m * d).map(|v| [v / (m * d), v / d % m, v % d]);
        let fractions = all.map(|v| if yes(v) { UNIT } else { 0 }).collect();
        Attached::new(window, fractions, &vec![false; n * m])
    }

    #[test]
    fn the_largest_piece_is_what_shares_faces() {
        // A plate with a hole, a lump in it and one above, touching by an edge alone.
        let plate = |[i, j, k]: [usize; 3]| {
            (3..5).contains(&k) && !((2..7).contains(&i) && (2..7).contains(&j))
        };
        let lump = |[i, j, k]: [usize; 3]| i == 4 && j == 4 && (1..6).contains(&k);
        let above = |v: [usize; 3]| v == [1, 1, 5] || v == [0, 9, 6];
        let all = filled([10, 10, 8], |v| plate(v) || lump(v) || above(v));
        assert!(all.holds([0, 0, 3]) && all.holds([1, 1, 5]));
        assert!(!all.holds([4, 4, 3]) && !all.holds([0, 9, 6]) && !all.holds([3, 3, 3]));
        assert!(all.holds_near([0, 9, 5]) && !all.holds_near([4, 4, 3]));
        assert_eq!(all.open().count(), 25);
        assert_eq!(all.open_between(3.2, 3.4).count(), 25);
        assert_eq!(all.open_between(5.0, 6.0).count(), 99);
        assert!(all.is_open() && all.is_below([4, 4, 6]) && all.is_below([0, 0, 2]));
        assert!(!all.is_below([0, 0, 5]));
        let ends: Vec<_> = all.ends().collect();
        assert_eq!(ends[0], Some([3.0, 5.0]));
        assert_eq!(ends[11], Some([3.0, 6.0]));
        assert_eq!(ends[33], None);
    }

    /// A plate of twenty by twelve, drawn in by two at its left rim and cracked from there to a hole in its middle.
    #[test]
    fn a_rim_that_is_drawn_in_is_no_hole() {
        let was = |i: usize, j: usize| (4..24).contains(&i) && (4..16).contains(&j);
        let hole = |i: usize, j: usize| (12..17).contains(&i) && (7..12).contains(&j);
        let crack = |i: usize, j: usize| i < 12 && j == 9;
        let drawn = |i: usize, j: usize| i < 6 && (7..13).contains(&j);
        let window = Window::new([0.0; 3], [28.0, 20.0, 4.0], 1.0, [None; 2]);
        let fractions = (0..28 * 20 * 4).map(|v| {
            let (i, j, k) = (v / 80, v / 4 % 20, v % 4);
            let is = was(i, j) && !hole(i, j) && !crack(i, j) && !drawn(i, j);
            if is && (1..3).contains(&k) { UNIT } else { 0 }
        });
        let outside: Vec<bool> = (0..560).map(|c| !was(c / 20, c % 20)).collect();
        let all = Attached::new(window, fractions.collect(), &outside);
        assert!(all.is_open());
        let inside = all.open().largest_inside();
        // The hole with its crack, and nothing of the rim.
        assert_eq!(inside.count(), 25 + 6);
        assert_eq!(all.open().inside().largest_disc(), 25);
    }

    #[test]
    fn columns_with_gaps_are_parted() {
        // Two layers that hold together at their rim.
        let all = filled([6, 6, 9], |[i, j, k]| {
            (2..7).contains(&k)
                && !((1..5).contains(&i) && (1..5).contains(&j) && (4..6).contains(&k))
        });
        assert_eq!(all.parted().count(), 16);
        assert!(all.open().count() == 0 && !all.is_open());
    }

    #[test]
    fn an_empty_window_holds_nothing() {
        let none = filled([2, 2, 2], |_| false);
        assert!(!none.holds([0, 0, 0]) && none.ends().all(|ends| ends.is_none()));
    }
}
