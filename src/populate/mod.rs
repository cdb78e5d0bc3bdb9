//! Shape × lattice → particle sites, by pure functions of the body.
//!
//! Nothing here depends on ranks: each rank asks for the sites of its own slab, and the union over
//! any slabs is the whole body with the same bits and the same indices.

mod extremes;
mod lattice;
mod overlap;
mod row;
mod sample;
mod search;
mod stress_points;
mod tally;
mod touch;

pub use overlap::{Overlap, overlap};
pub use sample::sample;
pub use search::{Wanted, search};
pub use stress_points::{StressSite, stress_count, stress_index_end, stress_sites};
pub use tally::{Share, tally};
pub use touch::{touching_distance, touching_value};

use crate::model::{Axis, Body, RigidSurface, SymmetryPlane};
use lattice::Stack;
use row::cuts;

#[cfg(test)]
mod tests;

/// How much of lattices a thread has looked at, for tests of what may not grow.
#[cfg(test)]
pub(crate) mod visits {
    use std::cell::Cell;

    thread_local! {
        static VISITS: Cell<u64> = const { Cell::new(0) };
    }

    /// Books one more row, or block of sites.
    pub fn add() {
        VISITS.set(VISITS.get() + 1);
    }

    /// Rows and blocks visited by some work.
    pub fn of<T>(work: impl FnOnce() -> T) -> u64 {
        let before = VISITS.get();
        let _ = work();
        VISITS.get() - before
    }
}

/// One place of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Position (m); components beyond the dimension are zero.
    pub position: [f64; 3],
    /// Linear index in the body's bounding lattice, below [`index_end`].
    pub index: u64,
}

/// The part of space `lower ≤ x < upper` on one axis (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// 0, 1 or 2.
    pub axis: usize,
    /// Smallest coordinate, included (m).
    pub lower: f64,
    /// Largest coordinate, excluded (m).
    pub upper: f64,
}

/// The sites of a body above all symmetry planes and, if given, in a slab, in the order of their
/// index.
///
/// Only the lattice rows that meet the slab are visited; inside a row no site is tested.
pub fn sites(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    slab: Option<Slab>,
) -> impl Iterator<Item = Site> + use<> {
    let stack = Stack::new(body, dimension);
    row::rows(stack, cuts(symmetry, slab)).flat_map(move |row| {
        row.range().map(move |i| Site {
            position: stack.position(i, row.j, row.k),
            index: stack.index(i, row.j, row.k),
        })
    })
}

/// How many [`sites`] there are, without visiting each, and of layers that are alike only one.
#[must_use]
pub fn count(body: &Body, dimension: usize, symmetry: &[SymmetryPlane], slab: Option<Slab>) -> u64 {
    let (stack, cuts) = (Stack::new(body, dimension), cuts(symmetry, slab));
    let of_layer = |k| -> u64 {
        let rows = row::rows_of_layer(&stack, &cuts, k);
        rows.map(|row| row.end - row.first).sum()
    };
    let layers = tally::LikeLayers::of(&stack, &cuts);
    layers.map(|like| like.count() * of_layer(like.first)).sum()
}

/// Smallest and largest coordinates (m) of the sites of a whole body, or `None` if it has none.
///
/// These are the extreme layers of particles, which lie half a spacing or so inside the shape.
#[must_use]
pub fn bounds(body: &Body, dimension: usize) -> Option<([f64; 3], [f64; 3])> {
    extremes::extremes(&Stack::new(body, dimension), &[])
}

/// [`bounds`] of the [`sites`] above all symmetry planes.
#[must_use]
pub fn bounds_above(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
) -> Option<([f64; 3], [f64; 3])> {
    extremes::extremes(&Stack::new(body, dimension), &cuts(symmetry, None))
}

/// Smallest coordinate on an axis (m) of the [`sites`] above all symmetry planes, or `None` if
/// there are none.
#[must_use]
pub fn first_layer(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    axis: Axis,
) -> Option<f64> {
    let (lower, _) = bounds_above(body, dimension, symmetry)?;
    Some(lower[axis.index()])
}

/// Smallest distance (m) of the [`sites`] above all symmetry planes from a rigid surface, negative
/// behind it; infinite where none is within a spacing.
#[must_use]
pub fn smallest_gap(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    surface: &RigidSurface,
) -> f64 {
    let wanted = Wanted {
        most: 1,
        limit: body.lattice.spacing,
        any: false,
    };
    let found = search(
        (body, dimension, symmetry),
        wanted,
        |lower, upper| surface.least_gap(lower, upper, body.lattice.spacing),
        |x| surface.gap(x, body.lattice.spacing),
    );
    found.first().map_or(f64::INFINITY, |(gap, _)| *gap)
}

/// Volume of one particle of the body, Δp^d (m³; m² or m in two or one dimensions), so that its
/// mass is `ρ Δp^d` with its initial density.
#[must_use]
pub fn particle_volume(body: &Body, dimension: usize) -> f64 {
    (1..dimension).fold(body.lattice.spacing, |v, _| v * body.lattice.spacing)
}

/// One more than the largest [`Site::index`] that the body can have; saturates at `u64::MAX`.
#[must_use]
pub fn index_end(body: &Body, dimension: usize) -> u64 {
    Stack::new(body, dimension).index_end()
}
