//! All particles and images of a rank in canonical order.
//!
//! Owned, halo and mirror particles merge into one sorted sequence for each group of bodies.
//! Each receiver meets its neighbours in the order of (cell across, position along the column, id, image
//! mirror mask): a pure function of the images themselves, so it is the same on any ranks.

use std::ops::Range;

use rayon::prelude::*;

use super::columns::ColumnGrid;
use super::facts::{ACTIVE, IMAGE, ImageFacts, ImageState, MOVING};
use super::group::Group;
use super::longest::Longest;
use super::sort::{SCRATCH_WORDS, Sorter, Targets, Walls};
use crate::{Image, Inactive, MirrorMask, Scatter, resize};
use numerics::lanes::{LANES, Lanes};
use numerics::ordered::ordered;

/// The sorted images. Buffers are kept from step to step.
#[derive(Debug, Default)]
pub struct Sequence {
    groups: Vec<Group>,
    /// Beginning of each column and end of the last.
    starts: Vec<u32>,
    walls: Vec<Walls>,
    images: Vec<Image>,
    /// Sets of `MIRROR`, `HALO`, `MOVING` and `ACTIVE`.
    special: Vec<u8>,
    /// Coordinates and smoothing lengths (m) in order, for vectors that read past the end.
    coordinates: [Vec<f64>; 3],
    lengths: Vec<f64>,
    uniform: bool,
    /// By group: how long these are near a place; empty if they are uniform.
    longest: Vec<Longest>,
    /// Number of images that are no particles of this rank themselves.
    others: usize,
    /// Groups that have images, by the lower end of their boxes along x, and the longest of those along it (m).
    along_x: (Vec<u32>, f64),
    sorter: Sorter,
}

/// Eight images in a row.
pub(super) struct Eight<'a> {
    /// Coordinates (m).
    pub(super) coordinates: [&'a [f64; LANES]; 3],
    /// Smoothing lengths (m), whatever if they are uniform.
    pub(super) lengths: &'a [f64; LANES],
    /// Sets of `MIRROR`, `HALO`, `MOVING` and `ACTIVE`.
    pub(super) special: &'a [u8; LANES],
}

impl Sequence {
    /// Empty sequence with one grid for each group. If the smoothing lengths inside each group
    /// are `uniform`, the sequence does not keep them.
    #[must_use]
    pub fn new(grids: impl IntoIterator<Item = ColumnGrid>, uniform: bool) -> Self {
        let groups: Vec<_> = grids
            .into_iter()
            .map(|grid| Group {
                grid,
                lower: [0.0; 3],
                upper: [0.0; 3],
                first: [0; 2],
                last: [0; 2],
                size: [0; 2],
                columns: 0..0,
                images: 0..0,
            })
            .collect();
        let kept = if uniform { 0 } else { groups.len() };
        Self {
            groups,
            uniform,
            longest: (0..kept).map(|_| Longest::default()).collect(),
            ..Self::default()
        }
    }

    /// Words of scratch memory that [`Self::build`] needs for each image.
    pub const SCRATCH_WORDS: usize = SCRATCH_WORDS;

