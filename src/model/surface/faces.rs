//! Several faces of a mesh near a point, its extent, and the volume above planes.

use super::Mesh;
use super::triangle::{Feature, closest_on_triangle};
use numerics::vector::{cross, dot, minus};

/// Faces whose normals have at least this product (26°) are parts of one that is curved.
const SAME_FACE: f64 = 0.9;

/// The closest place of a triangle.
struct Near {
    square: f64,
    triangle: u32,
    point: [f64; 3],
    feature: Feature,
}

/// An edge by its two ends, or a corner.
type Ridge = (u32, Option<u32>);

impl Mesh {
    /// Passes the faces that a point inside lies less than `reach` (m) below to `emit`: depth (m),
    /// and the unit normal out of the surface. Each is a place that is nearer than all others
    /// around it, and those next to each other of nearly the same direction are one. Of a point
    /// outside it passes the nearest face, with a negative depth.
    pub fn faces(&self, x: &[f64; 3], reach: f64, emit: &mut dyn FnMut(f64, [f64; 3])) {
        let near = self.near(x, reach);
        // Edges and corners that are the nearest place of all triangles that meet in them.
        let mut ridges: Vec<Ridge> = near.iter().filter_map(|n| self.ridge(n)).collect();
        ridges.sort_unstable();
        let is_least = |near: &Near| {
            let Some(ridge) = self.ridge(near) else {
                return true;
            };
            let first = ridges.partition_point(|other| *other < ridge);
            let alike = ridges[first..].iter().take_while(|other| **other == ridge);
            let all = match ridge {
                (_, Some(_)) => 2,
                (corner, None) => self.meeting[corner as usize] as usize,
            };
            alike.count() == all
        };
        let mut emitted: Vec<[f64; 3]> = Vec::new();
        for (n, near) in near.iter().enumerate() {
            let pseudo = self.pseudo_normal(near.triangle as usize, near.feature);
            let way = minus(&near.point, x);
            let (depth, rise) = (near.square.sqrt(), dot(&way, &pseudo));
            let normal = match near.feature {
                Feature::Face => pseudo,
                _ if rise == 0.0 => pseudo,
                _ => way.map(|w| if rise > 0.0 { w / depth } else { -w / depth }),
            };
            if n == 0 && rise < 0.0 {
                emit(-depth, normal);
                return;
            }
            let is_new = || emitted.iter().all(|other| dot(other, &normal) < SAME_FACE);
            if n == 0 || (rise > 0.0 && is_new() && is_least(near)) {
                emit(depth, normal);
                emitted.push(normal);
            }
        }
    }

    /// The closest places of the triangles within reach (m), nearest first.
    fn near(&self, x: &[f64; 3], reach: f64) -> Vec<Near> {
        let limit = reach * reach;
        let mut near = Vec::new();
        self.tree.near(x, limit, |triangle| {
            let (point, feature) = closest_on_triangle(&self.at(triangle), x);
            let r = minus(x, &point);
            let square = dot(&r, &r);
            if square < limit {
                near.push(Near {
                    square,
                    triangle,
                    point,
                    feature,
                });
            }
            limit
        });
        near.sort_unstable_by(|a, b| {
            (a.square.total_cmp(&b.square)).then(a.triangle.cmp(&b.triangle))
        });
        near
    }

    /// The edge or corner that is closest.
    fn ridge(&self, near: &Near) -> Option<Ridge> {
        let t = self.triangles[near.triangle as usize];
        match near.feature {
            Feature::Face => None,
            Feature::Edge(k) => {
                let (a, b) = super::soup::undirected(t[k], t[(k + 1) % 3]);
                Some((a, Some(b)))
            }
            Feature::Corner(k) => Some((t[k], None)),
        }
    }

    /// Least distance (m) of a point from the surface: that from its box, zero inside.
    #[must_use]
    pub fn distance_of_box(&self, x: &[f64; 3]) -> f64 {
        let (lower, upper) = self.bounds();
        let beyond: [f64; 3] =
            std::array::from_fn(|a| (lower[a] - x[a]).max(x[a] - upper[a]).max(0.0));
        dot(&beyond, &beyond).sqrt()
    }

    /// The largest `n·x` (m) of the surface, for a vector `n`.
    #[must_use]
    pub fn support(&self, n: &[f64; 3]) -> f64 {
        self.tree.farthest(n, |t| {
            let products = self.at(t).map(|x| dot(n, &x));
            products[0].max(products[1]).max(products[2])
        })
    }

    /// Volume (m³) of what lies above planes at right angles to each other: `n·x` at least so many
    /// metres, for unit vectors `n`.
    #[must_use]
    pub fn volume_above(&self, planes: &[([f64; 3], f64)]) -> f64 {
        let (lower, upper) = self.bounds();
        let mut origin: [f64; 3] = std::array::from_fn(|a| 0.5 * (lower[a] + upper[a]));
        // Faces of the cut, which lie in planes through the origin, add nothing (Gauss).
        for (n, at) in planes {
            let way = at - dot(n, &origin);
            origin = std::array::from_fn(|a| origin[a] + way * n[a]);
        }
        let mut volume = 0.0;
        for t in 0..self.triangles.len() {
            let mut left: Vec<[f64; 3]> = Vec::with_capacity(6);
            left.extend(self.triangles[t].map(|c| minus(&self.corners[c as usize], &origin)));
            for (n, _) in planes {
                left = cut(&left, n);
            }
            if let [first, others @ ..] = &left[..] {
                for pair in others.windows(2) {
                    volume += dot(first, &cross(&pair[0], &pair[1])) / 6.0;
                }
            }
        }
        volume
    }
}

/// The part of a convex polygon above a plane through the origin.
fn cut(polygon: &[[f64; 3]], n: &[f64; 3]) -> Vec<[f64; 3]> {
    let mut left = Vec::with_capacity(polygon.len() + 1);
    let next = polygon.iter().cycle().skip(1);
    for (a, b) in polygon.iter().zip(next) {
        let (above, other) = (dot(n, a), dot(n, b));
        if above >= 0.0 {
            left.push(*a);
        }
        if (above < 0.0) != (other < 0.0) {
            let part = above / (above - other);
            left.push(std::array::from_fn(|k| a[k] + part * (b[k] - a[k])));
        }
    }
    left
}
