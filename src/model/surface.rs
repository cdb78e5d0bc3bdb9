//! Rigid surfaces, which keep particles on one of their sides: planes, spheres, cylinders and
//! closed meshes of triangles.
//!
//! All of them answer one question, [`RigidSurface::foot`]: the nearest place of the surface to a
//! point, and its side. Shapes are given at time zero; a surface moves as a whole, so that points
//! are taken into its frame and the shape never changes.

mod closed;
mod crossing;
mod faces;
mod holes;
mod mend;
mod mesh;
mod shells;
mod soup;
mod tree;
mod triangle;

use std::sync::Arc;

pub use closed::MeshError;
pub use crossing::Crossing;
pub use holes::triangulate;
pub use mend::Mended;
pub use mesh::Mesh;
pub(crate) use tree::Tree;
pub use triangle::{Feature, closest_on_triangle};

use super::{Motion, Resistance};
use numerics::vector::{dot, minus};

/// A rigid surface, which pushes particles that come nearer than half a spacing to its kept side.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidSurface {
    /// Name in reports.
    pub name: String,
    /// Shape and place at time zero.
    pub shape: SurfaceShape,
    /// `true` if particles are kept inside the shape, as in a container, and not outside of it.
    pub inside: bool,
    /// Stiffness κ of the penalty relative to the p-wave modulus.
    pub stiffness: f64,
    /// Friction and damping.
    pub resistance: Resistance,
    /// `true` for each of [`super::Case::bodies`] that it acts on.
    pub bodies: Vec<bool>,
    /// Its motion; fixed on free axes.
    pub motion: Motion,
    /// Its rotation, if it turns.
    pub spin: Option<Spin>,
}

/// A file that holds a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SurfaceFile {
    /// Absolute path.
    pub path: String,
    /// SHA-256 of the content, in hexadecimal digits.
    pub sha256: String,
}

/// Rotation about an axis that moves along with the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Spin {
    /// A point of the axis at time zero (m).
    pub point: [f64; 3],
    /// Unit vector along the axis.
    pub axis: [f64; 3],
    /// Rate (rad/s) as a function of time, in the place of the first axis.
    pub rate: Motion,
}

/// The shape of a rigid surface.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceShape {
    /// Everything on one side of a plane.
    Plane {
        /// Unit normal, to the kept side.
        normal: [f64; 3],
        /// The normal's product with a point of the plane (m).
        position: f64,
    },
    /// Ball; a disc in two dimensions.
    Sphere {
        /// Centre (m).
        centre: [f64; 3],
        /// Radius (m).
        radius: f64,
    },
    /// Circular cylinder with flat ends.
    Cylinder {
        /// Middle of the axis (m).
        centre: [f64; 3],
        /// Unit vector along the axis.
        axis: [f64; 3],
        /// Radius (m).
        radius: f64,
        /// Half its length (m), infinite for one without ends.
        half_length: f64,
    },
    /// Closed mesh of triangles.
    Mesh(Arc<Mesh>),
}

/// The nearest place of a surface, as seen from a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Unit vector along which the distance grows.
    pub normal: [f64; 3],
    /// Distance (m), negative behind the surface.
    pub gap: f64,
}

impl Foot {
    fn turned(self) -> Self {
        Self {
            normal: self.normal.map(|n| -n),
            gap: -self.gap,
        }
    }
}

impl SurfaceShape {
    /// The foot of `x` (m) for what is outside the shape, if it is not farther than `limit` (m).
    fn foot(&self, x: &[f64; 3], limit: f64) -> Option<Foot> {
        let foot = match self {
            Self::Plane { normal, position } => Foot {
                normal: *normal,
                gap: dot(normal, x) - position,
            },
            Self::Sphere { centre, radius } => {
                let r = minus(x, centre);
                let distance = dot(&r, &r).sqrt();
                Foot {
                    normal: along(&r, distance),
                    gap: distance - radius,
                }
            }
            Self::Cylinder {
                centre,
                axis,
                radius,
                half_length,
            } => {
                let r = minus(x, centre);
                let z = dot(&r, axis);
                let out: [f64; 3] = std::array::from_fn(|a| r[a] - z * axis[a]);
                let distance = dot(&out, &out).sqrt();
                let ahead = axis.map(|a| if z < 0.0 { -a } else { a });
                let side = [distance - radius, z.abs() - half_length];
                cylinder(side, &along(&out, distance), &ahead)
            }
            Self::Mesh(mesh) => return mesh.foot(x, limit),
        };
        (foot.gap.abs() <= limit || matches!(self, Self::Plane { .. })).then_some(foot)
    }

