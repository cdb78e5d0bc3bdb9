//! All particles and images of a rank in canonical order.
//!
//! Owned, halo and mirror particles merge into one sorted sequence for each group of bodies.
//! The order is that of (column, position along the column, id, image code): a pure function of
//! the images themselves, so each receiver meets its neighbours in the same order on any ranks.

use std::cmp::Ordering;
use std::ops::Range;

use rayon::prelude::*;

use super::columns::ColumnGrid;
use crate::sph::lanes::LANES;

/// A particle or one of its mirror images: index in the store and the planes it is behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Image(u32);

impl Image {
    /// Largest number of particles of a rank.
    pub const MAX_PARTICLES: usize = 1 << 29;

    /// Image of particle `base` behind the planes whose axis bits are set in `code`.
    #[inline]
    #[must_use]
    pub fn new(base: usize, code: u8) -> Self {
        debug_assert!(base < Self::MAX_PARTICLES && code < 8);
        #[allow(
            clippy::cast_possible_truncation,
            reason = "checked when particles are counted"
        )]
        Self(base as u32 | u32::from(code) << 29)
    }

    /// Index in the store.
    #[inline]
    #[must_use]
    pub fn base(self) -> usize {
        self.0 as usize & (Self::MAX_PARTICLES - 1)
    }

    /// Bit a set: behind the symmetry plane normal to axis a.
    #[inline]
    #[must_use]
    pub fn code(self) -> u8 {
        (self.0 >> 29) as u8
    }
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    along: f64,
    id: u64,
    image: Image,
}

impl Entry {
    fn order(&self, other: &Self) -> Ordering {
        self.along
            .total_cmp(&other.along)
            .then(self.id.cmp(&other.id))
            .then(self.image.code().cmp(&other.image.code()))
    }
}

/// One group's part of the sequence: its columns among those that this rank meets.
#[derive(Debug, Clone)]
struct Group {
    grid: ColumnGrid,
    /// First column across and number of columns across of the window in use.
    first: [u32; 2],
    size: [usize; 2],
    /// Where the window's columns begin in `Sequence::starts`.
    columns: usize,
    images: Range<usize>,
}

/// What the sequence needs to know of one image.
#[derive(Debug, Clone, Copy)]
pub struct ImageFacts {
    /// Its own position (m), mirrored where it is an image.
    pub position: [f64; 3],
    /// Identity of the particle.
    pub id: u64,
    /// Group of bodies.
    pub group: usize,
    /// Smoothing length (m).
    pub smoothing_length: f64,
}

/// The sorted images. Buffers are kept from step to step.
#[derive(Debug, Clone, Default)]
pub struct Sequence {
    groups: Vec<Group>,
    starts: Vec<u32>,
    cursors: Vec<u32>,
    columns: Vec<(u32, [u32; 2])>,
    entries: Vec<Entry>,
    images: Vec<Image>,
    /// Coordinates and smoothing lengths (m) in order, for vectors that read past the end.
    coordinates: [Vec<f64>; 3],
    lengths: Vec<f64>,
}

impl Sequence {
    /// Empty sequence with one grid for each group.
    #[must_use]
    pub fn new(grids: impl IntoIterator<Item = ColumnGrid>) -> Self {
        let groups = grids
            .into_iter()
            .map(|grid| Group {
                grid,
                first: [0; 2],
                size: [0; 2],
                columns: 0,
                images: 0..0,
            })
            .collect();
        Self {
            groups,
            ..Self::default()
        }
    }

    /// Sorts `images`, of which `facts` tells position, id and group.
    pub fn build(&mut self, images: &[Image], facts: impl Fn(Image) -> ImageFacts + Sync) {
        self.find_columns(images, &facts);
        self.lay_out_columns();
        self.fill(images, &facts);
        sort_columns(&mut self.entries, &self.starts, 0);
        self.images.resize(images.len(), Image::new(0, 0));
        let padded = images.len() + LANES;
        let [x, y, z] = &mut self.coordinates;
        for values in [x, y, z, &mut self.lengths] {
            values.resize(padded, 0.0);
        }
        let [x, y, z] = &mut self.coordinates;
        (&mut self.images, &self.entries, x, y, z, &mut self.lengths)
            .into_par_iter()
            .with_min_len(1024)
            .for_each(|(image, entry, x, y, z, length)| {
                let facts = facts(entry.image);
                *image = entry.image;
                [*x, *y, *z] = facts.position;
                *length = facts.smoothing_length;
            });
    }

    /// Eight coordinates on an axis (m) from a place on; what lies beyond the last image is
    /// whatever.
    ///
    /// # Panics
    /// If `place` is beyond the last image.
    #[inline(always)]
    #[must_use]
    pub fn coordinates(&self, axis: usize, place: usize) -> &[f64; LANES] {
        self.coordinates[axis][place..]
            .first_chunk()
            .expect("the arrays are padded")
    }

    /// Eight smoothing lengths (m) from a place on.
    ///
    /// # Panics
    /// If `place` is beyond the last image.
    #[inline(always)]
    #[must_use]
    pub fn lengths(&self, place: usize) -> &[f64; LANES] {
        self.lengths[place..]
            .first_chunk()
            .expect("the arrays are padded")
    }

