//! The measure of the hole that an impact leaves in a plate.

use std::f64::consts::TAU;

use crate::physics_support::hole::Plate;

/// A plate on a lattice from z = 0 to z = 0.2 without what lies inside `hole`.
#[allow(clippy::cast_possible_truncation, reason = "a few layers")]
fn plate_with_hole(hole: f64, spacing: f64, quarter: bool) -> (Plate, Vec<[f64; 3]>) {
    let plate = Plate {
        centre: [0.0, 0.0, 0.1],
        axis: 2,
        thickness: 0.2,
        density: 3.0,
        spacing,
        angle: if quarter { TAU / 4.0 } else { TAU },
    };
    let n = (1.0 / spacing).round() as i32;
    let first = if quarter { 0 } else { -n };
    let at = |i: i32| (f64::from(i) + 0.5) * spacing;
    let mut positions = Vec::new();
    for i in first..n {
        for j in first..n {
            let r2 = at(i) * at(i) + at(j) * at(j);
            for k in 0..(0.2 / spacing).round() as i32 {
                if r2 > hole * hole && r2 < 1.0 {
                    positions.push([at(i), at(j), at(k)]);
                }
            }
        }
    }
    (plate, positions)
}

fn measure(plate: &Plate, positions: &[[f64; 3]]) -> Option<f64> {
    let mass = plate.density * plate.spacing * plate.spacing * plate.spacing;
    plate.hole_radius(positions.iter().map(|x| (x, mass)))
}

#[test]
fn finds_the_radius_of_a_hole() {
    for hole in [0.3, 0.41, 0.52] {
        for quarter in [false, true] {
            let (plate, positions) = plate_with_hole(hole, 0.02, quarter);
            let found = measure(&plate, &positions).expect("a hole");
            assert!(
                (found - hole).abs() < 0.2 * plate.spacing,
                "{hole}: {found}"
            );
        }
    }
}

#[test]
fn debris_off_the_plate_does_not_close_the_hole() {
    let (plate, mut positions) = plate_with_hole(0.4, 0.02, true);
    let whole = measure(&plate, &positions);
    let cover: Vec<_> = positions
        .iter()
        .map(|x| [x[0] - 0.4, x[1], x[2] - 0.5])
        .collect();
    positions.extend(cover);
    assert_eq!(measure(&plate, &positions), whole);
}

#[test]
fn a_plate_without_hole_has_none() {
    let (plate, positions) = plate_with_hole(0.0, 0.02, true);
    assert_eq!(measure(&plate, &positions), None);
}