    /// `true` if a point that keeps its distance from the nearest place of the surface keeps it
    /// from all others, as outside of a convex shape.
    fn one_foot(&self, inside: bool) -> bool {
        match self {
            Self::Plane { .. } | Self::Sphere { .. } => true,
            Self::Cylinder { half_length, .. } => !inside || half_length.is_infinite(),
            Self::Mesh(mesh) => !inside && mesh.is_convex(),
        }
    }
}

/// A vector over its length; any unit vector if it has none.
fn along(vector: &[f64; 3], length: f64) -> [f64; 3] {
    if length > 0.0 {
        vector.map(|v| v / length)
    } else {
        [1.0, 0.0, 0.0]
    }
}

/// The foot on a cylinder of a point that is `side` beyond its mantle and its end (m), which lie
/// towards `out` and `ahead`.
fn cylinder(side: [f64; 2], out: &[f64; 3], ahead: &[f64; 3]) -> Foot {
    let [mantle, end] = side;
    if mantle > 0.0 && end > 0.0 {
        let gap = (mantle * mantle + end * end).sqrt();
        let normal = std::array::from_fn(|a| (mantle * out[a] + end * ahead[a]) / gap);
        return Foot { normal, gap };
    }
    if mantle >= end {
        Foot {
            normal: *out,
            gap: mantle,
        }
    } else {
        Foot {
            normal: *ahead,
            gap: end,
        }
    }
}

impl RigidSurface {
    /// The nearest place of the surface at time zero from `x` (m), if it is not farther than
    /// `limit` (m). A plane has one at any distance.
    #[inline]
    #[must_use]
    pub fn foot(&self, x: &[f64; 3], limit: f64) -> Option<Foot> {
        let foot = self.shape.foot(x, limit);
        if self.inside {
            foot.map(Foot::turned)
        } else {
            foot
        }
    }

    /// `true` if a particle at its distance from the nearest place is so from all others.
    #[must_use]
    pub fn one_foot(&self) -> bool {
        self.shape.one_foot(self.inside)
    }

