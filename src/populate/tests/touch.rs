//! Distances of bodies in touch, and their touching values.

use super::*;
use numerics::kernel::Kernel;

#[test]
fn touch_leaves_one_mean_spacing() {
    let plate = body(plate(Axis::Z), LatticeKind::Cubic, 0.02, 0.0);
    for (kind, forward) in KINDS.into_iter().flat_map(|k| [(k, false), (k, true)]) {
        let mut sphere = body(ball(0.3), kind, 0.03, 0.2);
        let moved = touching_distance(&sphere, &plate, 3, Axis::Z, forward).unwrap();
        let Shape::Sphere { centre, .. } = &mut sphere.shape else {
            unreachable!()
        };
        centre.z += moved;
        let (a, b) = (bounds(&sphere, 3).unwrap(), bounds(&plate, 3).unwrap());
        let gap = if forward {
            b.0[2] - a.1[2]
        } else {
            a.0[2] - b.1[2]
        };
        assert!((gap - 0.025).abs() < 1e-15);
    }
}

/// The table of the theory (physics section 5), four digits.
#[test]
fn touching_values_of_cubic_lattices() {
    let table = [
        (1, [0.1667, 0.2231, 0.2453, 0.2798]),
        (2, [0.1594, 0.2152, 0.2367, 0.2734]),
        (3, [0.1497, 0.2088, 0.2294, 0.2668]),
    ];
    for (dimension, row) in table {
        for (ratio, expected) in [1.0, 1.2, 1.3, 1.5].into_iter().zip(row) {
            let mut b = body(ball(1.0), LatticeKind::Cubic, 0.02e-3, 0.0);
            b.smoothing_length = ratio * b.lattice.spacing;
            let value = touching_value(&b, &b, dimension);
            assert!(
                (value - expected).abs() < 5.1e-5,
                "{dimension} {ratio}: {value}"
            );
        }
    }
}

/// The half-space sum must agree with the sites that a body in touch really has in front of it.
#[test]
fn touching_values_agree_with_real_bodies() {
    for kind in KINDS {
        for dimension in [2, 3] {
            let wall = body(block([-6.0; 3], [6.0; 3]), kind, 1.0, 0.0);
            let normal = dimension - 1;
            let top = bounds(&wall, dimension).unwrap().1[normal];
            let middle = sites(&wall, dimension, &[], None)
                .filter(|s| s.position[normal].to_bits() == top.to_bits())
                .map(|s| Vec3::from(s.position))
                .min_by(|p, q| {
                    let lateral = |p: &Vec3| p.norm_squared() - p[normal] * p[normal];
                    lateral(p).total_cmp(&lateral(q))
                })
                .unwrap();
            let mut particle = middle;
            particle[normal] += 1.0;
            let kernel = Kernel::new(dimension).of_length(wall.smoothing_length);
            let sum: f64 = sites(&wall, dimension, &[], None)
                .map(|s| (Vec3::from(s.position) - particle).norm())
                .map(|r| kernel.value(r))
                .sum();
            assert!((sum - touching_value(&wall, &wall, dimension)).abs() < 1e-12);
        }
    }
}
