//! Tests of triangles for a closed surface, and for a convex one.

use std::collections::{BTreeMap, BTreeSet};

use crate::readable::shown_vector;
use numerics::vector::{dot, minus};

/// Why triangles make no closed surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// There are none.
    #[error("it has no triangles")]
    Empty,
    /// A triangle whose corners lie on a line.
    #[error("triangle {triangle} has no area: its corners lie on a line near {location}")]
    Flat {
        /// Number of the triangle, from one.
        triangle: usize,
        /// Its first corner.
        location: String,
    },
    /// Edges with a triangle on one side only.
    #[error("it is not closed: {edges} edges have no second triangle, one of them near {location}")]
    Open {
        /// Number of such edges.
        edges: usize,
        /// One end of the first of them.
        location: String,
    },
    /// A hole that is too wide to be closed.
    #[error(
        "it is not closed: {edges} edges have no second triangle; its widest hole, near {location}, is \
         {width} wide, and only those up to one spacing ({widest}) are closed"
    )]
    Hole {
        /// Number of edges without a second triangle, of all holes.
        edges: usize,
        /// Four times its area over its rim.
        width: String,
        /// The widest hole that is still closed.
        widest: String,
        /// Its middle.
        location: String,
    },
    /// Two triangles run along an edge in the same direction.
    #[error(
        "its triangles are not turned alike, or more than two meet in an edge, as near {location}"
    )]
    Tangled {
        /// One end of such an edge.
        location: String,
    },
    /// Parts that are both solid lie in one another.
    #[error(
        "its parts overlap, as near {location}, where mass would count twice: save each part as a file \
         and join them by `union`"
    )]
    Overlap {
        /// The middle of a triangle of one that is within another.
        location: String,
    },
    /// Parts that lie in one another, too many of them.
    #[error("more than {most} of its parts lie around one place, {location}")]
    Nested {
        /// So many may.
        most: usize,
        /// The place.
        location: String,
    },
    /// The triangles enclose nothing.
    #[error("it encloses no volume")]
    NoVolume,
}

/// By the two ends of a directed edge: the triangle that it belongs to.
pub(super) type Edges = BTreeMap<(u32, u32), u32>;

/// A place as errors name it.
pub(super) fn location(x: &[f64; 3]) -> String {
    shown_vector(x, "m")
}

/// The directed edges of triangles.
pub(super) fn edges(triangles: &[[u32; 3]]) -> Edges {
    let mut edges = Edges::new();
    for (n, t) in (0..).zip(triangles) {
        for k in 0..3 {
            edges.insert((t[k], t[(k + 1) % 3]), n);
        }
    }
    edges
}

/// Checks that every directed edge occurs once, and once in the other direction.
pub(super) fn check_closed(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    let edges = edges(triangles);
    let open = |&(a, b): &(u32, u32)| !edges.contains_key(&(b, a));
    let first = edges.keys().copied().find(open);
    if let Some((a, _)) = first {
        return Err(MeshError::Open {
            edges: edges.keys().filter(|edge| open(edge)).count(),
            location: location(&corners[a as usize]),
        });
    }
    if edges.len() < 3 * triangles.len() {
        let mut seen = BTreeSet::new();
        for t in triangles {
            for k in 0..3 {
                if !seen.insert((t[k], t[(k + 1) % 3])) {
                    let location = location(&corners[t[k] as usize]);
                    return Err(MeshError::Tangled { location });
                }
            }
        }
    }
    Ok(())
}

/// `true` if a closed surface is in one piece and no edge of it is a valley.
pub(super) fn is_convex(
    corners: &[[f64; 3]],
    triangles: &[[u32; 3]],
    faces: &[[f64; 3]],
    edges: &Edges,
) -> bool {
    let mut reached = vec![false; triangles.len()];
    let mut open = vec![0_usize];
    reached[0] = true;
    while let Some(n) = open.pop() {
        let t = &triangles[n];
        for k in 0..3 {
            let other = edges[&(t[(k + 1) % 3], t[k])] as usize;
            let base = &corners[t[k] as usize];
            let rises = triangles[other].iter().any(|&c| {
                let r = minus(&corners[c as usize], base);
                // Files hold six digits or so.
                dot(&r, &faces[n]) > 1e-6 * dot(&r, &r).sqrt()
            });
            if rises {
                return false;
            }
            if !reached[other] {
                reached[other] = true;
                open.push(other);
            }
        }
    }
    reached.iter().all(|&r| r)
}