    fn find_columns(&mut self, images: &[Image], facts: &(impl Fn(Image) -> ImageFacts + Sync)) {
        let groups = &self.groups;
        self.columns.resize(images.len(), (0, [0; 2]));
        self.columns
            .par_iter_mut()
            .zip(images)
            .with_min_len(1024)
            .for_each(|(slot, &image)| {
                let facts = facts(image);
                #[allow(clippy::cast_possible_truncation, reason = "few groups")]
                {
                    *slot = (
                        facts.group as u32,
                        groups[facts.group].grid.column(&facts.position),
                    );
                }
            });
    }

    /// Windows of columns by group, and where each column begins.
    fn lay_out_columns(&mut self) {
        for group in &mut self.groups {
            group.first = [u32::MAX; 2];
            group.size = [0; 2];
        }
        for &(group, column) in &self.columns {
            let group = &mut self.groups[group as usize];
            for k in 0..2 {
                group.first[k] = group.first[k].min(column[k]);
                group.size[k] = group.size[k].max(column[k] as usize + 1);
            }
        }
        let mut columns = 0;
        for group in &mut self.groups {
            for k in 0..2 {
                group.size[k] = group.size[k].saturating_sub(group.first[k] as usize);
            }
            group.columns = columns;
            columns += group.size[0] * group.size[1];
        }
        self.starts.clear();
        self.starts.resize(columns + 1, 0);
        for &(group, column) in &self.columns {
            let at = self.groups[group as usize].place(column);
            self.starts[at + 1] += 1;
        }
        for at in 0..columns {
            self.starts[at + 1] += self.starts[at];
        }
        for group in &mut self.groups {
            let end = group.columns + group.size[0] * group.size[1];
            group.images = self.starts[group.columns] as usize..self.starts[end] as usize;
        }
    }

    fn fill(&mut self, images: &[Image], facts: &(impl Fn(Image) -> ImageFacts + Sync)) {
        let nothing = Entry {
            along: 0.0,
            id: 0,
            image: Image::new(0, 0),
        };
        self.entries.resize(images.len(), nothing);
        self.cursors.clone_from(&self.starts);
        for (&image, &(group, column)) in images.iter().zip(&self.columns) {
            let group = &self.groups[group as usize];
            let cursor = &mut self.cursors[group.place(column)];
            self.entries[*cursor as usize].image = image;
            *cursor += 1;
        }
        let groups = &self.groups;
        self.entries
            .par_iter_mut()
            .with_min_len(1024)
            .for_each(|entry| {
                let facts = facts(entry.image);
                entry.along = facts.position[groups[facts.group].grid.along];
                entry.id = facts.id;
            });
    }

    /// The images in canonical order, group after group.
    #[must_use]
    pub fn images(&self) -> &[Image] {
        &self.images
    }

    /// Number of groups.
    #[must_use]
    pub fn groups(&self) -> usize {
        self.groups.len()
    }

    /// The places of a group's images in [`Self::images`].
    #[must_use]
    pub fn group(&self, group: usize) -> Range<usize> {
        self.groups[group].images.clone()
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        4 * (self.starts.capacity() + self.cursors.capacity() + self.images.capacity())
            + 12 * self.columns.capacity()
            + size_of::<Entry>() * self.entries.capacity()
            + 32 * self.lengths.capacity()
    }

    /// Calls `visit` with ranges of places, in canonical order, that hold every image of a group
    /// whose position lies in the box `lower..=upper` (m), and few others.
    #[inline(always)]
    pub fn in_box(
        &self,
        group: usize,
        lower: &[f64; 3],
        upper: &[f64; 3],
        mut visit: impl FnMut(Range<usize>),
    ) {
        let group = &self.groups[group];
        if group.images.is_empty() {
            return;
        }
        let grid = &group.grid;
        let range = |k: usize| {
            let axis = grid.across[k];
            let low = grid.index(k, lower[axis]).max(group.first[k]) - group.first[k];
            let high = grid.index(k, upper[axis]);
            let end = if high < group.first[k] {
                0
            } else {
                ((high - group.first[k]) as usize + 1).min(group.size[k])
            };
            low as usize..end
        };
        let along = &self.coordinates[grid.along];
        let (from, to) = (lower[grid.along], upper[grid.along]);
        let second = range(1);
        for first in range(0) {
            for other in second.clone() {
                let column = group.columns + first * group.size[1] + other;
                let (start, end) = (
                    self.starts[column] as usize,
                    self.starts[column + 1] as usize,
                );
                let column = &along[start..end];
                let first = column.partition_point(|&x| x < from);
                let mut last = first;
                while last < column.len() && column[last] <= to {
                    last += LANES;
                }
                if last > first {
                    visit(start + first..start + last.min(column.len()));
                }
            }
        }
    }
}

impl Group {
    fn place(&self, column: [u32; 2]) -> usize {
        self.columns
            + (column[0] - self.first[0]) as usize * self.size[1]
            + (column[1] - self.first[1]) as usize
    }
}

/// Sorts each column, halving the work among threads. `starts` are the beginnings of the columns
/// of `entries`, counted from `offset`, and the end of the last.
fn sort_columns(entries: &mut [Entry], starts: &[u32], offset: usize) {
    let columns = starts.len() - 1;
    if columns == 0 {
        return;
    }
    if columns == 1 || entries.len() < 4096 {
        for pair in starts.windows(2) {
            entries[pair[0] as usize - offset..pair[1] as usize - offset]
                .sort_unstable_by(Entry::order);
        }
        return;
    }
    let middle = columns / 2;
    let split = starts[middle] as usize;
    let (left, right) = entries.split_at_mut(split - offset);
    rayon::join(
        || sort_columns(left, &starts[..=middle], offset),
        || sort_columns(right, &starts[middle..], split),
    );
}
