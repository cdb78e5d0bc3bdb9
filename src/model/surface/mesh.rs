//! Closed meshes of triangles: inside and outside, and the nearest place.
//!
//! The sign of the distance is that of the product with the pseudo-normal of the nearest face, edge
//! or corner (Bærentzen & Aanæs 2005): sums of the normals of the faces there, weighted at corners
//! by the faces' angles, which is right for any closed surface.

use std::collections::BTreeMap;

use super::closed::{MeshError, check_closed, edges, is_convex, place};
use super::tree::Tree;
use super::triangle::{Feature, closest_on_triangle};
use super::{Foot, along};
use crate::numerics::vector::{cross, dot, minus};

/// A closed surface of triangles, turned so that their normals point outwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    corners: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Unit normals of faces.
    faces: Vec<[f64; 3]>,
    /// Pseudo-normals of the edges of each triangle, from each corner to the next.
    edges: Vec<[[f64; 3]; 3]>,
    /// Pseudo-normals of corners.
    vertices: Vec<[f64; 3]>,
    tree: Tree,
    convex: bool,
}

impl Mesh {
    /// Bytes that it takes.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of_val(&self.corners[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.faces[..])
            + size_of_val(&self.edges[..])
            + size_of_val(&self.vertices[..])
            + self.tree.memory()
    }

    /// Joins triangles that share corners to the bit. Triangles with two equal corners are left
    /// out; a surface whose normals point inwards is turned.
    ///
    /// # Errors
    /// If the triangles are no closed surface.
    pub fn new(soup: &[[[f64; 3]; 3]]) -> Result<Self, MeshError> {
        let mut numbers: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        let mut corners: Vec<[f64; 3]> = Vec::new();
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        for (n, triangle) in soup.iter().enumerate() {
            let t = triangle.map(|x| {
                // Zero has one sign.
                let x = x.map(|c| c + 0.0);
                *numbers.entry(x.map(f64::to_bits)).or_insert_with(|| {
                    corners.push(x);
                    u32::try_from(corners.len() - 1).unwrap_or(u32::MAX)
                })
            });
            if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
                continue;
            }
            let area = normal_area(&t.map(|c| corners[c as usize]));
            if dot(&area, &area) <= 0.0 {
                let place = place(&triangle[0]);
                return Err(MeshError::Flat {
                    triangle: n + 1,
                    place,
                });
            }
            triangles.push(t);
        }
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        let volume: f64 = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|c| corners[c as usize]);
                dot(&a, &cross(&b, &c))
            })
            .sum();
        check_closed(&corners, &triangles)?;
        if volume == 0.0 {
            return Err(MeshError::NoVolume);
        }
        if volume < 0.0 {
            for t in &mut triangles {
                t.swap(1, 2);
            }
        }
        Ok(Self::closed(corners, triangles))
    }

    /// The mesh of a closed surface whose normals point outwards.
    fn closed(corners: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let at = |t: &[u32; 3]| t.map(|c| corners[c as usize]);
        let unit = |v: [f64; 3]| along(&v, dot(&v, &v).sqrt());
        let faces: Vec<[f64; 3]> = triangles
            .iter()
            .map(|t| unit(normal_area(&at(t))))
            .collect();
        let edges_of = edges(&triangles);
        let mut vertices = vec![[0.0; 3]; corners.len()];
        let mut edges = Vec::with_capacity(triangles.len());
        for (t, face) in triangles.iter().zip(&faces) {
            let x = at(t);
            for k in 0..3 {
                let angle = angle(&x[k], &x[(k + 1) % 3], &x[(k + 2) % 3]);
                for a in 0..3 {
                    vertices[t[k] as usize][a] += angle * face[a];
                }
            }
            edges.push(std::array::from_fn(|k| {
                let other = edges_of[&(t[(k + 1) % 3], t[k])];
                let other = faces[other as usize];
                unit(std::array::from_fn(|a| face[a] + other[a]))
            }));
        }
        let boxes: Vec<_> = triangles
            .iter()
            .map(|t| {
                let x = at(t);
                let side = |pick: fn(f64, f64) -> f64| {
                    std::array::from_fn(|a| pick(pick(x[0][a], x[1][a]), x[2][a]))
                };
                (side(f64::min), side(f64::max))
            })
            .collect();
        let tree = Tree::new(&boxes);
        let convex = is_convex(&corners, &triangles, &faces, &edges_of);
        Self {
            vertices: vertices.into_iter().map(unit).collect(),
            tree,
            convex,
            corners,
            triangles,
            faces,
            edges,
        }
    }

    /// The nearest place from `x` (m), if it is not farther than `limit` (m).
    #[must_use]
    pub fn foot(&self, x: &[f64; 3], limit: f64) -> Option<Foot> {
        let mut best = (limit * limit, u32::MAX, [0.0; 3], Feature::Face);
        self.tree.near(x, best.0, |t| {
            let corners = self.triangles[t as usize].map(|c| self.corners[c as usize]);
            let (point, feature) = closest_on_triangle(&corners, x);
            let r = minus(x, &point);
            let square = dot(&r, &r);
            // Of equals the first triangle, however the tree is walked.
            if square < best.0 || (square == best.0 && t < best.1) {
                best = (square, t, point, feature);
            }
            best.0
        });
        let (square, t, point, feature) = best;
        if t == u32::MAX {
            return None;
        }
        let t = t as usize;
        let r = minus(x, &point);
        let pseudo = match feature {
            Feature::Face => {
                let normal = self.faces[t];
                let gap = dot(&r, &normal);
                return Some(Foot { normal, gap });
            }
            Feature::Edge(k) => self.edges[t][k],
            Feature::Corner(k) => self.vertices[self.triangles[t][k] as usize],
        };
        let distance = square.sqrt();
        let side = dot(&r, &pseudo);
        // On the surface itself the way out is the pseudo-normal.
        Some(if side == 0.0 {
            Foot {
                normal: pseudo,
                gap: 0.0,
            }
        } else if side > 0.0 {
            Foot {
                normal: along(&r, distance),
                gap: distance,
            }
        } else {
            Foot {
                normal: along(&r, distance).map(|n| -n),
                gap: -distance,
            }
        })
    }

    /// Distance (m) of a point from the surface, negative inside.
    #[must_use]
    pub fn distance(&self, x: &[f64; 3]) -> f64 {
        self.foot(x, f64::INFINITY)
            .map_or(f64::INFINITY, |foot| foot.gap)
    }

    /// Volume that the surface encloses (m³), by the theorem of Gauss.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let (lower, upper) = self.bounds();
        let middle: [f64; 3] = std::array::from_fn(|a| 0.5 * (lower[a] + upper[a]));
        let parts = self.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|c| minus(&self.corners[c as usize], &middle));
            dot(&a, &cross(&b, &c)) / 6.0
        });
        parts.fold(0.0, |sum, part| sum + part)
    }

    /// Whether the surface is convex.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.convex
    }

    /// Smallest and largest coordinates (m).
    #[must_use]
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.tree.bounds()
    }
}