    /// Sorts those of the particles `0..owned` of the store that are active, and the images `others` (mirror images
    /// of these, and halo particles with theirs; the first `below` of them stand below the particles as far as
    /// one can tell, the rest above, which saves work). `facts` tells position, id and group of an
    /// image; `emit` is called once with each index of the sequence and the image that stands
    /// there, and tells its state. `scratch` is memory to work in: at least [`Self::SCRATCH_WORDS`] for each image.
    pub fn build(
        &mut self,
        scratch: &mut [u64],
        (owned, inactive): (usize, &Inactive),
        (others, below): (&[Image], usize),
        facts: impl Fn(Image) -> ImageFacts + Sync,
        emit: impl Fn(usize, Image) -> ImageState + Sync,
    ) {
        let active = inactive.count_active(owned);
        self.others = others.len();
        let count = active + others.len();
        let image = |k: usize| match k.checked_sub(below) {
            None => others[k],
            Some(own) if own < active => Image::new(inactive.nth_active(own), MirrorMask::OWN),
            Some(_) => others[k - active],
        };
        self.sorter.scatter(
            scratch,
            &mut self.groups,
            &mut self.starts,
            count,
            image,
            &facts,
        );
        resize(&mut self.images, count);
        resize(&mut self.special, count + LANES);
        let [x, y, z] = &mut self.coordinates;
        for values in [x, y, z] {
            resize(values, count + LANES);
        }
        let kept = if self.uniform { 0 } else { count + LANES };
        resize(&mut self.lengths, kept);
        self.walls.resize(self.starts.len() - 1, Walls::EMPTY);
        let targets = Targets {
            owned,
            images: Scatter::new(&mut self.images),
            special: Scatter::new(&mut self.special),
            coordinates: self.coordinates.each_mut().map(|x| Scatter::new(x)),
            lengths: (!self.uniform).then(|| Scatter::new(&mut self.lengths)),
        };
        for group in &mut self.groups {
            let index = |column: usize| self.starts[column] as usize;
            group.images = index(group.columns.start)..index(group.columns.end);
            let (starts, walls) = (&self.starts, &mut self.walls);
            Sorter::finish(
                (scratch, count),
                group,
                starts,
                walls,
                &targets,
                &facts,
                &emit,
            );
        }
        let (coordinates, lengths) = (&self.coordinates, &self.lengths);
        let groups = self.longest.par_iter_mut().zip(&self.groups);
        groups.for_each(|(longest, group)| {
            let corners = (&group.lower, &group.upper);
            longest.build(corners, group.images.clone(), coordinates, lengths);
        });
        self.sort_groups();
    }

    fn sort_groups(&mut self) {
        let Self {
            groups,
            along_x: (order, longest),
            ..
        } = self;
        order.clear();
        let filled = (0..)
            .zip(&*groups)
            .filter(|(_, group)| !group.images.is_empty());
        order.extend(filled.map(|(place, _)| place));
        let group = |place: &u32| &groups[*place as usize];
        order.sort_unstable_by(|a, b| group(a).lower[0].total_cmp(&group(b).lower[0]));
        let lengths = order
            .iter()
            .map(|place| group(place).upper[0] - group(place).lower[0]);
        *longest = lengths.fold(0.0, f64::max);
    }

    /// Lists, ascending, the groups of which images may be within a range (m) of a box between two corners (m).
    pub(super) fn list_groups_near(
        &self,
        (lower, upper): (&[f64; 3], &[f64; 3]),
        range: f64,
        near: &mut Vec<usize>,
    ) {
        let (order, longest) = &self.along_x;
        let group = |place: &u32| &self.groups[*place as usize];
        // Somewhat farther than any rounding.
        let farthest = (range + longest) * (1.0 + 1e-9);
        let first = order.partition_point(|place| group(place).lower[0] < lower[0] - farthest);
        near.clear();
        for place in &order[first..] {
            let other = group(place);
            if other.lower[0] > upper[0] + range {
                break;
            }
            let apart =
                |a: usize| lower[a] - range > other.upper[a] || other.lower[a] > upper[a] + range;
            if !(0..3).any(apart) {
                near.push(*place as usize);
            }
        }
        near.sort_unstable();
    }

    /// Eight coordinates on an axis (m) from a place on; what lies beyond the last image is
    /// whatever.
    ///
    /// # Panics
    /// If `index` is beyond the last image.
    #[inline(always)]
    #[must_use]
    pub fn coordinates(&self, axis: usize, index: usize) -> &[f64; LANES] {
        self.coordinates[axis][index..]
            .first_chunk()
            .expect("the arrays are padded")
    }

