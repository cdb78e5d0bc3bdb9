//! Forms of solids in their own frames: about the origin, round ones about z.

use std::sync::Arc;

use super::ellipsoid;
use super::polygon::{Nearest, Polygon};
use crate::{Cloud, Mesh, Vec3};

/// A solid before it is turned and moved. In two dimensions z does not count.
#[derive(Debug, Clone, PartialEq)]
pub enum Primitive {
    /// Box of half edges (m); infinite along z in two dimensions.
    Box(Vec3),
    /// Ball or disc of a radius (m).
    Ball(f64),
    /// Ellipsoid of semi-axes (m); infinite along z in two dimensions.
    Ellipsoid(Vec3),
    /// Solid of revolution about z of a polygon of (r, z), r ≥ 0: cylinder, tube, cone, frustum.
    Revolved(Polygon),
    /// Ring of a radius, as thick as a circle of another radius (m).
    Torus {
        /// From the axis to the middle of the circle.
        radius: f64,
        /// Of the circle.
        tube: f64,
    },
    /// Pointed nose with its tip at larger z on a shank that ends at z = −`shank`.
    Ogive {
        /// Radius of the shank (m).
        radius: f64,
        /// Radius of the arc whose turn about z is the nose (m).
        arc: f64,
        /// Length of the nose (m).
        nose: f64,
        /// Length of the shank (m).
        shank: f64,
    },
    /// Prism of a polygon of (x, y), of half a length along z (m); infinite in two dimensions.
    Prism {
        /// Its section.
        section: Polygon,
        /// Half its length.
        half: f64,
    },
    /// Closed surface of triangles.
    Mesh(Arc<Mesh>),
    /// Particles that a file gives.
    Cloud(Arc<Cloud>),
}

/// Takes faces: depth below one (m), and the unit normal out of it.
pub type Faces<'a> = &'a mut dyn FnMut(f64, Vec3);

/// Edges on the axis of a solid of revolution are inside it.
fn is_surface(edge: &[[f64; 2]; 2]) -> bool {
    edge[0][0] > 0.0 || edge[1][0] > 0.0
}

impl Primitive {
    /// Distance (m) of a point from the surface, negative inside.
    #[must_use]
    pub fn distance(&self, p: &Vec3) -> f64 {
        match self {
            Self::Box(half) => {
                let beyond = p.abs() - half;
                beyond.map(|b| b.max(0.0)).norm() + beyond.max().min(0.0)
            }
            Self::Ball(radius) => p.norm() - radius,
            Self::Ellipsoid(semi) => ellipsoid::distance(semi, p),
            Self::Revolved(profile) => profile.distance([libm::hypot(p.x, p.y), p.z], is_surface),
            Self::Torus { radius, tube } => libm::hypot(libm::hypot(p.x, p.y) - radius, p.z) - tube,
            Self::Ogive { shank, .. } => joined(self.lateral(p).0, -shank - p.z),
            Self::Prism { section, half } => {
                let across = section.distance([p.x, p.y], |_| true);
                joined(across, p.z.abs() - half)
            }
            Self::Mesh(mesh) => mesh.distance(&(*p).into()),
            Self::Cloud(cloud) => cloud.distance(p),
        }
    }

    /// Tells the faces that a point inside lies less than `reach` (m) below.
    pub fn faces(&self, p: &Vec3, reach: f64, emit: Faces) {
        match self {
            Self::Box(half) => {
                for a in 0..3 {
                    let depth = half[a] - p[a].abs();
                    if depth < reach {
                        let mut normal = Vec3::zeros();
                        normal[a] = 1.0_f64.copysign(p[a]);
                        emit(depth, normal);
                    }
                }
            }
            Self::Revolved(profile) => {
                let radius = libm::hypot(p.x, p.y);
                profile.near_edges([radius, p.z], reach, is_surface, |near| {
                    let Nearest { distance, way } = near;
                    emit(distance, around(p, radius, way));
                });
            }
            Self::Ogive { shank, .. } => {
                let (lateral, way) = self.lateral(p);
                if -lateral < reach {
                    emit(-lateral, around(p, libm::hypot(p.x, p.y), way));
                }
                if shank + p.z < reach {
                    emit(shank + p.z, -Vec3::z());
                }
            }
            Self::Prism { section, half } => {
                section.near_edges(
                    [p.x, p.y],
                    reach,
                    |_| true,
                    |near| {
                        emit(near.distance, Vec3::new(near.way[0], near.way[1], 0.0));
                    },
                );
                let depth = half - p.z.abs();
                if depth < reach {
                    emit(depth, Vec3::z() * 1.0_f64.copysign(p.z));
                }
            }
            Self::Mesh(mesh) => {
                let x = (*p).into();
                mesh.faces(&x, reach, &mut |depth, normal| emit(depth, normal.into()));
            }
            Self::Ball(_) | Self::Ellipsoid(_) | Self::Torus { .. } | Self::Cloud(_) => {
                let depth = -self.distance(p);
                if depth < reach {
                    emit(depth, self.outward(p));
                }
            }
        }
    }

