//! Shape × lattice → particle sites, by pure functions of the body.
//!
//! Nothing here depends on ranks: each rank asks for the sites of its own slab, and the union over
//! any slabs is the whole body with the same bits and the same indices.

mod lattice;
mod row;
mod stress_points;
mod touch;

pub use stress_points::{StressSite, stress_count, stress_index_end, stress_sites};
pub use touch::{touching_distance, touching_value};

use crate::model::{Axis, Body, RigidSurface, SurfaceShape, SymmetryPlane};
use lattice::Stack;
use row::Row;

#[cfg(test)]
mod tests;

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
    row::rows(stack, symmetry, slab).flat_map(move |row| {
        row.range().map(move |i| Site {
            position: stack.position(i, row.j, row.k),
            index: stack.index(i, row.j, row.k),
        })
    })
}

/// How many [`sites`] there are, without visiting each.
#[must_use]
pub fn count(body: &Body, dimension: usize, symmetry: &[SymmetryPlane], slab: Option<Slab>) -> u64 {
    row::rows(Stack::new(body, dimension), symmetry, slab)
        .map(|row| row.end - row.first)
        .sum()
}

/// The ends (m) of all lattice rows above the symmetry planes: the outermost particles, as seen
/// along the rows.
pub fn row_ends(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
) -> impl Iterator<Item = [f64; 3]> + use<> {
    let stack = Stack::new(body, dimension);
    row::rows(stack, symmetry, None)
        .flat_map(move |row| [row.first, row.end - 1].map(|i| stack.position(i, row.j, row.k)))
}

/// Smallest and largest coordinates (m) of the sites of a whole body, or `None` if it has none.
///
/// These are the extreme layers of particles, which lie half a spacing or so inside the shape.
#[must_use]
pub fn bounds(body: &Body, dimension: usize) -> Option<([f64; 3], [f64; 3])> {
    let stack = Stack::new(body, dimension);
    let mut found = None;
    for Row { j, k, first, end } in row::rows(stack, &[], None) {
        // Coordinates are monotone along a row, so its ends suffice.
        for i in [first, end - 1] {
            let p = stack.position(i, j, k);
            let (lower, upper) = found.get_or_insert((p, p));
            for axis in 0..3 {
                lower[axis] = f64::min(lower[axis], p[axis]);
                upper[axis] = f64::max(upper[axis], p[axis]);
            }
        }
    }
    found
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
    let stack = Stack::new(body, dimension);
    row::rows(stack, symmetry, None)
        .flat_map(|row| [row.first, row.end - 1].map(|i| stack.position(i, row.j, row.k)))
        .map(|position| position[axis.index()])
        .min_by(f64::total_cmp)
}

/// Smallest distance (m) of the [`sites`] above all symmetry planes from a rigid surface, negative
/// behind it; may be infinite where none is within a spacing.
#[must_use]
pub fn smallest_gap(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    surface: &RigidSurface,
) -> f64 {
    let stack = Stack::new(body, dimension);
    // Along a row the distance from a plane is monotone, so its ends suffice.
    let is_plane = matches!(surface.shape, SurfaceShape::Plane { .. });
    let ends_suffice = is_plane && !stack.has_rings();
    row::rows(stack, symmetry, None)
        .flat_map(|row| {
            let stride = if ends_suffice {
                (row.end - row.first - 1).max(1)
            } else {
                1
            };
            let sites = (row.first..row.end).step_by(usize::try_from(stride).unwrap_or(usize::MAX));
            sites.map(move |i| stack.position(i, row.j, row.k))
        })
        .map(|position| surface.gap(&position, body.lattice.spacing))
        .fold(f64::INFINITY, f64::min)
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
