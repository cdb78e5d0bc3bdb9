//! How long smoothing lengths are near a place: where a body's particles are unequal, its longest one would make every
//! search as wide as the coarsest.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

/// A coarse grid over a group's images, which knows the longest smoothing length in each cell. Cells come again after a number of
/// them along each axis, so that what flies far away takes no more of them: then a cell knows the longest one of several places.
#[derive(Debug, Default)]
pub(super) struct Longest {
    inverse_width: f64,
    /// Cells along each axis, after which they come again: powers of two.
    size: [usize; 3],
    /// Bits of lengths (m), which order as these do.
    cells: Vec<AtomicU64>,
    /// The longest of all (m).
    of_all: f64,
}

/// Images that a task looks at.
const SHARE: usize = 4096;
/// Images for each cell, at least.
const IMAGES_PER_CELL: usize = 2;
/// Cells along an axis, at most.
const MOST: f64 = 65536.0;
/// The cell in which coordinates begin.
const MIDDLE: f64 = 1_099_511_627_776.0;
/// Nothing is gained by what searches with a length of this share of the longest of all, or more.
const ALIKE: f64 = 0.8;

impl Longest {
    /// Takes in the images at some `indices`, in a box between two corners (m), of these coordinates and smoothing lengths (m).
    pub(super) fn build(
        &mut self,
        (lower, upper): (&[f64; 3], &[f64; 3]),
        indices: Range<usize>,
        coordinates: &[Vec<f64>; 3],
        lengths: &[f64],
    ) {
        let of_group = &lengths[indices.clone()];
        let tasks = of_group.par_iter().with_min_len(SHARE).copied();
        // same bits in any order: a largest number
        self.of_all = tasks.reduce(|| 0.0, f64::max);
        self.lay_out(lower, upper, indices.len());
        let Self { cells, .. } = &mut *self;
        for longest in cells {
            *longest.get_mut() = 0;
        }
        let grid = &*self;
        let starts = indices.clone().into_par_iter().step_by(SHARE);
        starts.for_each(|start| {
            let (mut cell, mut longest) = (0, 0.0);
            for index in start..indices.end.min(start + SHARE) {
                let at = grid.at(&[0, 1, 2].map(|a| coordinates[a][index]));
                if at != cell {
                    grid.widen(cell, longest);
                    (cell, longest) = (at, 0.0);
                }
                longest = f64::max(longest, lengths[index]);
            }
            grid.widen(cell, longest);
        });
    }

