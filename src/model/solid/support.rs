//! The extent of primitives along a direction.

use super::Primitive;
use crate::Vec3;

impl Primitive {
    /// The largest `n·x` (m) of the form in its own frame, for a vector `n`; infinite along an axis
    /// along which it has no end.
    #[must_use]
    pub fn support(&self, n: &Vec3) -> f64 {
        let around = libm::hypot(n.x, n.y);
        // Infinite extents do not count in directions without a component.
        let along = |length: f64, part: f64| if part == 0.0 { 0.0 } else { length * part };
        match self {
            Self::Box(half) => (0..3).map(|a| along(half[a], n[a].abs())).fold(0.0, plus),
            Self::Ball(radius) => radius * n.norm(),
            Self::Ellipsoid(semi) => Vec3::from_fn(|a, _| along(semi[a], n[a])).norm(),
            Self::Revolved(profile) => {
                let corners = profile.corners().iter();
                let farthest = corners.map(|[r, z]| r * around + z * n.z);
                farthest.fold(f64::NEG_INFINITY, f64::max)
            }
            Self::Torus { radius, tube } => radius * around + tube * n.norm(),
            &Self::Ogive {
                radius,
                arc,
                nose,
                shank,
            } => {
                if n.z <= 0.0 {
                    return radius * around - shank * n.z;
                }
                // The arc's centre lies `off` beyond the axis, which the tip cuts it off at.
                let (off, length) = (arc - radius, n.norm());
                if arc * around >= off * length {
                    arc * length - off * around
                } else {
                    nose * n.z
                }
            }
            Self::Prism { section, half } => {
                let corners = section.corners().iter();
                let farthest = corners.map(|[x, y]| x * n.x + y * n.y);
                farthest.fold(f64::NEG_INFINITY, f64::max) + along(*half, n.z.abs())
            }
            Self::Mesh(mesh) => mesh.support(&(*n).into()),
            Self::Cloud(cloud) => cloud.support(n),
        }
    }
}

fn plus(a: f64, b: f64) -> f64 {
    a + b
}
