//! The volume that a shape has, beside that of the particles which fill it.

use std::f64::consts::PI;

use crate::model::{Axis, Body, Shape, SymmetryPlane};

/// Planes nearer to a centre than this, over the shape's reach, go through it.
const ROUNDING: f64 = 1e-9;

/// Volume (m³; m² or m in two or one dimensions) of a body's shape above all symmetry planes. Nothing
/// where a plane cuts a round shape other than through its middle.
#[must_use]
pub fn above(body: &Body, dimension: usize, planes: &[SymmetryPlane]) -> Option<f64> {
    let shape = &body.shape;
    if let Shape::Box { lower, upper } = shape {
        let low = |a: usize| {
            let own = planes.iter().filter(|plane| plane.axis.index() == a);
            own.fold(lower[a], |low, plane| low.max(plane.position))
        };
        return Some(
            (0..dimension)
                .map(|a| (upper[a] - low(a)).max(0.0))
                .product(),
        );
    }
    let ball = |r: f64| match dimension {
        2 => PI * r * r,
        _ => 4.0 / 3.0 * PI * r * r * r,
    };
    let (whole, along, half_length) = if let Shape::Sphere { radius, .. } = shape {
        (ball(*radius), None, 0.0)
    } else if let Shape::Shell {
        radius,
        inner_radius,
        ..
    } = shape
    {
        (ball(*radius) - ball(*inner_radius), None, 0.0)
    } else if let Shape::Cylinder {
        axis,
        radius,
        length,
        ..
    } = shape
    {
        (PI * radius * radius * length, Some(*axis), 0.5 * length)
    } else {
        return None;
    };
    let (centre, reach) = (shape.centre(), shape.reach());
    let share = |plane: &SymmetryPlane| {
        let beyond = plane.position - centre[plane.axis.index()];
        if along.is_some_and(|axis: Axis| axis == plane.axis) {
            // Slices of a cylinder are alike.
            return Some((0.5 * (1.0 - beyond / half_length)).clamp(0.0, 1.0));
        }
        match beyond {
            x if x.abs() <= ROUNDING * reach => Some(0.5),
            x if x <= -reach => Some(1.0),
            x if x >= reach => Some(0.0),
            _ => None,
        }
    };
    planes
        .iter()
        .try_fold(whole, |volume, plane| Some(volume * share(plane)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Lattice, LatticeKind, Vec3};

    fn body(shape: Shape) -> Body {
        Body {
            name: "body".into(),
            shape,
            material: 0,
            lattice: Lattice {
                kind: LatticeKind::Cubic,
                spacing: 1.0,
                angle: 0.0,
            },
            density: None,
            specific_energy: None,
            velocity: Vec3::zeros(),
            angular_velocity: Vec3::zeros(),
            rigid: None,
            smoothing_length: 1.3,
        }
    }

    fn plane(axis: Axis, position: f64) -> SymmetryPlane {
        SymmetryPlane { axis, position }
    }

    #[test]
    fn what_planes_leave_of_shapes() {
        let is = |shape: &Shape, dimension, planes: &[SymmetryPlane], volume: Option<f64>| {
            let found = above(&body(shape.clone()), dimension, planes);
            let same = match (found, volume) {
                (Some(a), Some(b)) => (a - b).abs() <= 1e-12 * b.abs(),
                (a, b) => a == b,
            };
            assert!(same, "{shape:?} {planes:?}: {found:?} {volume:?}");
        };
        let brick = Shape::Box {
            lower: Vec3::new(-1.0, 0.0, 2.0),
            upper: Vec3::new(3.0, 2.0, 5.0),
        };
        is(&brick, 3, &[], Some(24.0));
        is(&brick, 2, &[plane(Axis::X, 0.0)], Some(6.0));
        is(&brick, 1, &[plane(Axis::X, -2.0)], Some(4.0));
        let centre = Vec3::new(0.0, 0.0, 5.0);
        let sphere = Shape::Sphere {
            centre,
            radius: 2.0,
        };
        let quarter = [plane(Axis::X, 0.0), plane(Axis::Y, 0.0)];
        is(&sphere, 3, &quarter, Some(8.0 / 3.0 * PI));
        is(&sphere, 3, &[plane(Axis::Z, 1.0)], Some(32.0 / 3.0 * PI));
        is(&sphere, 3, &[plane(Axis::Z, 4.0)], None);
        is(&sphere, 2, &[plane(Axis::X, 0.0)], Some(2.0 * PI));
        let shell = Shape::Shell {
            centre,
            radius: 2.0,
            inner_radius: 1.0,
        };
        is(&shell, 2, &[], Some(3.0 * PI));
        let rod = Shape::Cylinder {
            centre,
            axis: Axis::Z,
            radius: 1.0,
            length: 4.0,
        };
        is(&rod, 3, &[plane(Axis::Z, 4.0)], Some(3.0 * PI));
        is(&rod, 3, &quarter, Some(PI));
    }
}