    /// Cells as wide as the longest support, which fill the box, or fewer where those were too many.
    fn lay_out(&mut self, lower: &[f64; 3], upper: &[f64; 3], images: usize) {
        self.inverse_width = 1.0 / (2.0 * self.of_all);
        let most = (images / IMAGES_PER_CELL).max(1);
        self.size = [0, 1, 2].map(|a| {
            let cells = (upper[a] - lower[a]) * self.inverse_width + 1.0;
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "casts saturate"
            )]
            (cells.min(MOST) as usize).max(1).next_power_of_two()
        });
        while self.size.iter().product::<usize>() > most {
            let largest = self.size.iter().copied().fold(0, usize::max);
            let place = self.size.iter().position(|&size| size == largest);
            self.size[place.unwrap_or_default()] /= 2;
        }
        let count = self.size.iter().product();
        self.cells.resize_with(count, AtomicU64::default);
    }

    #[inline(always)]
    fn widen(&self, cell: usize, length: f64) {
        self.cells[cell].fetch_max(length.to_bits(), Relaxed);
    }

    /// Cell that holds a coordinate (m), of an axis without end; it never falls with that.
    #[inline(always)]
    fn along(&self, x: f64) -> u64 {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "casts saturate"
        )]
        {
            (x * self.inverse_width + MIDDLE) as u64
        }
    }

    /// Place along an axis of such a cell.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "cells come again")]
    fn place(&self, axis: usize, cell: u64) -> usize {
        cell as usize & (self.size[axis] - 1)
    }

    #[inline(always)]
    fn at(&self, position: &[f64; 3]) -> usize {
        let [x, y, z] = [0, 1, 2].map(|a| self.place(a, self.along(position[a])));
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// How far (m) a search around a box (m) has to look, where images of the smoothing length h are found within `reach(h)` of it,
    /// which never falls with h; `own` is the length of what searches.
    #[inline(always)]
    pub(super) fn reach(
        &self,
        (lower, upper): (&[f64; 3], &[f64; 3]),
        own: f64,
        reach: impl Fn(f64) -> f64,
    ) -> f64 {
        let mut far = reach(self.of_all);
        if own >= ALIKE * self.of_all {
            return far;
        }
        // The second look goes no farther than the first has shown to be enough.
        for _ in 0..2 {
            far = reach(self.near(lower, upper, far));
        }
        far
    }

    /// The longest smoothing length (m) within a distance (m) of a box, or of somewhat more.
    #[inline(always)]
    fn near(&self, lower: &[f64; 3], upper: &[f64; 3], far: f64) -> f64 {
        let first = [0, 1, 2].map(|a| self.along(lower[a] - far));
        let count = [0, 1, 2].map(|a| {
            let beyond = self.along(upper[a] + far).saturating_sub(first[a]);
            beyond.min(self.size[a] as u64 - 1) + 1
        });
        let mut longest = 0;
        for k in 0..count[2] {
            let z = self.place(2, first[2].wrapping_add(k));
            for k in 0..count[1] {
                let y = self.place(1, first[1].wrapping_add(k));
                let row = (z * self.size[1] + y) * self.size[0];
                for k in 0..count[0] {
                    let cell = &self.cells[row + self.place(0, first[0].wrapping_add(k))];
                    longest = longest.max(cell.load(Relaxed));
                }
            }
        }
        f64::from_bits(longest)
    }

    /// Bytes allocated.
    pub(super) fn memory(&self) -> usize {
        size_of::<AtomicU64>() * self.cells.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row along x of images whose lengths double from one end to the other.
    fn row(count: usize) -> (Longest, [Vec<f64>; 3], Vec<f64>) {
        #[allow(clippy::cast_precision_loss, reason = "few")]
        let share = |k: usize| k as f64 / count as f64;
        let x: Vec<f64> = (0..count).map(|k| 100.0 * share(k)).collect();
        let lengths: Vec<f64> = (0..count).map(|k| 1.0 + 3.0 * share(k)).collect();
        let coordinates = [x, vec![0.0; count], vec![0.0; count]];
        let mut longest = Longest::default();
        let corners = (&[0.0; 3], &[100.0, 0.0, 0.0]);
        longest.build(corners, 0..count, &coordinates, &lengths);
        (longest, coordinates, lengths)
    }

    #[test]
    fn a_search_reaches_all_that_reaches_it_and_little_more() {
        let (longest, [x, ..], lengths) = row(10_000);
        for at in [0.0, 20.0, 50.0, 90.0] {
            let own = 1.0 + 0.03 * at;
            let point = [at, 0.0, 0.0];
            let far = longest.reach((&point, &point), own, |h| own + h);
            let within = |k: &usize| (x[*k] - at).abs() < own + lengths[*k];
            let needed = (0..x.len()).filter(within);
            let needed = needed.map(|k| (x[k] - at).abs()).fold(0.0, f64::max);
            assert!(far >= needed, "{far} {needed}");
            assert!(far <= (1.25 * needed).max(needed + 0.6), "{far} {needed}");
        }
    }

    #[test]
    fn boxes_that_are_none_and_numbers_that_are_none_find_an_end() {
        let mut longest = Longest::default();
        let corners = (&[f64::INFINITY; 3], &[f64::NEG_INFINITY; 3]);
        longest.build(corners, 0..0, &[vec![], vec![], vec![]], &[]);
        let point = [0.0; 3];
        assert!(
            longest
                .reach((&point, &point), 1.0, |h| 1.0 + h)
                .is_finite()
        );
        let coordinates = [[f64::NAN, 1.0], [0.0, f64::INFINITY], [0.0; 2]].map(Vec::from);
        let corners = (&[1.0, 0.0, 0.0], &[1.0, f64::INFINITY, 0.0]);
        longest.build(corners, 0..2, &coordinates, &[1.0, 2.0]);
        assert_eq!(longest.reach((&point, &point), 1.0, |h| 1.0 + h), 3.0);
    }
}
