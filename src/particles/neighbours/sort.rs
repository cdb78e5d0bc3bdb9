//! The sort behind the sequence: a counting sort into columns, then each column by itself.
//!
//! Every task counts, scatters and finishes its own share. Before the columns are sorted their
//! order depends on the tasks; afterwards it does not, since no two keys are equal.

use std::cmp::Ordering;

use rayon::prelude::*;

use super::cursors::Cursors;
use super::facts::{HALO, ImageFacts, ImageState, MIRROR};
use super::group::{Group, lay_out};
use crate::{Image, Scatter};

/// Entry of an image in the sort inside its column.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Entry {
    /// Orders as the position along the column does.
    along: i64,
    id: u64,
    image: Image,
    padding: u32,
}

/// Group of an image and the last bits of its cell, which tell its column.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Column {
    group: u32,
    across: [u16; 2],
}

/// Words of scratch memory that the sort takes for each image.
pub(super) const SCRATCH_WORDS: usize = (size_of::<Entry>() + size_of::<Column>()) / 8;

impl Entry {
    fn new(image: Image, along: f64, id: u64) -> Self {
        // The total order of doubles, as integers.
        let bits = along.to_bits().cast_signed();
        let along = bits ^ (((bits >> 63).cast_unsigned()) >> 1).cast_signed();
        Self {
            along,
            id,
            image,
            padding: 0,
        }
    }

    #[inline(always)]
    fn order(&self, other: &Self) -> Ordering {
        self.along
            .cmp(&other.along)
            .then_with(|| self.id.cmp(&other.id))
            .then_with(|| self.image.mirror_mask().cmp(&other.image.mirror_mask()))
    }

    #[inline(always)]
    fn precedes(&self, other: &Self) -> bool {
        self.order(other) == Ordering::Less
    }
}

/// Rectangle around the images of a column in the two directions across (m).
#[derive(Debug, Clone, Copy)]
pub(super) struct Walls {
    lower: [f64; 2],
    upper: [f64; 2],
}

impl Walls {
    pub(super) const EMPTY: Self = Self {
        lower: [f64::INFINITY; 2],
        upper: [f64::NEG_INFINITY; 2],
    };

    #[inline(always)]
    fn include(&mut self, x: [f64; 2]) {
        for k in 0..2 {
            self.lower[k] = self.lower[k].min(x[k]);
            self.upper[k] = self.upper[k].max(x[k]);
        }
    }

    /// Square of the distance to another rectangle (m²).
    #[inline(always)]
    pub(super) fn gap(&self, lower: [f64; 2], upper: [f64; 2]) -> f64 {
        let along = |k: usize| {
            (lower[k] - self.upper[k])
                .max(self.lower[k] - upper[k])
                .max(0.0)
        };
        let gaps = [along(0), along(1)];
        gaps[0] * gaps[0] + gaps[1] * gaps[1]
    }
}

/// Box around the images of one group that one task has seen (m).
#[derive(Debug, Clone, Copy)]
struct Extent {
    lower: [f64; 3],
    upper: [f64; 3],
}

impl Extent {
    const EMPTY: Self = Self {
        lower: [f64::INFINITY; 3],
        upper: [f64::NEG_INFINITY; 3],
    };

    #[inline(always)]
    fn include(&mut self, lower: &[f64; 3], upper: &[f64; 3]) {
        for a in 0..3 {
            self.lower[a] = self.lower[a].min(lower[a]);
            self.upper[a] = self.upper[a].max(upper[a]);
        }
    }
}

/// Buffers of the sort, kept from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Sorter {
    extents: Vec<Extent>,
    cursors: Cursors,
}

/// Places that a task finishes at least.
const GRAIN: usize = 2048;

impl Sorter {
    pub(super) fn memory(&self) -> usize {
        size_of::<Extent>() * self.extents.capacity() + self.cursors.memory()
    }

