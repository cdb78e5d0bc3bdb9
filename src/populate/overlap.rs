//! The initial overlap of two bodies.

use super::{Searches, Wanted, bounds};
use model::{Body, Case, ContactMode, Vec3};
use numerics::extent::Extent;
use numerics::meetings::{Meetings, MovingBox};

/// Bodies in touch have their outermost particles a mean spacing apart, somewhat less where curved
/// faces follow a lattice; closer ones overlap (spacings).
const CLOSE: f64 = 0.95;
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

/// The box of the particles of a body (m), wider by twice its coarsest spacing: what shapes reach beyond their
/// particles, and half of what is near between two. `None` without particles.
#[must_use]
pub fn surroundings(body: &Body, dimension: usize) -> Option<Extent> {
    let near = 2.0 * body.lattice.coarsest();
    let (lower, upper) = bounds(body, dimension)?;
    Some((lower.map(|x| x - near), upper.map(|x| x + near)))
}

/// The pairs of bodies that would push each other if they began within each other, and may, in the order of their
/// indices.
#[must_use]
pub fn close_pairs(case: &Case) -> Vec<[usize; 2]> {
    let bodies = case.bodies.iter().enumerate();
    let (indices, boxes): (Vec<usize>, Vec<MovingBox>) = bodies
        .filter_map(|(index, body)| {
            let still = MovingBox {
                extent: surroundings(body, case.dimension)?,
                velocity: [0.0; 3],
            };
            Some((index, still))
        })
        .unzip();
    let pairs = Meetings::new(&boxes).pairs(0.0, usize::MAX);
    let pairs = pairs
        .into_iter()
        .flatten()
        .map(|pair| pair.map(|place| indices[place]));
    let sees = |&[a, b]: &[usize; 2]| {
        !matches!(case.contact_between(a, b), ContactMode::None)
            && [a, b]
                .iter()
                .any(|&body| case.bodies[body].driven().is_none())
    };
    pairs.filter(sees).collect()
}

/// By how much two bodies begin within each other; nothing for bodies in touch or apart.
///
/// A face lies half a spacing before its outermost particles. Shapes give the depth and particles
/// confirm it, since a curved shape is not filled to its edge.
#[must_use]
pub fn overlap(searches: &Searches, a: usize, b: usize) -> Option<Overlap> {
    let either = [deepest(searches, a, b), deepest(searches, b, a)];
    let deeper = either.into_iter().flatten();
    deeper.max_by(|a, b| a.depth.total_cmp(&b.depth))
}

/// The deepest particle of a body that another has particles around.
fn deepest(searches: &Searches, index: usize, others: usize) -> Option<Overlap> {
    let (case, dimension) = (searches.case, searches.case.dimension);
    let [body, other] = [index, others].map(|body| &case.bodies[body]);
    let (own, its) = (&body.lattice, &other.lattice);
    let mean = |at: &[f64; 3]| {
        let at = Vec3::from(*at);
        0.5 * (own.spacing_at(&at) + its.spacing_at(&at))
    };
    let widest = 0.5 * (own.coarsest() - own.spacing);
    let limit = 0.5 * own.spacing;
    let bound = |lower: &[f64; 3], upper: &[f64; 3]| {
        other.shape.least_distance(lower, upper, dimension) - widest
    };
    // Most bodies that are near are apart by far.
    let (lower, upper) = bounds(body, dimension)?;
    if bound(&lower, &upper) >= limit {
        return None;
    }
    let within = searches.of(index).smallest(
        Wanted {
            most: DEEPEST,
            limit,
            any: false,
        },
        bound,
        |x| other.shape.distance(&Vec3::from(*x), dimension) - own.wider(x),
    );
    let mut overlaps = within.into_iter().map(|(outside, at)| Overlap {
        depth: (limit - outside) / mean(&at),
        at,
    });
    let confirmed = |overlap: &Overlap| {
        // Across the faces, and aside to the middle between particles.
        let across = (1.0 - overlap.depth).max(0.5);
        let near = (across * across + 0.5).sqrt().min(CLOSE) * mean(&overlap.at);
        has_particle(searches, others, overlap.at, near)
    };
    overlaps.find(confirmed)
}

/// `true` if a body has a particle closer to a point than `near` (m).
fn has_particle(searches: &Searches, body: usize, point: [f64; 3], near: f64) -> bool {
    let point = Vec3::from(point);
    let wanted = Wanted {
        most: 1,
        limit: near,
        any: true,
    };
    let distance = |x: Vec3| (x - point).norm();
    let nearest = searches.of(body).smallest(
        wanted,
        |lower, upper| distance(Vec3::from_fn(|a, _| point[a].clamp(lower[a], upper[a]))),
        |x| distance(Vec3::from(*x)),
    );
    !nearest.is_empty()
}
