//! How far two bodies begin within each other.

use crate::model::{Body, Case, Vec3};
use crate::populate::{self, Slab};

/// Bodies in touch have their outermost particles a mean spacing apart, somewhat less where curved
/// faces follow a lattice; closer ones overlap (spacings).
const CLOSE: f64 = 0.95;
/// So many particles are looked at: more than a face has.
const MOST_SITES: usize = 50_000_000;
/// Of the particles of one body within the other, so many are looked at.
const DEEPEST: usize = 8;

/// The place where two bodies overlap most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Depth in mean spacings.
    pub depth: f64,
    /// A particle there (m).
    pub at: [f64; 3],
}

/// By how much two bodies begin within each other; nothing for bodies in touch or apart.
///
/// A face lies half a spacing before its outermost particles. Shapes give the depth and particles
/// confirm it, since a curved shape is not filled to its edge.
pub fn overlap(case: &Case, a: usize, b: usize) -> Option<Overlap> {
    let [a, b] = [&case.bodies[a], &case.bodies[b]];
    let either = [deepest(case, a, b), deepest(case, b, a)];
    let deeper = either.into_iter().flatten();
    deeper.max_by(|a, b| a.depth.total_cmp(&b.depth))
}

/// The deepest particle of `body` that `other` has particles around.
fn deepest(case: &Case, body: &Body, other: &Body) -> Option<Overlap> {
    let mean = 0.5 * (body.lattice.spacing + other.lattice.spacing);
    let slab = common_slab(case, body, other, mean)?;
    let mut within: Vec<Overlap> = Vec::new();
    let sites = populate::sites(body, case.dimension, &case.symmetry, Some(slab));
    for site in sites.take(MOST_SITES) {
        let outside = other
            .shape
            .distance(&Vec3::from(site.position), case.dimension);
        let depth = (0.5 * body.lattice.spacing - outside) / mean;
        let place = within.partition_point(|other| other.depth >= depth);
        if depth > 0.0 && place < DEEPEST {
            within.truncate(DEEPEST - 1);
            let at = site.position;
            within.insert(place, Overlap { depth, at });
        }
    }
    let confirmed = |overlap: &Overlap| {
        // Across the faces, and aside to the middle between particles.
        let across = (1.0 - overlap.depth).max(0.5);
        let near = (across * across + 0.5).sqrt().min(CLOSE) * mean;
        has_particle(case, other, overlap.at, near)
    };
    within.into_iter().find(confirmed)
}

/// The slab with the fewest spacings in which both bodies have particles, if there is one.
fn common_slab(case: &Case, body: &Body, other: &Body, mean: f64) -> Option<Slab> {
    let (a_lower, a_upper) = populate::bounds(body, case.dimension)?;
    let (b_lower, b_upper) = populate::bounds(other, case.dimension)?;
    let slabs = (0..case.dimension).map(|axis| Slab {
        axis,
        lower: a_lower[axis].max(b_lower[axis] - mean),
        upper: a_upper[axis].min(b_upper[axis] + mean) + 1e-6 * mean,
    });
    let thinnest = slabs.min_by(|a, b| (a.upper - a.lower).total_cmp(&(b.upper - b.lower)))?;
    (thinnest.lower < thinnest.upper).then_some(thinnest)
}

/// Whether a body has a particle closer to a point than `near` (m).
fn has_particle(case: &Case, body: &Body, point: [f64; 3], near: f64) -> bool {
    let slab = Slab {
        axis: case.dimension - 1,
        lower: point[case.dimension - 1] - near,
        upper: point[case.dimension - 1] + near,
    };
    let mut sites = populate::sites(body, case.dimension, &case.symmetry, Some(slab));
    sites.any(|site| (Vec3::from(site.position) - Vec3::from(point)).norm() < near)
}