    /// The images of a range of places by eights; the last eight may go beyond the range.
    #[inline(always)]
    pub(super) fn eights<'a>(&'a self, indices: Range<usize>) -> impl Iterator<Item = Eight<'a>> {
        let padded = indices.start..indices.start + indices.len().next_multiple_of(LANES);
        let eights = |all: &'a [f64]| all[padded.clone()].as_chunks().0;
        let [x, y, z] = &self.coordinates;
        let lengths = if self.uniform { x } else { &self.lengths };
        let (x, y, z, h) = (eights(x), eights(y), eights(z), eights(lengths));
        let special = self.special[padded.clone()].as_chunks().0;
        let all = x.iter().zip(y).zip(z).zip(h).zip(special);
        all.map(|((((x, y), z), lengths), special)| Eight {
            coordinates: [x, y, z],
            lengths,
            special,
        })
    }

    /// True if any of eight places from one on holds an image or a halo particle; those beyond
    /// the last image may say so too.
    ///
    /// # Panics
    /// If `index` is beyond the last image.
    #[inline(always)]
    #[must_use]
    pub fn any_images(&self, index: usize) -> bool {
        let eight = *self.special[index..]
            .first_chunk()
            .expect("the array is padded");
        u64::from_le_bytes(eight) & u64::from_le_bytes([IMAGE; LANES]) != 0
    }

    /// True if the image at an index rests, at the velocity common to its group.
    #[inline(always)]
    pub(super) fn rests(&self, index: usize) -> bool {
        self.special[index] & (MOVING | ACTIVE) == 0
    }

    /// True if the image at an index is a particle of this rank itself.
    #[inline(always)]
    pub(super) fn is_owned(&self, index: usize) -> bool {
        self.special[index] & IMAGE == 0
    }

    /// The images in canonical order, group after group.
    #[must_use]
    pub fn images(&self) -> &[Image] {
        &self.images
    }

    /// Smoothing lengths (m) in order; empty if they are uniform.
    #[must_use]
    pub fn smoothing_lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// For each place a byte that is odd for images behind symmetry planes.
    #[must_use]
    pub fn mirrored(&self) -> &[u8] {
        &self.special
    }

    /// True if all are particles of this rank themselves.
    #[must_use]
    pub fn is_alone(&self) -> bool {
        self.others == 0
    }

    /// Number of groups.
    #[must_use]
    pub fn groups(&self) -> usize {
        self.groups.len()
    }

    /// How far (m) a search among the images of a group has to look around a box (m); `reach` tells how far it finds an image by
    /// its smoothing length, and `all` where these are uniform; `own` is the length of what searches.
    #[inline(always)]
    pub(super) fn reach(
        &self,
        group: usize,
        corners: (&[f64; 3], &[f64; 3]),
        (own, all): (f64, f64),
        reach: impl Fn(f64) -> f64,
    ) -> f64 {
        match self.longest.get(group) {
            Some(longest) => longest.reach(corners, own, reach),
            None => all,
        }
    }

    /// The indices of a group's images in [`Self::images`].
    #[must_use]
    pub fn group(&self, group: usize) -> Range<usize> {
        self.groups[group].images.clone()
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        4 * (self.starts.capacity() + self.images.capacity())
            + self.special.capacity()
            + 24 * self.coordinates[0].capacity()
            + 8 * self.lengths.capacity()
            + 32 * self.walls.capacity()
            + 4 * self.along_x.0.capacity()
            + self.longest.iter().map(Longest::memory).sum::<usize>()
            + self.sorter.memory()
    }

    /// Calls `visit` with those parts of `places` that stand in one column each.
    pub(super) fn for_each_segment(
        &self,
        indices: Range<usize>,
        mut visit: impl FnMut(Range<usize>),
    ) {
        let mut at = indices.start;
        let mut column = self.starts.partition_point(|&start| start as usize <= at);
        while at < indices.end {
            let end = (self.starts[column] as usize).min(indices.end);
            if end > at {
                visit(at..end);
            }
            at = end;
            column += 1;
        }
    }

    /// The columns of a group, in canonical order of the cells, that have images within `range` (m) of the box
    /// `lower..=upper` (m) as far as the directions across tell.
    #[inline(always)]
    pub(super) fn columns_near(
        &self,
        group: usize,
        lower: &[f64; 3],
        upper: &[f64; 3],
        range: f64,
    ) -> ColumnsNear<'_> {
        let group = &self.groups[group];
        let grid = &group.grid;
        let apart =
            |a: usize| lower[a] - range > group.upper[a] || group.lower[a] > upper[a] + range;
        let is_apart = group.images.is_empty() || (0..3).any(apart);
        // No column twice: no range is longer than a period.
        let cells = |k: usize| {
            let axis = grid.across[k];
            let low = grid.cell(k, lower[axis] - range).max(group.first[k]);
            let high = grid.cell(k, upper[axis] + range).min(group.last[k]);
            low..high
                .min(low.saturating_add(grid.period(k) - 1))
                .saturating_add(1)
        };
        let [a, b] = grid.across;
        let rows = if is_apart { 0..0 } else { cells(0) };
        ColumnsNear {
            sequence: self,
            group,
            across: [[lower[a], lower[b]], [upper[a], upper[b]]],
            square: range * range,
            rows,
            row: 0,
            of_row: if is_apart { 0..0 } else { cells(1) },
            left: 0..0,
        }
    }

    /// Calls `visit`, in canonical order, with the place of each image of a group that is nearer than
    /// `range` (m) to a point (m), and the square of its distance (m²).
    pub fn near_point(
        &self,
        group: usize,
        point: &[f64; 3],
        range: f64,
        mut visit: impl FnMut(usize, f64),
    ) {
        let along = self.along(group);
        for (_, column) in self.columns_near(group, point, point, range) {
            let x = &self.coordinates[along][column.clone()];
            let first = x.partition_point(|&x| x < point[along] - range);
            for index in column.start + first..column.end {
                if self.coordinates[along][index] > point[along] + range {
                    break;
                }
                let apart = |a: usize| self.coordinates[a][index] - point[a];
                let [x, y, z] = [apart(0), apart(1), apart(2)];
                let square = x * x + y * y + z * z;
                if square < range * range {
                    visit(index, square);
                }
            }
        }
    }

    /// The position of an image (m).
    #[inline]
    #[must_use]
    pub fn position(&self, index: usize) -> [f64; 3] {
        [0, 1, 2].map(|a| self.coordinates[a][index])
    }

    /// Key of the canonical order of a group before ids and image mirror masks: the column of an
    /// image, and its position along that.
    #[must_use]
    pub fn rank_in_order(&self, group: usize, index: usize) -> [u64; 2] {
        self.order_of(group, &self.position(index))
    }

    /// The same of a position (m).
    pub(super) fn order_of(&self, group: usize, position: &[f64; 3]) -> [u64; 2] {
        let grid = &self.groups[group].grid;
        let [first, second] = grid.cells(position).map(u64::from);
        [first << 32 | second, ordered(position[grid.along])]
    }

    /// First place of a column whose position along it is not below `from` (m). `hint` is a place
    /// of that column or anything.
    #[inline(always)]
    pub(super) fn seek<V: Lanes>(
        &self,
        group: usize,
        column: &Range<usize>,
        from: f64,
        hint: usize,
    ) -> usize {
        let along = &self.coordinates[self.groups[group].grid.along];
        let good = column.contains(&hint) && (hint == column.start || along[hint - 1] < from);
        let mut at = if good {
            hint
        } else {
            column.start + along[column.clone()].partition_point(|&x| x < from)
        };
        while at < column.end {
            let eight = along[at..].first_chunk().expect("the array is padded");
            let below = V::read(eight).less_than(V::splat(from)).trailing_ones() as usize;
            at += below;
            if below < LANES {
                break;
            }
        }
        at.min(column.end)
    }

    /// Axis along the columns of a group.
    #[inline(always)]
    pub(super) fn along(&self, group: usize) -> usize {
        self.groups[group].grid.along
    }
}

