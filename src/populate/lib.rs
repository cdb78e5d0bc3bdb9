//! Shape × lattice → particle sites, by pure functions of the body.
//!
//! Nothing here depends on ranks: each rank asks for the sites of its own brick, and the union over
//! any bricks is the whole body with the same bits and the same indices.

mod brick;
mod cells;
mod extremes;
mod filled;
mod filling;
mod given;
mod lattice;
mod overlap;
mod parts;
mod row;
mod sample;
mod search;
mod searched;
mod shells;
mod stress_points;
mod tally;
mod together;
mod touch;

pub use brick::Brick;
pub use filled::fill;
pub use overlap::{Overlap, close_pairs, overlap, surroundings};
pub use sample::sample;
pub use searched::{Searched, Searches};
pub use stress_points::{StressSite, stress_count, stress_index_end, stress_sites};
pub use together::{counts, for_each_body};
pub use touch::{touching_distance, touching_value};

use filling::Filling;
use model::{Axis, Body, Case, LatticeKind, RigidSurface, SymmetryPlane};
use rayon::prelude::*;
use row::cuts;

/// The values of a function of each of some things, in their order: in parallel on a thread of a pool, and one after the other elsewhere. A
/// case is read before the threads of a run are there, and whoever computes in parallel first would start others.
pub(crate) fn in_pool<T: Sync, R: Send>(all: &[T], of: impl Fn(&T) -> R + Sync) -> Vec<R> {
    if rayon::current_thread_index().is_some() {
        all.par_iter().map(&of).collect()
    } else {
        all.iter().map(of).collect()
    }
}

#[cfg(test)]
mod tests;

/// Rows and blocks of lattices that a thread has visited, and sites that it has tested or moved: for tests of what may not grow.
pub mod visits {
    use std::cell::Cell;

    thread_local! {
        static VISITS: Cell<u64> = const { Cell::new(0) };
    }

    /// Counts some more in builds with debug assertions.
    #[inline]
    pub fn add(more: u64) {
        if cfg!(debug_assertions) {
            VISITS.set(VISITS.get() + more);
        }
    }

    /// Rows and blocks visited by some work.
    pub fn of<T>(work: impl FnOnce() -> T) -> u64 {
        let before = VISITS.get();
        let _ = work();
        VISITS.get() - before
    }
}

/// Volumes that differ by no more than this are the same but for rounding.
const SAME_VOLUME: f64 = 1e-9;

/// One place of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Position (m); components beyond the dimension are zero.
    pub position: [f64; 3],
    /// Number of the site in the body, below [`index_end`].
    pub index: u64,
    /// Its volume over [`particle_volume`]; 1 where all particles of the body are alike.
    pub share: f64,
}

/// The purpose of a [`search`].
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// So many sites at most.
    pub most: usize,
    /// Only sites with smaller values.
    pub limit: f64,
    /// `true` for any such sites, be their values the smallest or not.
    pub any: bool,
}

/// One of several equal parts of the rows or blocks of a body, for ranks that count together.
#[derive(Debug, Clone, Copy)]
pub struct Share {
    /// Number of the part.
    pub part: usize,
    /// Number of parts.
    pub parts: usize,
}

/// The sites of a body above all symmetry planes and, if given, in a brick, in the order of their
/// index.
///
/// Only the part of the filling that meets the brick is visited; inside a row of a lattice no site
/// is tested. Bricks divide fitted sites by their positions before they are fitted.
pub fn sites(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    brick: Option<Brick>,
) -> impl Iterator<Item = Site> + use<> {
    let filling = Filling::of(body, dimension, symmetry);
    filling.sites(cuts(symmetry, brick), particle_volume(body, dimension))
}

/// Passes the [`sites`] of a body (in a dimension, above all symmetry planes) in a brick to `emit`
/// as they are before they are fitted.
pub fn emit_unfitted(
    (body, dimension, symmetry): (&Body, usize, &[SymmetryPlane]),
    brick: Brick,
    emit: impl FnMut(Site),
) {
    let filling = Filling::of(body, dimension, symmetry);
    let each = particle_volume(body, dimension);
    filling.emit_unfitted(cuts(symmetry, Some(brick)), each, emit);
}

/// The number of [`sites`], without a visit to each, and of layers that are alike only to one.
#[must_use]
pub fn count(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    brick: Option<Brick>,
) -> u64 {
    let whole = brick.is_none_or(|brick| brick == Brick::OPEN);
    if let Some(known) = filled::known(body, symmetry).filter(|_| whole) {
        return known.count;
    }
    Filling::of(body, dimension, symmetry).count(&cuts(symmetry, brick))
}

/// Passes the coordinates on an axis (m) of a share of the [`sites`] of a body above all symmetry
/// planes to `add`, with the number of sites there; in any order, and a coordinate may come several
/// times.
///
/// It looks once at each row of the share, and of layers that are alike at one only. Lattices that
/// are turned also take one step for each site of the largest layer.
pub fn tally(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    axis: usize,
    share: Share,
    add: impl FnMut(f64, u64),
) {
    let filling = Filling::of(body, dimension, symmetry);
    filling.tally(&cuts(symmetry, None), axis, share, add);
}

