//! An octree over particles. Its cells are those of the cube, so that two trees which hold the same in a cell
//! have the same of it.

use rayon::prelude::*;

use super::cube::{Bounds, Cube, DEPTH, Key, ancestor, cell, common_level, eighth, level_of, side};
use super::moments::{Moments, Pole};
use numerics::collector::Collector;
use particles::{GRAIN, resize};

/// Bins below which one thread makes the cells.
const ALONE: usize = 256;

/// A particle that attracts.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Point {
    /// The cell that it lies in.
    pub key: Key,
    pub id: u64,
    /// Position (m).
    pub position: [f64; 3],
    /// Mass (kg).
    pub mass: f64,
    /// Smoothing length (m).
    pub length: f64,
    /// Index on the rank that owns it.
    pub index: u64,
}

/// What lies in a cell itself and in none below: particles, or what other ranks tell of a cell that they keep closed.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Bin {
    pub key: Key,
    /// Its points, from one to below another.
    pub points: [u32; 2],
    pub moments: Moments,
}

/// A cell: one that holds points itself, or several cells. A cell that would hold no more than one cell is left out.
#[derive(Debug, Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Cell {
    pub key: Key,
    /// Points that lie in it itself.
    pub points: [u32; 2],
    /// The next cell if this one counts as one body.
    pub beyond: u32,
    /// The next cell if it is opened.
    pub inside: u32,
}

/// Bytes of a bin, with the cells above it.
pub(super) const BYTES_OF_BIN: usize =
    size_of::<Bin>() + 2 * (size_of::<Cell>() + size_of::<Moments>() + size_of::<Pole>());

/// The tree. Cells stand depth first, with gaps.
#[derive(Debug, Default)]
pub(super) struct Tree {
    pub points: Vec<Point>,
    pub bins: Vec<Bin>,
    pub cells: Vec<Cell>,
    pub moments: Vec<Moments>,
    pub poles: Vec<Pole>,
    firsts: Vec<u32>,
    collector: Collector,
}

impl Tree {
    /// Bytes allocated.
    pub fn memory(&self) -> usize {
        size_of::<Point>() * self.points.capacity()
            + size_of::<Bin>() * self.bins.capacity()
            + size_of::<Cell>() * self.cells.capacity()
            + size_of::<Moments>() * self.moments.capacity()
            + size_of::<Pole>() * self.poles.capacity()
            + size_of::<u32>() * self.firsts.capacity()
            + self.collector.memory()
    }

    /// Puts points in the order of their cells and ids, and gathers those of a cell in a bin.
    pub fn sort(&mut self, cube: &Cube) {
        let Self {
            points,
            bins,
            firsts,
            collector,
            ..
        } = self;
        points.par_sort_unstable_by_key(|point| (point.key, point.id));
        let begins = |i: usize| i == 0 || points[i - 1].key != points[i].key;
        firsts.clear();
        collector.extend(firsts, (points.len(), GRAIN), |i| {
            begins(i).then(|| u32::try_from(i).unwrap_or(u32::MAX))
        });
        resize(bins, firsts.len());
        let end = u32::try_from(points.len()).unwrap_or(u32::MAX);
        bins.par_iter_mut().enumerate().for_each(|(n, bin)| {
            let range = [firsts[n], firsts.get(n + 1).copied().unwrap_or(end)];
            let own = &points[range[0] as usize..range[1] as usize];
            let mut moments = Moments::default();
            for point in own {
                moments.add(&Moments::of(cube, &point.position, point.mass));
            }
            *bin = Bin {
                key: own[0].key,
                points: range,
                moments,
            };
        });
    }

