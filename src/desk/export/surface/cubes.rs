//! Marching cubes (Lorensen & Cline 1987), with a table that is made by one rule instead of written by hand.
//!
//! The surface crosses the edges of a cell whose ends lie on both sides. On each face of the cell
//! these crossings are joined so that corners inside are cut off one by one, where there is a choice: the
//! two cells of a face agree. The joints of all faces are closed loops, and each is filled by triangles
//! none of whose inner edges lies in a face. So every edge of the surface has two triangles, which turn the
//! same way round: it has no holes and no edges of more.

use std::sync::LazyLock;

use super::Triangle;

/// A cell: the coordinates of its lowest and highest corners (m), and the level at its corners,
/// numbered by the bits of x, y and z.
#[derive(Debug, Clone, Copy)]
pub struct Cube {
    pub low: [f64; 3],
    pub high: [f64; 3],
    pub corners: [f64; 8],
}

/// Least distance from a corner to a cut of an edge, as a share of it: so no triangle is without
/// area.
const LEAST: f64 = 0.01;

/// Edges by their lower corners and axes; 12 of a cell.
const EDGES: [(usize, usize); 12] = edges();

/// Three edges of a cell.
type Cut = [u8; 3];

/// The triangles of each way that a surface may go through a cell.
static CUTS: LazyLock<Vec<Vec<Cut>>> = LazyLock::new(|| (0..256).map(cuts).collect());

/// Tells the triangles of the surface in a cell; inside is where the level is not negative.
pub fn cut(cube: &Cube, mut emit: impl FnMut(Triangle)) {
    let bits = cube.corners.iter().enumerate();
    let inside = bits.fold(0, |sum, (c, level)| sum | usize::from(*level >= 0.0) << c);
    for cut in &CUTS[inside] {
        emit(cut.map(|edge| cube.crossing(edge.into())));
    }
}

impl Cube {
    /// The zero of the level on an edge: the same bits in all cells that have it.
    fn crossing(&self, edge: usize) -> [f64; 3] {
        let (corner, axis) = EDGES[edge];
        let (from, to) = (self.corners[corner], self.corners[corner | 1 << axis]);
        let share = (from / (from - to)).clamp(LEAST, 1.0 - LEAST);
        std::array::from_fn(|k| {
            let [low, high] = [self.low[k], self.high[k]];
            if k == axis {
                low + share * (high - low)
            } else if corner >> k & 1 == 0 {
                low
            } else {
                high
            }
        })
    }
}

const fn edges() -> [(usize, usize); 12] {
    let mut edges = [(0, 0); 12];
    let (mut count, mut corner) = (0, 0);
    while corner < 8 {
        let mut axis = 0;
        while axis < 3 {
            if corner >> axis & 1 == 0 {
                edges[count] = (corner, axis);
                count += 1;
            }
            axis += 1;
        }
        corner += 1;
    }
    edges
}

/// The edge between two corners.
fn edge(a: usize, b: usize) -> u8 {
    let axis = (a ^ b).trailing_zeros() as usize;
    let edge = (0..).zip(EDGES).find(|(_, edge)| *edge == (a & b, axis));
    edge.map_or(0, |(number, _)| number)
}

/// The corners of the faces, each against the clock as seen from outside.
fn faces() -> [[usize; 4]; 6] {
    std::array::from_fn(|face| {
        let (axis, upper) = (face / 2, face % 2 == 1);
        let (right, up) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let near = if upper { 1 << axis } else { 0 };
        let mut corners = [near, near | right, near | right | up, near | up];
        if !upper {
            corners.reverse();
        }
        corners
    })
}

/// The triangles where these corners are inside.
fn cuts(inside: usize) -> Vec<Cut> {
    let is_inside = |corner: usize| inside >> corner & 1 == 1;
    // The next edge of the surface after each that it crosses.
    let mut next = [None; 12];
    for face in faces() {
        for k in 0..4 {
            if is_inside(face[k]) || !is_inside(face[(k + 1) % 4]) {
                continue;
            }
            // Into the inside, and out of it at the next chance.
            let mut end = k + 1;
            while is_inside(face[(end + 1) % 4]) {
                end += 1;
            }
            let enters = edge(face[k], face[(k + 1) % 4]);
            let leaves = edge(face[end % 4], face[(end + 1) % 4]);
            next[usize::from(enters)] = Some(leaves);
        }
    }
    let mut cuts = Vec::new();
    for first in 0..12 {
        let mut ring = Vec::new();
        let mut at = first;
        while let Some(further) = next[at].take() {
            ring.push(u8::try_from(at).unwrap_or(0));
            at = further.into();
        }
        if !ring.is_empty() {
            cuts.extend(
                fill(&ring, true)
                    .or_else(|| fill(&ring, false))
                    .unwrap_or_default(),
            );
        }
    }
    cuts
}

/// Triangles that fill a ring of edges, if there are any whose inner sides lie in no face, if
/// asked.
fn fill(ring: &[u8], strict: bool) -> Option<Vec<Cut>> {
    let count = ring.len();
    if count <= 3 {
        return Some(vec![[ring[0], *ring.get(1)?, *ring.get(2)?]]);
    }
    (0..count).find_map(|ear| {
        let (before, after) = (ring[(ear + count - 1) % count], ring[(ear + 1) % count]);
        if strict && in_one_face(before, after) {
            return None;
        }
        let mut rest = ring.to_vec();
        rest.remove(ear);
        let mut triangles = fill(&rest, strict)?;
        triangles.push([before, ring[ear], after]);
        Some(triangles)
    })
}

/// `true` if two edges belong to the same face.
fn in_one_face(a: u8, b: u8) -> bool {
    let ends = |edge: u8| {
        let (corner, axis) = EDGES[usize::from(edge)];
        [corner, corner | 1 << axis]
    };
    let all: Vec<usize> = ends(a).into_iter().chain(ends(b)).collect();
    faces()
        .iter()
        .any(|face| all.iter().all(|corner| face.contains(corner)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_is_filled_by_loops_away_from_faces() {
        for inside in 0..256 {
            let crossed = EDGES.iter().filter(|(corner, axis)| {
                (inside >> corner & 1) != (inside >> (corner | 1 << axis) & 1)
            });
            let used: std::collections::BTreeSet<u8> = cuts(inside).into_iter().flatten().collect();
            assert_eq!(used.len(), crossed.count(), "{inside:08b}");
            // Sides of one triangle alone are those in faces.
            let mut sides = std::collections::BTreeMap::new();
            for [a, b, c] in cuts(inside) {
                for (a, b) in [(a, b), (b, c), (c, a)] {
                    *sides.entry((a.min(b), a.max(b))).or_insert(0) += 1;
                }
            }
            for ((a, b), count) in sides {
                assert_eq!(count == 1, in_one_face(a, b), "{inside:08b}: {a} {b}");
                assert!(count <= 2, "{inside:08b}: {a} {b}");
            }
        }
    }

    #[test]
    fn triangles_look_outwards() {
        let cube = Cube {
            low: [0.0; 3],
            high: [1.0; 3],
            corners: [1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0],
        };
        let mut triangles = Vec::new();
        cut(&cube, |triangle| triangles.push(triangle));
        assert_eq!(triangles.len(), 1);
        let [a, b, c] = triangles[0];
        let (u, v): ([f64; 3], [f64; 3]) = (
            std::array::from_fn(|k| b[k] - a[k]),
            std::array::from_fn(|k| c[k] - a[k]),
        );
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        assert_eq!(normal, [0.25; 3]);
    }
}
