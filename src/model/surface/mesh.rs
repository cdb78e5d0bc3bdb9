//! Closed meshes of triangles: inside and outside, and the nearest place.
//!
//! The sign of the distance is that of the product with the pseudo-normal of the nearest face, edge
//! or corner (Bærentzen & Aanæs 2005): sums of the normals of the faces there, weighted at corners
//! by the faces' angles, which is right for any closed surface.

use super::closed::{MeshError, edges, is_convex};
use super::mend::{Mended, mend};
use super::shells::{check_apart, nest};
use super::soup::{Soup, normal_area};
use super::tree::Tree;
use super::triangle::{Feature, closest_on_triangle};
use super::{Foot, SurfaceFile, along};
use crate::Vec3;
use nalgebra::Matrix3;
use numerics::vector::{cross, dot, minus};

/// A closed surface of triangles, turned so that their normals point outwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    pub(super) corners: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Unit normals of faces.
    faces: Vec<[f64; 3]>,
    /// Pseudo-normals of the edges of each triangle, from each corner to the next.
    edges: Vec<[[f64; 3]; 3]>,
    /// Pseudo-normals of corners.
    vertices: Vec<[f64; 3]>,
    /// The number of triangles that meet in each corner.
    pub(super) meeting: Vec<u32>,
    pub(super) tree: Tree,
    convex: bool,
    mended: Mended,
    file: Option<SurfaceFile>,
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
            + size_of_val(&self.meeting[..])
            + self.tree.memory()
    }

    /// Joins triangles that share corners to the bit. Triangles with two equal corners are left
    /// out; shells whose normals point into the solid are turned.
    ///
    /// # Errors
    /// If the triangles are no closed surface.
    pub fn new(triangles: &[[[f64; 3]; 3]]) -> Result<Self, MeshError> {
        let mut soup = Soup::new(triangles);
        soup.check()?;
        nest(&mut soup)?;
        Ok(Self::closed(soup.corners, soup.triangles))
    }

    /// The same of triangles that are nearly a closed surface, mended as far as particles of a
    /// spacing (m) do not feel it; [`Self::mended`] has the repairs.
    ///
    /// # Errors
    /// If the triangles are far from a closed surface, or parts of it overlap.
    pub fn mend(triangles: &[[[f64; 3]; 3]], spacing: f64) -> Result<Self, MeshError> {
        let mut soup = Soup::new(triangles);
        let mut mended = match soup.check() {
            Ok(()) => Mended::default(),
            Err(_) => mend(&mut soup, spacing)?,
        };
        let (shells, turned) = nest(&mut soup)?;
        check_apart(&soup, &shells)?;
        mended.shells = turned;
        let mut mesh = Self::closed(soup.corners, soup.triangles);
        mesh.mended = mended;
        Ok(mesh)
    }

    /// Says which file it was read from.
    #[must_use]
    pub fn of_file(self, file: SurfaceFile) -> Self {
        let file = Some(file);
        Self { file, ..self }
    }

    /// The file that it was read from.
    #[must_use]
    pub fn file(&self) -> Option<&SurfaceFile> {
        self.file.as_ref()
    }

    /// The repairs.
    #[must_use]
    pub fn mended(&self) -> &Mended {
        &self.mended
    }

    /// The mesh of a closed surface whose normals point outwards.
    pub(super) fn closed(corners: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let at = |t: &[u32; 3]| t.map(|c| corners[c as usize]);
        let unit = |v: [f64; 3]| along(&v, dot(&v, &v).sqrt());
        let faces: Vec<[f64; 3]> = triangles
            .iter()
            .map(|t| unit(normal_area(&at(t))))
            .collect();
        let edges_of = edges(&triangles);
        let mut vertices = vec![[0.0; 3]; corners.len()];
        let mut meeting = vec![0; corners.len()];
        let mut edges = Vec::with_capacity(triangles.len());
        for (t, face) in triangles.iter().zip(&faces) {
            let x = at(t);
            for k in 0..3 {
                meeting[t[k] as usize] += 1;
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
            meeting,
            tree,
            convex,
            corners,
            triangles,
            faces,
            edges,
            mended: Mended::default(),
            file: None,
        }
    }

    /// The nearest place from `x` (m), if it is not farther than `limit` (m).
    #[must_use]
    pub fn foot(&self, x: &[f64; 3], limit: f64) -> Option<Foot> {
        let mut best = (limit * limit, u32::MAX, [0.0; 3], Feature::Face);
        self.tree.near(x, best.0, |t| {
            let (point, feature) = closest_on_triangle(&self.at(t), x);
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
        let pseudo = self.pseudo_normal(t, feature);
        if feature == Feature::Face {
            let gap = dot(&r, &pseudo);
            return Some(Foot {
                normal: pseudo,
                gap,
            });
        }
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

    /// The normal that separates the sides of a part of a triangle.
    pub(super) fn pseudo_normal(&self, triangle: usize, feature: Feature) -> [f64; 3] {
        match feature {
            Feature::Face => self.faces[triangle],
            Feature::Edge(k) => self.edges[triangle][k],
            Feature::Corner(k) => self.vertices[self.triangles[triangle][k] as usize],
        }
    }

    /// The corners of a triangle (m).
    pub(super) fn at(&self, triangle: u32) -> [[f64; 3]; 3] {
        self.triangles[triangle as usize].map(|c| self.corners[c as usize])
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

    /// Covariance of the places that it encloses (m²), by the second moments of tetrahedra.
    #[must_use]
    pub fn covariance(&self) -> Matrix3<f64> {
        let (lower, upper) = self.bounds();
        let middle: [f64; 3] = std::array::from_fn(|a| 0.5 * (lower[a] + upper[a]));
        let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Matrix3::zeros());
        for t in &self.triangles {
            let [a, b, c] = t.map(|c| Vec3::from(minus(&self.corners[c as usize], &middle)));
            let (part, sum) = (a.dot(&b.cross(&c)) / 6.0, a + b + c);
            volume += part;
            first += sum * (part / 4.0);
            let corners = [a, b, c, sum].map(|x| x * x.transpose());
            second += corners.iter().sum::<Matrix3<f64>>() * (part / 20.0);
        }
        let mean = first / volume;
        second / volume - mean * mean.transpose()
    }

    /// `true` if the surface is convex.
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

/// Angle at `a` between `b` and `c` (rad).
fn angle(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3]) -> f64 {
    let (ab, ac) = (minus(b, a), minus(c, a));
    let across = cross(&ab, &ac);
    libm::atan2(dot(&across, &across).sqrt(), dot(&ab, &ac))
}

#[cfg(test)]
mod tests;