    /// Smallest and largest coordinates (m) of the surface at time zero; infinite where it is.
    #[must_use]
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let about = |centre: &[f64; 3], reach: [f64; 3]| {
            let lower = std::array::from_fn(|a| centre[a] - reach[a]);
            (lower, std::array::from_fn(|a| centre[a] + reach[a]))
        };
        match &self.shape {
            SurfaceShape::Plane { .. } => ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]),
            SurfaceShape::Sphere { centre, radius } => about(centre, [*radius; 3]),
            SurfaceShape::Cylinder {
                centre,
                axis,
                radius,
                half_length,
            } => {
                let reach = axis.map(|a| {
                    let across = radius * (1.0 - a * a).max(0.0).sqrt();
                    if a == 0.0 {
                        across
                    } else {
                        across + half_length * a.abs()
                    }
                });
                about(centre, reach)
            }
            SurfaceShape::Mesh(mesh) => mesh.bounds(),
        }
    }

    /// The least [`Self::gap`] (m) in the box between two corners (m).
    #[must_use]
    pub fn least_gap(&self, lower: &[f64; 3], upper: &[f64; 3], limit: f64) -> f64 {
        if let SurfaceShape::Plane { normal, .. } = &self.shape {
            let towards = |a: usize| {
                let up = (normal[a] > 0.0) != self.inside;
                if up { lower[a] } else { upper[a] }
            };
            return self.gap(&std::array::from_fn(towards), limit);
        }
        let (own_lower, own_upper) = self.bounds();
        let far =
            (0..3).any(|a| upper[a] < own_lower[a] - limit || lower[a] > own_upper[a] + limit);
        if far && !self.inside {
            return f64::INFINITY;
        }
        let middle: [f64; 3] = std::array::from_fn(|a| 0.5 * (lower[a] + upper[a]));
        let half: [f64; 3] = std::array::from_fn(|a| 0.5 * (upper[a] - lower[a]));
        // The distance changes by no more than the way.
        self.foot(&middle, f64::INFINITY)
            .map_or(f64::INFINITY, |foot| foot.gap)
            - dot(&half, &half).sqrt()
    }

    /// Distance of a place (m) from the surface at time zero, positive on the side that it keeps;
    /// infinite where it is surely more than `limit` (m).
    #[must_use]
    pub fn gap(&self, x: &[f64; 3], limit: f64) -> f64 {
        let (lower, upper) = self.bounds();
        let far = (0..3).any(|a| x[a] < lower[a] - limit || x[a] > upper[a] + limit);
        if far && !self.inside {
            return f64::INFINITY;
        }
        self.foot(x, f64::INFINITY)
            .map_or(f64::INFINITY, |foot| foot.gap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At rest, for all bodies.
    pub(super) fn surface(shape: SurfaceShape, inside: bool) -> RigidSurface {
        RigidSurface {
            name: String::new(),
            shape,
            inside,
            stiffness: 2.0,
            resistance: Resistance::default(),
            bodies: Vec::new(),
            motion: Motion::default(),
            spin: None,
        }
    }

    pub(super) fn near(foot: Foot, normal: [f64; 3], gap: f64) {
        assert!((foot.gap - gap).abs() < 1e-14, "{foot:?}, gap {gap}");
        for a in 0..3 {
            assert!(
                (foot.normal[a] - normal[a]).abs() < 1e-14,
                "{foot:?}, normal {normal:?}"
            );
        }
    }

    #[test]
    fn spheres_keep_inside_or_outside() {
        let ball = SurfaceShape::Sphere {
            centre: [1.0, 0.0, 0.0],
            radius: 2.0,
        };
        let out = surface(ball.clone(), false);
        near(
            out.foot(&[1.0, 5.0, 0.0], 4.0).unwrap(),
            [0.0, 1.0, 0.0],
            3.0,
        );
        near(
            out.foot(&[1.0, 0.0, -0.5], 4.0).unwrap(),
            [0.0, 0.0, -1.0],
            -1.5,
        );
        assert!(out.foot(&[1.0, 5.0, 0.0], 2.9).is_none());
        let inner = surface(ball, true);
        near(
            inner.foot(&[1.0, 1.5, 0.0], 4.0).unwrap(),
            [0.0, -1.0, 0.0],
            0.5,
        );
    }

    #[test]
    fn cylinders_have_mantles_ends_and_rims() {
        let shape = |half_length| SurfaceShape::Cylinder {
            centre: [0.0; 3],
            axis: [0.0, 0.0, 1.0],
            radius: 1.0,
            half_length,
        };
        let rod = surface(shape(2.0), false);
        near(
            rod.foot(&[0.0, 1.5, 1.0], 9.0).unwrap(),
            [0.0, 1.0, 0.0],
            0.5,
        );
        near(
            rod.foot(&[0.2, 0.0, -2.5], 9.0).unwrap(),
            [0.0, 0.0, -1.0],
            0.5,
        );
        near(
            rod.foot(&[1.3, 0.0, 2.4], 9.0).unwrap(),
            [0.6, 0.0, 0.8],
            0.5,
        );
        near(
            rod.foot(&[0.9, 0.0, 1.5], 9.0).unwrap(),
            [1.0, 0.0, 0.0],
            -0.1,
        );
        near(
            rod.foot(&[0.1, 0.0, 1.95], 9.0).unwrap(),
            [0.0, 0.0, 1.0],
            -0.05,
        );
        assert!(rod.one_foot() && !surface(shape(2.0), true).one_foot());
        let pipe = surface(shape(f64::INFINITY), true);
        near(
            pipe.foot(&[0.0, 0.7, 99.0], 9.0).unwrap(),
            [0.0, -1.0, 0.0],
            0.3,
        );
        assert!(pipe.one_foot());
        let (lower, upper) = rod.bounds();
        assert_eq!((lower, upper), ([-1.0, -1.0, -2.0], [1.0, 1.0, 2.0]));
    }
}