    /// Makes the cells above the bins.
    pub fn grow(&mut self, cube: &Cube) {
        let Self {
            bins,
            cells,
            moments,
            poles,
            ..
        } = self;
        // Each cell without a bin of its own holds two or more.
        let slots = (2 * bins.len()).saturating_sub(1);
        resize(cells, slots);
        resize(moments, slots);
        resize(poles, slots);
        let part = Part {
            at: 0,
            cells,
            moments,
            poles,
        };
        let end = u32::try_from(slots).unwrap_or(u32::MAX);
        if !bins.is_empty() {
            grow(cube, bins, part, end);
        }
    }

    /// Goes over the tree: opens the cells that are not `closed`, and gives the places of those that are, and of those opened.
    #[inline(always)]
    pub fn walk(
        &self,
        mut closed: impl FnMut(&Bounds, f64) -> bool,
        mut visit: impl FnMut(usize, bool),
    ) {
        let (mut at, end) = (0, self.cells.len());
        while at < end {
            let Cell {
                key,
                beyond,
                inside,
                ..
            } = self.cells[at];
            let is_closed = closed(&cell(key), side(level_of(key)));
            visit(at, is_closed);
            at = if is_closed { beyond } else { inside } as usize;
        }
    }
}

/// A piece of the arrays of cells, the first of which is cell `at` of all.
struct Part<'a> {
    at: usize,
    cells: &'a mut [Cell],
    moments: &'a mut [Moments],
    poles: &'a mut [Pole],
}

impl Part<'_> {
    fn split(self, first: usize) -> (Self, Self) {
        let (cells, more_cells) = self.cells.split_at_mut(first);
        let (moments, more_moments) = self.moments.split_at_mut(first);
        let (poles, more_poles) = self.poles.split_at_mut(first);
        let lower = Self {
            at: self.at,
            cells,
            moments,
            poles,
        };
        let upper = Self {
            at: self.at + first,
            cells: more_cells,
            moments: more_moments,
            poles: more_poles,
        };
        (lower, upper)
    }
}

/// Makes the cell around some bins and those in it; behind it goes on at cell `beyond`.
fn grow(cube: &Cube, bins: &[Bin], part: Part, beyond: u32) -> Moments {
    let (first, last) = (&bins[0], &bins[bins.len() - 1]);
    let level = common_level(first.key, last.key);
    let key = ancestor(first.key, level);
    let own = bins.iter().take_while(|bin| bin.key == key).count();
    let (own, rest) = bins.split_at(own);
    let mut sum = Moments::default();
    let mut points = [0, 0];
    for bin in own {
        sum.add(&bin.moments);
        if bin.points[0] < bin.points[1] {
            points = bin.points;
        }
    }
    let (place, below) = part.split(1);
    let inside = if rest.is_empty() {
        beyond
    } else {
        let at = u32::try_from(below.at).unwrap_or(u32::MAX);
        sum.add(&grow_below(cube, rest, level, below, beyond));
        at
    };
    place.cells[0] = Cell {
        key,
        points,
        beyond,
        inside,
    };
    place.poles[0] = sum.pole(cube);
    place.moments[0] = sum;
    sum
}

/// Makes the cells in one of a level, by halves of its eighths.
fn grow_below(cube: &Cube, bins: &[Bin], level: u32, part: Part, beyond: u32) -> Moments {
    debug_assert!(level < DEPTH);
    let of = |bin: &Bin| eighth(bin.key, level);
    let middle = of(&bins[bins.len() / 2]);
    let mut half = bins.partition_point(|bin| of(bin) < middle);
    if half == 0 {
        half = bins.partition_point(|bin| of(bin) <= middle);
    }
    if half == bins.len() {
        return grow(cube, bins, part, beyond);
    }
    let (lower, upper) = bins.split_at(half);
    let (left, right) = part.split(2 * half - 1);
    let next = u32::try_from(right.at).unwrap_or(u32::MAX);
    let left = || grow_below(cube, lower, level, left, next);
    let right = || grow_below(cube, upper, level, right, beyond);
    let (mut sum, other) = if bins.len() > ALONE {
        rayon::join(left, right)
    } else {
        (left(), right())
    };
    sum.add(&other);
    sum
}