    /// Distance (m) of a point from the round side of an ogive as if that went on below its end,
    /// and the way out of it in (r, z).
    fn lateral(&self, p: &Vec3) -> (f64, [f64; 2]) {
        let Self::Ogive {
            radius, arc, nose, ..
        } = *self
        else {
            return (f64::INFINITY, [1.0, 0.0]);
        };
        let r = libm::hypot(p.x, p.y);
        if p.z <= 0.0 {
            return (r - radius, [1.0, 0.0]);
        }
        // From the centre of the arc.
        let from = [r - (radius - arc), p.z];
        let length = libm::hypot(from[0], from[1]);
        let tip = [arc - radius, nose];
        if from[0] * tip[1] < from[1] * tip[0] {
            // Beyond the tip.
            let off = [r, p.z - nose];
            let distance = libm::hypot(off[0], off[1]);
            let way = if distance > 0.0 {
                off.map(|c| c / distance)
            } else {
                [0.0, 1.0]
            };
            return (distance, way);
        }
        (length - arc, from.map(|c| c / length))
    }

    /// Unit vector out of the surface at a point near it.
    #[must_use]
    pub fn outward(&self, p: &Vec3) -> Vec3 {
        let way = match self {
            Self::Ball(_) => *p,
            Self::Ellipsoid(semi) => {
                let at = ellipsoid::nearest(semi, p);
                Vec3::from_fn(|a, _| at[a] / (semi[a] * semi[a]))
            }
            Self::Torus { radius, .. } => {
                let r = libm::hypot(p.x, p.y);
                return around(p, r, unit([r - radius, p.z]));
            }
            Self::Mesh(mesh) => {
                let foot = mesh.foot(&(*p).into(), f64::INFINITY);
                foot.map_or_else(Vec3::z, |foot| foot.normal.into())
            }
            _ => {
                let (lower, upper) = self.bounds();
                let size = upper - lower;
                let finite = size.iter().copied().filter(|c| c.is_finite());
                let step = 1e-6 * finite.fold(0.0, f64::max);
                Vec3::from_fn(|a, _| {
                    let mut aside = Vec3::zeros();
                    aside[a] = step;
                    self.distance(&(p + aside)) - self.distance(&(p - aside))
                })
            }
        };
        way.try_normalize(0.0).unwrap_or_else(Vec3::z)
    }

    /// Volume (m³), or area (m²) in two dimensions.
    #[must_use]
    pub fn volume(&self, dimension: usize) -> f64 {
        use std::f64::consts::PI;
        let flat = dimension == 2;
        match self {
            Self::Box(half) if flat => 4.0 * half.x * half.y,
            Self::Box(half) => 8.0 * half.x * half.y * half.z,
            Self::Ball(r) if flat => PI * r * r,
            Self::Ball(r) => 4.0 / 3.0 * PI * r * r * r,
            Self::Ellipsoid(semi) if flat => PI * semi.x * semi.y,
            Self::Ellipsoid(semi) => 4.0 / 3.0 * PI * semi.x * semi.y * semi.z,
            Self::Revolved(profile) => profile.swept_volume(),
            Self::Torus { radius, tube } => 2.0 * PI * PI * radius * tube * tube,
            &Self::Ogive {
                radius,
                arc,
                nose,
                shank,
            } => {
                // ∫ π r² dz with r = √(arc² − z²) − (arc − radius).
                let off = arc - radius;
                let wedge = 0.5
                    * (nose * (arc * arc - nose * nose).max(0.0).sqrt()
                        + arc * arc * libm::asin((nose / arc).min(1.0)));
                let squares = (arc * arc + off * off) * nose - nose * nose * nose / 3.0;
                PI * (squares - 2.0 * off * wedge) + PI * radius * radius * shank
            }
            Self::Prism { section, .. } if flat => section.area(),
            Self::Prism { section, half } => 2.0 * half * section.area(),
            Self::Mesh(mesh) => mesh.volume(),
            Self::Cloud(cloud) => cloud.volume(),
        }
    }

    /// Corners of a box around the form (m).
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let both = |v: Vec3| (-v, v);
        match self {
            Self::Box(half) => both(*half),
            Self::Ball(r) => both(Vec3::repeat(*r)),
            Self::Ellipsoid(semi) => both(*semi),
            Self::Revolved(profile) => {
                let (lower, upper) = profile.bounds();
                let r = upper[0];
                (Vec3::new(-r, -r, lower[1]), Vec3::new(r, r, upper[1]))
            }
            Self::Torus { radius, tube } => both(Vec3::new(radius + tube, radius + tube, *tube)),
            Self::Ogive {
                radius: r,
                nose,
                shank,
                ..
            } => (Vec3::new(-r, -r, -shank), Vec3::new(*r, *r, *nose)),
            Self::Prism { section, half } => {
                let (lower, upper) = section.bounds();
                (
                    Vec3::new(lower[0], lower[1], -half),
                    Vec3::new(upper[0], upper[1], *half),
                )
            }
            Self::Mesh(mesh) => {
                let (lower, upper) = mesh.bounds();
                (lower.into(), upper.into())
            }
            Self::Cloud(cloud) => {
                let (lower, upper) = cloud.bounds();
                (lower.into(), upper.into())
            }
        }
    }
}

/// Distance from the intersection of two solids whose faces meet at right angles.
fn joined(a: f64, b: f64) -> f64 {
    libm::hypot(a.max(0.0), b.max(0.0)) + a.max(b).min(0.0)
}

fn unit(v: [f64; 2]) -> [f64; 2] {
    let length = libm::hypot(v[0], v[1]);
    if length > 0.0 {
        v.map(|c| c / length)
    } else {
        [1.0, 0.0]
    }
}

/// A direction in (r, z) at a point of radius `r` (m).
fn around(p: &Vec3, r: f64, way: [f64; 2]) -> Vec3 {
    let out = if r > 0.0 {
        [p.x / r, p.y / r]
    } else {
        [1.0, 0.0]
    };
    Vec3::new(way[0] * out[0], way[0] * out[1], way[1])
}