/// Twice the area along the normal.
fn normal_area(x: &[[f64; 3]; 3]) -> [f64; 3] {
    cross(&minus(&x[1], &x[0]), &minus(&x[2], &x[0]))
}

/// Angle at `a` between `b` and `c` (rad).
fn angle(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3]) -> f64 {
    let (ab, ac) = (minus(b, a), minus(c, a));
    let across = cross(&ab, &ac);
    libm::atan2(dot(&across, &across).sqrt(), dot(&ab, &ac))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four corners in order about the outward normal, as two triangles.
    fn quad(q: [[f64; 3]; 4]) -> [[[f64; 3]; 3]; 2] {
        [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
    }

    /// The solid over an outline in x and y (counter-clockwise), from z = −1 to 1, and its ends as
    /// triangles of the outline's corners.
    fn prism(outline: &[[f64; 2]], ends: &[[usize; 3]]) -> Vec<[[f64; 3]; 3]> {
        let at = |k: usize, z: f64| [outline[k][0], outline[k][1], z];
        let n = outline.len();
        let mut soup: Vec<_> = (0..n)
            .flat_map(|k| {
                let l = (k + 1) % n;
                quad([at(k, -1.0), at(l, -1.0), at(l, 1.0), at(k, 1.0)])
            })
            .collect();
        for &[a, b, c] in ends {
            soup.push([at(a, 1.0), at(b, 1.0), at(c, 1.0)]);
            soup.push([at(a, -1.0), at(c, -1.0), at(b, -1.0)]);
        }
        soup
    }

    fn cube() -> Vec<[[f64; 3]; 3]> {
        let outline = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        prism(&outline, &[[0, 1, 2], [0, 2, 3]])
    }

    /// An L with its inner corner at the origin, open towards +x and +y.
    fn angle_iron() -> Vec<[[f64; 3]; 3]> {
        let outline = [
            [-1.0, -1.0],
            [2.0, -1.0],
            [2.0, 0.0],
            [0.0, 0.0],
            [0.0, 2.0],
            [-1.0, 2.0],
        ];
        prism(&outline, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
    }

    fn near(foot: Option<Foot>, normal: [f64; 3], gap: f64) {
        super::super::tests::near(foot.expect("a foot"), normal, gap);
    }

    #[test]
    fn faces_edges_and_corners_of_a_cube() {
        let mesh = Mesh::new(&cube()).unwrap();
        assert!(mesh.is_convex());
        assert_eq!(mesh.triangles.len(), 12);
        let far = f64::INFINITY;
        near(mesh.foot(&[1.5, 0.2, 0.1], far), [1.0, 0.0, 0.0], 0.5);
        near(mesh.foot(&[0.9, 0.2, 0.1], far), [1.0, 0.0, 0.0], -0.1);
        // The diagonal of two triangles is no edge to be seen.
        near(mesh.foot(&[0.3, 0.3, 1.25], far), [0.0, 0.0, 1.0], 0.25);
        near(mesh.foot(&[1.3, 1.4, 0.1], far), [0.6, 0.8, 0.0], 0.5);
        near(
            mesh.foot(&[-1.0 - 2.0 / 3.0, -1.0 - 2.0 / 3.0, -1.0 - 1.0 / 3.0], far),
            [-2.0 / 3.0, -2.0 / 3.0, -1.0 / 3.0],
            1.0,
        );
        assert!(mesh.foot(&[1.5, 0.0, 0.0], 0.49).is_none());
        // On an edge and on a corner the way out is between the faces.
        let half = 0.5_f64.sqrt();
        near(mesh.foot(&[1.0, 1.0, 0.3], far), [half, half, 0.0], 0.0);
        let third = (1.0_f64 / 3.0).sqrt();
        near(mesh.foot(&[1.0; 3], far), [third; 3], 0.0);
    }

    #[test]
    fn a_valley_has_an_inside_beneath_its_edge() {
        let mesh = Mesh::new(&angle_iron()).unwrap();
        assert!(!mesh.is_convex());
        let far = f64::INFINITY;
        near(mesh.foot(&[0.3, 0.1, 0.0], far), [0.0, 1.0, 0.0], 0.1);
        near(mesh.foot(&[0.1, 0.3, 0.0], far), [1.0, 0.0, 0.0], 0.1);
        // Behind the valley the nearest place is its edge.
        near(mesh.foot(&[-0.3, -0.4, 0.0], far), [0.6, 0.8, 0.0], -0.5);
    }

    /// Against all triangles one by one.
    #[test]
    fn the_tree_finds_the_closest() {
        let mesh = Mesh::new(&angle_iron()).unwrap();
        for n in 0..4000 {
            let n = f64::from(n);
            let x = [0.7, 1.3, 2.1].map(|f| 3.0 * libm::sin(f * n + f));
            let square = mesh
                .triangles
                .iter()
                .map(|t| {
                    let corners = t.map(|c| mesh.corners[c as usize]);
                    let r = minus(&x, &closest_on_triangle(&corners, &x).0);
                    dot(&r, &r)
                })
                .fold(f64::INFINITY, f64::min);
            let foot = mesh.foot(&x, f64::INFINITY).expect("a foot");
            assert!((foot.gap.abs() - square.sqrt()).abs() < 1e-12);
            let [a, b, c] = x;
            let solid = |low: [f64; 3], high: [f64; 3]| {
                (0..3).all(|k| low[k] < [a, b, c][k] && [a, b, c][k] < high[k])
            };
            let inside = solid([-1.0; 3], [2.0, 0.0, 1.0]) || solid([-1.0; 3], [0.0, 2.0, 1.0]);
            assert_eq!(foot.gap < 0.0, inside, "{x:?}");
        }
    }

    #[test]
    fn what_is_no_closed_surface_is_refused() {
        let mut soup = cube();
        let mut turned = soup.clone();
        for t in &mut turned {
            t.swap(0, 1);
        }
        let mesh = Mesh::new(&turned).unwrap();
        near(mesh.foot(&[1.5, 0.2, 0.1], 1.0), [1.0, 0.0, 0.0], 0.5);
        // A needle without width changes nothing.
        soup.push([[1.0; 3], [1.0; 3], [0.0; 3]]);
        assert_eq!(Mesh::new(&soup).unwrap().triangles.len(), 12);
        soup.truncate(11);
        let open = Mesh::new(&soup).unwrap_err();
        assert!(
            open.to_string().contains("3 edges have no second triangle"),
            "{open}"
        );
        let mut soup = cube();
        soup[0].swap(0, 1);
        assert!(Mesh::new(&soup).is_err());
        let line = [[[0.0; 3], [1.0; 3], [2.0; 3]]];
        assert!(matches!(
            Mesh::new(&line),
            Err(MeshError::Flat { triangle: 1, .. })
        ));
        assert_eq!(Mesh::new(&[]), Err(MeshError::Empty));
        let mut twice = cube();
        twice.extend(cube());
        assert!(matches!(Mesh::new(&twice), Err(MeshError::Tangled { .. })));
    }
}
