//! The distance of a point from a shape, and the extent of a shape.

use super::{Shape, Vec3};

impl Shape {
    /// Distance (m) of a point from the surface, negative inside. Axes beyond the dimension do not
    /// count.
    #[must_use]
    pub fn distance(&self, point: &Vec3, dimension: usize) -> f64 {
        match self {
            Self::Box { lower, upper } => {
                let mut beyond = Vec3::zeros();
                let mut deepest = f64::NEG_INFINITY;
                for a in 0..dimension {
                    let outside = (lower[a] - point[a]).max(point[a] - upper[a]);
                    beyond[a] = outside.max(0.0);
                    deepest = deepest.max(outside);
                }
                beyond.norm() + deepest.min(0.0)
            }
            Self::Sphere { centre, radius } => (point - centre).norm() - radius,
            Self::Shell {
                centre,
                radius,
                inner_radius,
            } => {
                let r = (point - centre).norm();
                (r - radius).max(inner_radius - r)
            }
            Self::Cylinder {
                centre,
                axis,
                radius,
                length,
            } => {
                let offset = point - centre;
                let along = offset[axis.index()];
                let across = (offset.norm_squared() - along * along).max(0.0).sqrt() - radius;
                let along = along.abs() - 0.5 * length;
                let outside = f64::hypot(across.max(0.0), along.max(0.0));
                outside + across.max(along).min(0.0)
            }
            Self::Solid(solid) => solid.distance(point),
        }
    }

    /// The least [`Self::distance`] (m) in the box between two corners (m).
    #[must_use]
    pub fn least_distance(&self, lower: &[f64; 3], upper: &[f64; 3], dimension: usize) -> f64 {
        let middle = match self {
            Self::Box { lower, upper } => (lower + upper) * 0.5,
            Self::Sphere { centre, .. }
            | Self::Shell { centre, .. }
            | Self::Cylinder { centre, .. } => *centre,
            Self::Solid(solid) => {
                // It grows no faster than the point moves.
                let [lower, upper] = [lower, upper].map(|corner| Vec3::from(*corner));
                return solid.distance(&((lower + upper) * 0.5)) - 0.5 * (upper - lower).norm();
            }
        };
        // The distance from what is solid grows along each axis away from the middle.
        let nearest = Vec3::from_fn(|a, _| middle[a].clamp(lower[a], upper[a]));
        let Self::Shell {
            radius,
            inner_radius,
            ..
        } = self
        else {
            return self.distance(&nearest, dimension);
        };
        let farthest = Vec3::from_fn(|a, _| (middle[a] - lower[a]).max(upper[a] - middle[a]));
        ((nearest - middle).norm() - radius).max(inner_radius - farthest.norm())
    }

    /// Smallest `n·x` (m) of the shape, for a unit vector n along axes of the dimension.
    #[must_use]
    pub fn lowest(&self, normal: &Vec3) -> f64 {
        match self {
            Self::Box { lower, upper } => (0..3)
                .filter(|&a| normal[a] != 0.0)
                .map(|a| normal[a] * if normal[a] > 0.0 { lower[a] } else { upper[a] })
                .fold(0.0, |sum, part| sum + part),
            Self::Sphere { centre, radius } | Self::Shell { centre, radius, .. } => {
                normal.dot(centre) - radius
            }
            Self::Cylinder {
                centre,
                axis,
                radius,
                length,
            } => {
                let along = normal[axis.index()].abs();
                let across = (1.0 - along * along).max(0.0).sqrt();
                normal.dot(centre) - 0.5 * length * along - radius * across
            }
            Self::Solid(solid) => -solid.support(&-normal),
        }
    }

    /// Extent of the thinnest part (m).
    #[must_use]
    pub fn thickness(&self, dimension: usize) -> f64 {
        match self {
            Self::Box { lower, upper } => (0..dimension)
                .map(|a| upper[a] - lower[a])
                .fold(f64::INFINITY, f64::min),
            Self::Sphere { radius, .. } => 2.0 * radius,
            Self::Shell {
                radius,
                inner_radius,
                ..
            } => radius - inner_radius,
            Self::Cylinder { radius, length, .. } => length.min(2.0 * radius),
            Self::Solid(solid) => {
                let (lower, upper) = solid.bounds();
                let size = upper - lower;
                (0..dimension)
                    .map(|a| size[a])
                    .fold(f64::INFINITY, f64::min)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    #[test]
    fn distances_are_those_of_geometry() {
        let cube = Shape::Box {
            lower: Vec3::zeros(),
            upper: Vec3::new(2.0, 2.0, 2.0),
        };
        let ball = Shape::Sphere {
            centre: Vec3::zeros(),
            radius: 1.0,
        };
        let shell = Shape::Shell {
            centre: Vec3::zeros(),
            radius: 3.0,
            inner_radius: 2.0,
        };
        let rod = Shape::Cylinder {
            centre: Vec3::zeros(),
            axis: Axis::Z,
            radius: 1.0,
            length: 4.0,
        };
        for (shape, point, distance) in [
            (&cube, [1.0, 1.0, 1.75], -0.25),
            (&cube, [5.0, 6.0, 1.0], 5.0),
            (&ball, [0.0, 3.0, 4.0], 4.0),
            (&ball, [0.0; 3], -1.0),
            (&shell, [0.0; 3], 2.0),
            (&shell, [0.0, 2.25, 0.0], -0.25),
            (&rod, [0.0, 0.0, 1.75], -0.25),
            (&rod, [0.0, 4.0, 6.0], 5.0),
            (&rod, [0.0, 0.5, 0.0], -0.5),
        ] {
            assert_eq!(
                shape.distance(&Vec3::from(point), 3),
                distance,
                "{shape:?} {point:?}"
            );
        }
        let point = Vec3::new(1.0, 1.0, 9.0);
        assert_eq!(
            cube.distance(&point, 2),
            -1.0,
            "in a plane z counts nothing"
        );
        let thick = [&cube, &ball, &shell, &rod].map(|shape| shape.thickness(3));
        assert_eq!(thick, [2.0, 2.0, 1.0, 2.0]);
        let slope = Vec3::new(0.0, 0.6, -0.8);
        let low = [&cube, &ball, &shell, &rod].map(|shape| shape.lowest(&slope));
        assert_eq!(
            low,
            [
                -1.6,
                -1.0,
                -3.0,
                -0.5 * 4.0 * 0.8 - (1.0_f64 - 0.8 * 0.8).sqrt()
            ]
        );
    }
}