    /// Scatters `count` images into columns, in the first three of four parts of `scratch`; sets
    /// the groups' windows and the beginnings of all columns.
    pub(super) fn scatter(
        &mut self,
        scratch: &mut [u64],
        groups: &mut [Group],
        starts: &mut Vec<u32>,
        count: usize,
        image: impl Fn(usize) -> Image + Sync,
        facts: &(impl Fn(Image) -> ImageFacts + Sync),
    ) {
        let (entries, columns_of) = split(scratch, count);
        self.find_columns(columns_of, groups, &image, facts);
        let columns = lay_out(groups);
        // Counters must not outweigh what they count.
        let tasks = (4 * count / columns).clamp(1, rayon::current_num_threads());
        let share = count.div_ceil(tasks).max(1);
        self.cursors.reset(columns, tasks);
        let groups: &[Group] = groups;
        let index =
            |column: &Column| groups[column.group as usize].index(column.across.map(u32::from));
        self.cursors
            .tasks()
            .zip(columns_of.par_chunks(share))
            .for_each(|(counts, mine)| {
                for column in mine {
                    counts[index(column)] += 1;
                }
            });
        self.cursors.lay_out(starts);
        let entries = Scatter::new(entries);
        self.cursors
            .tasks()
            .zip(columns_of.par_chunks(share))
            .enumerate()
            .for_each(|(task, (cursors, mine))| {
                for (k, column) in mine.iter().enumerate() {
                    let image = image(task * share + k);
                    let facts = facts(image);
                    let along = facts.position[groups[facts.group].grid.along];
                    let cursor = &mut cursors[index(column)];
                    // SAFETY: the counts give every image a slot of its own.
                    unsafe {
                        *entries.slot(*cursor as usize) = Entry::new(image, along, facts.id);
                    }
                    *cursor += 1;
                }
            });
    }

    /// Column of every image, and the box of every group.
    fn find_columns(
        &mut self,
        columns: &mut [Column],
        groups: &mut [Group],
        image: &(impl Fn(usize) -> Image + Sync),
        facts: &(impl Fn(Image) -> ImageFacts + Sync),
    ) {
        let tasks = rayon::current_num_threads();
        let share = columns.len().div_ceil(tasks).max(1);
        self.extents.clear();
        self.extents.resize(tasks * groups.len(), Extent::EMPTY);
        let grids: &[Group] = groups;
        let known = grids.len().max(1);
        columns
            .par_chunks_mut(share)
            .zip(self.extents.par_chunks_mut(known))
            .enumerate()
            .for_each(|(task, (columns, extents))| {
                // Extents go to memory, where other tasks' stand next to them, as rarely as can be.
                let (mut group, mut extent) = (0, Extent::EMPTY);
                for (k, slot) in columns.iter_mut().enumerate() {
                    let facts = facts(image(task * share + k));
                    if facts.group != group {
                        extents[group].include(&extent.lower, &extent.upper);
                        (group, extent) = (facts.group, Extent::EMPTY);
                    }
                    extent.include(&facts.position, &facts.position);
                    let cells = grids[facts.group].grid.cells(&facts.position);
                    #[allow(clippy::cast_possible_truncation, reason = "few groups, short periods")]
                    {
                        *slot = Column {
                            group: facts.group as u32,
                            across: cells.map(|cell| cell as u16),
                        };
                    }
                }
                extents[group].include(&extent.lower, &extent.upper);
            });
        for (g, group) in groups.iter_mut().enumerate() {
            let mut all = Extent::EMPTY;
            for extent in self.extents.iter().skip(g).step_by(known) {
                all.include(&extent.lower, &extent.upper);
            }
            (group.lower, group.upper) = (all.lower, all.upper);
        }
    }