/// Columns near a box: an iterator and no closure, which may be compiled apart from its caller, without its instructions.
pub(super) struct ColumnsNear<'a> {
    sequence: &'a Sequence,
    group: &'a Group,
    /// The lower and the upper corner of the box across the columns (m).
    across: [[f64; 2]; 2],
    /// Square of the range (m²).
    square: f64,
    /// Cells along the first axis that are left, and the place of the last one.
    rows: Range<u32>,
    row: usize,
    /// Cells along the second axis: all of a row, and those that are left of this one.
    of_row: Range<u32>,
    left: Range<u32>,
}

impl Iterator for ColumnsNear<'_> {
    /// Two indices across, and the indices of the column.
    type Item = ([usize; 2], Range<usize>);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        let (group, starts) = (self.group, &self.sequence.starts);
        loop {
            let Some(cell) = self.left.next() else {
                let cell = self.rows.next()?;
                self.row = group.grid.after(0, group.first[0], cell);
                self.left = self.of_row.clone();
                continue;
            };
            let place = group.grid.after(1, group.first[1], cell);
            let column = group.columns.start + self.row * group.size[1] + place;
            let (start, end) = (starts[column] as usize, starts[column + 1] as usize);
            let [lower, upper] = self.across;
            let gap = self.sequence.walls[column].gap(lower, upper);
            if start < end && gap < self.square {
                return Some(([self.row, place], start..end));
            }
        }
    }
}