/// The sites of a body (in a dimension, above all symmetry planes) where `value` is smallest,
/// smallest first, found without visiting the others. `bound` says what `value` is at least in a box
/// between two corners (m); the tighter it is, the fewer sites are looked at. Sites that are fitted
/// are taken for where they end nearly.
pub fn search(
    (body, dimension, symmetry): (&Body, usize, &[SymmetryPlane]),
    wanted: Wanted,
    bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
    value: impl Fn(&[f64; 3]) -> f64,
) -> Vec<(f64, [f64; 3])> {
    Searched::new(body, dimension, symmetry).smallest(wanted, bound, value)
}

/// Smallest and largest coordinates (m) of the sites of a whole body, or `None` if it has none.
///
/// These are the extreme layers of particles, which lie half a spacing or so inside the shape.
#[must_use]
pub fn bounds(body: &Body, dimension: usize) -> Option<([f64; 3], [f64; 3])> {
    match &body.filled {
        Some(known) => known.whole,
        None => bounds_above(body, dimension, &[]),
    }
}

/// [`bounds`] of the [`sites`] above all symmetry planes.
#[must_use]
pub fn bounds_above(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
) -> Option<([f64; 3], [f64; 3])> {
    if let Some(known) = filled::known(body, symmetry) {
        return known.above;
    }
    Filling::of(body, dimension, symmetry).extremes(&cuts(symmetry, None))
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
/// behind it, as if all were as small as the finest; infinite where none is within a spacing.
#[must_use]
pub fn smallest_gap(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    surface: &RigidSurface,
) -> f64 {
    let reach = body.lattice.coarsest();
    let wanted = Wanted {
        most: 1,
        limit: reach,
        any: false,
    };
    let nearest = search(
        (body, dimension, symmetry),
        wanted,
        |lower, upper| {
            surface.least_gap(lower, upper, reach) - 0.5 * (reach - body.lattice.spacing)
        },
        |x| surface.gap(x, reach) - body.lattice.wider(x),
    );
    nearest.first().map_or(f64::INFINITY, |(gap, _)| *gap)
}

/// Volume of one particle of the body (m³; m² or m in two or one dimensions), so that its mass is
/// that times its initial density and its [`Site::share`]: [`even_volume`] if the body has been
/// given it, else Δp^d.
#[must_use]
pub fn particle_volume(body: &Body, dimension: usize) -> f64 {
    body.lattice.particle_volume(dimension)
}

/// The volume of the shape shared out among all its particles (m³; m² or m in two or one
/// dimensions), where it is not Δp^d: so the body has the mass of its shape. Glass is fitted to the
/// symmetry planes, so its particles share what lies above them. Of particles that a file gives it is
/// the mean volume.
#[must_use]
pub fn even_volume(body: &Body, dimension: usize, symmetry: &[SymmetryPlane]) -> Option<f64> {
    let cell = particle_volume(body, dimension);
    let differs = |even: &f64| (even / cell - 1.0).abs() > SAME_VOLUME;
    if let Filling::Given(given) = Filling::of(body, dimension, symmetry) {
        let mean = given.mean_volume(&cuts(symmetry, None));
        return mean.filter(differs);
    }
    let planes = if moves_sites(body) { symmetry } else { &[] };
    let shares = shares(body, dimension, planes);
    let even = body.shape.volume_above(planes, dimension) / shares;
    (shares > 0.0 && differs(&even)).then_some(even)
}

/// The sum of [`Site::share`] of all particles above the symmetry planes.
#[must_use]
pub fn shares(body: &Body, dimension: usize, symmetry: &[SymmetryPlane]) -> f64 {
    #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
    if body.lattice.grading.is_none() {
        return count(body, dimension, symmetry, None) as f64;
    }
    Filling::of(body, dimension, symmetry).shares(&cuts(symmetry, None))
}

/// The sum of the circumferences (m) of all rings of a body of an axisymmetric case; of more than a million by those of a
/// coarser filling.
#[must_use]
pub fn rings(case: &Case, body: &Body) -> f64 {
    const MOST: u64 = 1_000_000;
    let (sites, is_all) = sample(body, case.dimension, &case.symmetry, MOST);
    let add =
        |(sum, taken): (f64, f64), site: Site| (sum + case.around(&site.position), taken + 1.0);
    let (sum, taken) = sites.fold((0.0, 0.0), add);
    if is_all || taken == 0.0 {
        return sum;
    }
    #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
    let all = count(body, case.dimension, &case.symmetry, None) as f64;
    sum / taken * all
}

/// `true` if sites are moved after bricks are cut: particles may begin a spacing outside the brick
/// whose sites they are.
#[must_use]
pub fn moves_sites(body: &Body) -> bool {
    body.lattice.kind == LatticeKind::Glass
}

/// One more than the largest [`Site::index`] that the body can have; saturates at `u64::MAX`.
#[must_use]
pub fn index_end(body: &Body, dimension: usize) -> u64 {
    Filling::of(body, dimension, &[]).index_end()
}

/// No fewer sites than a body has: all of a lattice about it, of cells those of a box about it;
/// saturates at `u64::MAX`.
#[must_use]
pub fn most_sites(body: &Body, dimension: usize) -> u64 {
    Filling::of(body, dimension, &[]).most_sites()
}