    /// Sorts the columns of one group, writes what stands where into `targets`, and calls `emit`
    /// for each place and its image.
    pub(super) fn finish(
        (scratch, count): (&mut [u64], usize),
        group: &Group,
        starts: &[u32],
        walls: &mut [Walls],
        targets: &Targets,
        facts: &(impl Fn(Image) -> ImageFacts + Sync),
        emit: &(impl Fn(usize, Image) -> ImageState + Sync),
    ) {
        let [a, b] = group.grid.across;
        let finish = |first: usize, entries: &mut [Entry], walls: &mut Walls| {
            sort_column(entries);
            *walls = Walls::EMPTY;
            for (k, entry) in entries.iter().enumerate() {
                let facts = facts(entry.image);
                walls.include([facts.position[a], facts.position[b]]);
                let state = emit(first + k, entry.image);
                targets.write(first + k, entry.image, &facts, state);
            }
        };
        let indices = group.images.clone();
        let columns = group.columns.clone();
        halve(
            &starts[columns.start..=columns.end],
            &mut split(scratch, count).0[indices],
            &mut walls[columns],
            &finish,
        );
    }
}

/// Scratch memory as an entry for each image, then a column for each image.
fn split(scratch: &mut [u64], count: usize) -> (&mut [Entry], &mut [Column]) {
    let (entries, columns) = scratch.split_at_mut(size_of::<Entry>() / 8 * count);
    let columns = &mut columns[..size_of::<Column>() / 8 * count];
    (
        bytemuck::cast_slice_mut(entries),
        bytemuck::cast_slice_mut(columns),
    )
}

/// Arrays in the order of the sequence; each place is written once.
pub(super) struct Targets<'a> {
    pub(super) owned: usize,
    pub(super) images: Scatter<'a, Image>,
    pub(super) special: Scatter<'a, u8>,
    pub(super) coordinates: [Scatter<'a, f64>; 3],
    pub(super) lengths: Option<Scatter<'a, f64>>,
}

impl Targets<'_> {
    #[inline(always)]
    fn write(&self, index: usize, image: Image, facts: &ImageFacts, state: ImageState) {
        let mirror = if image.mirror_mask().is_own() {
            0
        } else {
            MIRROR
        };
        let halo = if image.slot() < self.owned { 0 } else { HALO };
        // SAFETY: each place belongs to one column, and one thread has that column.
        unsafe {
            *self.images.slot(index) = image;
            *self.special.slot(index) = mirror | halo | state.flags();
            for axis in 0..3 {
                *self.coordinates[axis].slot(index) = facts.position[axis];
            }
            if let Some(lengths) = &self.lengths {
                *lengths.slot(index) = facts.smoothing_length;
            }
        }
    }
}

/// Calls `finish` with each column's first place, entries and walls, halving the places among
/// threads. `starts` are the first indices of the columns and the end of the last.
fn halve(
    starts: &[u32],
    entries: &mut [Entry],
    walls: &mut [Walls],
    finish: &(impl Fn(usize, &mut [Entry], &mut Walls) + Sync),
) {
    let offset = starts[0];
    if walls.len() == 1 || entries.len() < GRAIN {
        for (pair, walls) in starts.windows(2).zip(walls) {
            let indices = (pair[0] - offset) as usize..(pair[1] - offset) as usize;
            finish(pair[0] as usize, &mut entries[indices], walls);
        }
        return;
    }
    let half = offset as usize + entries.len() / 2;
    let middle = starts.partition_point(|&start| (start as usize) < half);
    let middle = middle.clamp(1, walls.len() - 1);
    let (left, right) = entries.split_at_mut((starts[middle] - offset) as usize);
    let (left_walls, right_walls) = walls.split_at_mut(middle);
    rayon::join(
        || halve(&starts[..=middle], left, left_walls, finish),
        || halve(&starts[middle..], right, right_walls, finish),
    );
}

/// Sorts a column, which is nearly in order already if the store follows space.
fn sort_column(entries: &mut [Entry]) {
    let mut moves = 16 * entries.len();
    for k in 1..entries.len() {
        let entry = entries[k];
        let mut at = k;
        while at > 0 && entry.precedes(&entries[at - 1]) {
            entries[at] = entries[at - 1];
            at -= 1;
        }
        entries[at] = entry;
        moves = moves.saturating_sub(k - at);
        if moves == 0 {
            return entries.sort_unstable_by(Entry::order);
        }
    }
}
