//! Counts, symmetry, mass, slabs.

use std::f64::consts::PI;

use proptest::prelude::*;

use super::*;
use model::{Freedom, Initial, Lattice, LatticeKind, Shape, Vec3};

mod bricks;
mod counts;
mod shells;
mod touch;

pub(super) fn body(shape: Shape, kind: LatticeKind, spacing: f64, angle: f64) -> Body {
    Body {
        name: "body".to_owned(),
        shape,
        material: 0,
        lattice: Lattice {
            kind,
            spacing,
            angle,
            ..Lattice::default()
        },
        density: None,
        initial: Initial::default(),
        velocity: Vec3::zeros(),
        angular_velocity: Vec3::zeros(),
        rigid: None,
        freedom: Freedom::default(),
        smoothing_length: 1.3 * spacing,
        total: false,
        layer: false,
        filled: None,
    }
}

fn block(lower: [f64; 3], upper: [f64; 3]) -> Shape {
    Shape::Box {
        lower: lower.into(),
        upper: upper.into(),
    }
}

fn ball(radius: f64) -> Shape {
    Shape::Sphere {
        centre: Vec3::zeros(),
        radius,
    }
}

fn shell(radius: f64, inner_radius: f64) -> Shape {
    Shape::Shell {
        centre: Vec3::zeros(),
        radius,
        inner_radius,
    }
}

fn plate(axis: Axis) -> Shape {
    Shape::Cylinder {
        centre: Vec3::new(0.3, -0.2, 0.1),
        axis,
        radius: 1.5,
        length: 0.2,
    }
}

const KINDS: [LatticeKind; 2] = [LatticeKind::Cubic, LatticeKind::Hexagonal];

fn planes() -> [SymmetryPlane; 2] {
    [Axis::X, Axis::Y].map(|axis| SymmetryPlane {
        axis,
        position: 0.0,
    })
}

fn all(body: &Body, dimension: usize) -> Vec<Site> {
    sites(body, dimension, &[], None).collect()
}

fn bits(sites: impl Iterator<Item = Site>) -> Vec<(u64, [u64; 3])> {
    sites
        .map(|s| (s.index, s.position.map(f64::to_bits)))
        .collect()
}

#[test]
fn a_box_is_filled_with_whole_layers() {
    let shape = block([0.0; 3], [1.0, 0.52, 0.38]);
    let sites = all(&body(shape, LatticeKind::Cubic, 0.1, 0.0), 3);
    assert_eq!(sites.len(), 10 * 5 * 4);
    // Centred: the same distance to both faces.
    let (lower, upper) = bounds(
        &body(
            block([0.0; 3], [1.0, 0.52, 0.38]),
            LatticeKind::Cubic,
            0.1,
            0.0,
        ),
        3,
    )
    .unwrap();
    for (a, length) in [1.0, 0.52, 0.38].into_iter().enumerate() {
        assert!((lower[a] - (length - upper[a])).abs() < 1e-15);
    }
    assert_eq!(sites.last().unwrap().index, 199);
}

/// A lattice that is fitted fills the sides of a box whatever they are, and nothing else changes.
#[test]
fn a_fitted_lattice_fills_a_box_exactly() {
    let (lower, upper) = ([-1.0, 0.2, 0.0], [0.53, 0.87, 0.31]);
    for dimension in [1, 2, 3] {
        let mut body = body(block(lower, upper), LatticeKind::Cubic, 0.1, 0.0);
        let plain = all(&body, dimension).len();
        body.lattice.fit = true;
        let sites = all(&body, dimension);
        assert_eq!(sites.len(), plain);
        let (first, last) = bounds(&body, dimension).unwrap();
        let numbers = [15.0, 7.0, 3.0];
        let mut cell = 1.0;
        for a in 0..dimension {
            let pitch = (upper[a] - lower[a]) / numbers[a];
            cell *= pitch;
            assert!((first[a] - lower[a] - 0.5 * pitch).abs() < 1e-12);
            assert!((upper[a] - last[a] - 0.5 * pitch).abs() < 1e-12);
        }
        let each = even_volume(&body, dimension, &[]).unwrap();
        assert!((each / cell - 1.0).abs() < 1e-12, "{each} {cell}");
    }
    let whole = block([0.0; 3], [1.0, 0.5, 0.2]);
    let plain = body(whole, LatticeKind::Cubic, 0.1, 0.0);
    let mut fitted = plain.clone();
    fitted.lattice.fit = true;
    for (a, b) in all(&plain, 3).iter().zip(all(&fitted, 3)) {
        assert!((Vec3::from(a.position) - Vec3::from(b.position)).norm() < 1e-12);
    }
}

#[test]
fn lower_dimensions_leave_the_other_components_zero() {
    let shape = block([0.0, -1.0, 3.0], [1.0, 1.0, 4.0]);
    for kind in KINDS {
        let line = all(&body(shape.clone(), kind, 0.01, 0.0), 1);
        assert_eq!(line.len(), 100);
        assert!(line.iter().all(|s| s.position[1..] == [0.0, 0.0]));
    }
    let sheet = all(&body(shape, LatticeKind::Cubic, 0.1, 0.0), 2);
    assert_eq!(sheet.len(), 10 * 20);
    assert!(sheet.iter().all(|s| s.position[2] == 0.0));
}

#[test]
fn the_main_jobs_sphere_and_plate() {
    let sphere = body(ball(0.3e-3), LatticeKind::Cubic, 0.02e-3, 0.0);
    // Half-integer points of a ball of radius 15.
    let expected = (-15..15)
        .flat_map(|i| (-15..15).flat_map(move |j| (-15..15).map(move |k| (i, j, k))))
        .filter(|(i, j, k)| {
            let odd = |n: &i32| (2 * n + 1) * (2 * n + 1);
            odd(i) + odd(j) + odd(k) < 900
        })
        .count();
    assert_eq!(count(&sphere, 3, &[], None), expected as u64);
    assert_eq!(4 * count(&sphere, 3, &planes(), None), expected as u64);
}

#[allow(clippy::cast_precision_loss)] // counts of thousands
/// Lattice points in a volume differ from the volume by a surface term: within half a spacing
/// times the surface, and in practice a tenth of it.
#[test]
fn mass_is_that_of_the_shape() {
    let volume = |shape: &Shape| match shape {
        Shape::Solid(solid) => solid.volume(3),
        Shape::Sphere { radius, .. } => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
        Shape::Shell {
            radius,
            inner_radius,
            ..
        } => 4.0 / 3.0 * std::f64::consts::PI * (radius.powi(3) - inner_radius.powi(3)),
        Shape::Cylinder { radius, length, .. } => std::f64::consts::PI * radius.powi(2) * length,
        Shape::Box { lower, upper } => (upper - lower).product(),
    };
    for kind in KINDS {
        for (shape, spacing, bound) in [
            (ball(1.0), 0.05, 0.01),
            (shell(1.0, 0.6), 0.05, 0.02),
            (plate(Axis::Z), 0.02, 0.02),
            (plate(Axis::X), 0.02, 0.08),
            (block([0.0; 3], [2.0, 1.0, 1.0]), 0.05, 0.04),
        ] {
            for angle in [0.0, 0.4] {
                let body = body(shape.clone(), kind, spacing, angle);
                let filled = count(&body, 3, &[], None) as f64 * particle_volume(&body, 3);
                let error = filled / volume(&shape) - 1.0;
                assert!(error.abs() < bound, "{kind:?} {shape:?} {angle}: {error}");
            }
        }
    }
}

#[test]
fn count_is_the_number_of_sites() {
    for kind in KINDS {
        for shape in [ball(1.0), plate(Axis::Y), block([0.0; 3], [1.0, 2.0, 0.5])] {
            for angle in [0.0, 0.3] {
                let body = body(shape.clone(), kind, 0.1, angle);
                let sites = all(&body, 3);
                assert_eq!(sites.len() as u64, count(&body, 3, &[], None));
                assert!(sites.windows(2).all(|w| w[0].index < w[1].index));
                assert!(sites.last().unwrap().index < index_end(&body, 3));
            }
        }
    }
}

/// No two sites are closer than the nearest distance of the lattice, and inner sites have all
/// their nearest neighbours: 6, 12 (4, 6 in two dimensions).
#[test]
fn inner_sites_have_all_their_neighbours() {
    for (kind, dimension, nearest, neighbours) in [
        (LatticeKind::Cubic, 3, 1.0, 6),
        (LatticeKind::Hexagonal, 3, lattice::CLOSE_PACKED, 12),
        (LatticeKind::Cubic, 2, 1.0, 4),
        (LatticeKind::Hexagonal, 2, lattice::TRIANGULAR, 6),
    ] {
        for angle in [0.0, 0.5] {
            let sites = all(&body(ball(4.5), kind, 1.0, angle), dimension);
            for s in &sites {
                let distances = sites
                    .iter()
                    .map(|t| (Vec3::from(s.position) - Vec3::from(t.position)).norm());
                let close = distances
                    .filter(|&r| {
                        assert!(r == 0.0 || r > 0.999 * nearest);
                        r > 0.0 && r < 1.001 * nearest
                    })
                    .count();
                if Vec3::from(s.position).norm() < 3.0 {
                    assert_eq!(close, neighbours);
                }
            }
        }
    }
}

#[test]
fn halves_of_a_cubic_body_are_mirror_images_bit_for_bit() {
    for shape in [
        ball(0.3e-3),
        Shape::Cylinder {
            centre: Vec3::zeros(),
            axis: Axis::Z,
            radius: 1.5e-3,
            length: 0.2e-3,
        },
        block([-0.4e-3; 3], [0.4e-3; 3]),
    ] {
        let full = body(shape, LatticeKind::Cubic, 0.02e-3, 0.0);
        let mut mirrored: Vec<_> = all(&full, 3)
            .iter()
            .map(|s| [-s.position[0], s.position[1], s.position[2]].map(f64::to_bits))
            .collect();
        let mut here: Vec<_> = all(&full, 3)
            .iter()
            .map(|s| s.position.map(f64::to_bits))
            .collect();
        mirrored.sort_unstable();
        here.sort_unstable();
        assert_eq!(mirrored, here);
    }
}

#[test]
fn a_quarter_is_exactly_its_part_of_the_whole() {
    for kind in KINDS {
        let body = body(ball(1.0), kind, 0.07, 0.0);
        let part =
            sites(&body, 3, &[], None).filter(|s| s.position[0] > 0.0 && s.position[1] > 0.0);
        assert_eq!(bits(part), bits(sites(&body, 3, &planes(), None)));
    }
}

/// The outermost ring lies half a spacing inside, the innermost half a spacing outside of a hole;
/// all mirror images are there, and any slabs add up.
#[test]
fn rings_follow_the_outline() {
    for (shape, dimension, volume) in [
        (ball(1.0), 2, PI),
        (shell(1.0, 0.6), 2, 0.64 * PI),
        (plate(Axis::Z), 3, 2.25 * PI * 0.2),
    ] {
        let body = body(shape, LatticeKind::Rings, 0.05, 0.0);
        let sites = all(&body, dimension);
        let [x, y] = if dimension == 3 {
            [0.3, -0.2]
        } else {
            [0.0; 2]
        };
        let radius = |s: &Site| (s.position[0] - x).hypot(s.position[1] - y);
        let outermost = sites.iter().map(radius).fold(0.0, f64::max);
        assert!((outermost - if dimension == 3 { 1.475 } else { 0.975 }).abs() < 1e-12);
        #[allow(clippy::cast_precision_loss)] // counts of thousands
        let filled = sites.len() as f64 * particle_volume(&body, dimension);
        assert!((filled / volume - 1.0).abs() < 5e-3, "{filled} of {volume}");
        assert!(sites.iter().all(|s| s.index < index_end(&body, dimension)));
        let mut whole = bits(sites.iter().copied());
        whole.sort_unstable();
        let mut parts: Vec<_> = [f64::NEG_INFINITY, -0.7, sites[7].position[0], f64::INFINITY]
            .windows(2)
            .map(|w| Brick::slab(0, w[0], w[1]))
            .flat_map(|slab| bits(super::sites(&body, dimension, &[], Some(slab))))
            .collect();
        parts.sort_unstable();
        assert_eq!(parts, whole);
        if dimension == 2 {
            let positions = |flip: f64| {
                let flipped = sites.iter().map(|s| [s.position[0] * flip, s.position[1]]);
                let mut positions: Vec<_> = flipped.map(|p| p.map(f64::to_bits)).collect();
                positions.sort_unstable();
                positions
            };
            assert_eq!(positions(1.0), positions(-1.0));
            let quarter = count(&body, 2, &planes(), None);
            assert_eq!(4 * quarter, sites.len() as u64);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    /// Any cut into slabs gives each site once, with the same bits.
    #[test]
    fn slabs_add_up_to_the_whole(
        hexagonal in any::<bool>(),
        angle in prop_oneof![Just(0.0), Just(std::f64::consts::FRAC_PI_2), -3.0..3.0f64],
        shape in prop_oneof![
            Just(ball(1.0)), Just(shell(1.0, 0.6)), Just(plate(Axis::X)), Just(plate(Axis::Z)),
            Just(block([-1.0; 3], [0.5, 1.0, 0.3]))
        ],
        axis in 0usize..3,
        spacing in 0.07..0.2f64,
        mut faces in proptest::collection::vec(-2.0..2.0f64, 0..6),
        on_site in any::<prop::sample::Index>(),
        quarter in any::<bool>(),
    ) {
        let body = body(shape, KINDS[usize::from(hexagonal)], spacing, angle);
        let all_planes = planes();
        let planes = if quarter { &all_planes[..] } else { &[] };
        let whole = bits(sites(&body, 3, planes, None));
        // A face exactly on a site must not lose or double it.
        let there: Vec<Site> = sites(&body, 3, planes, None).collect();
        if !there.is_empty() {
            faces.push(on_site.get(&there).position[axis]);
        }
        faces.extend([f64::NEG_INFINITY, f64::INFINITY]);
        faces.sort_by(f64::total_cmp);
        let mut union: Vec<_> = faces.windows(2).flat_map(|w| {
            let slab = Brick::slab(axis, w[0], w[1]);
            assert!(sites(&body, 3, planes, Some(slab))
                .all(|s| w[0] <= s.position[axis] && s.position[axis] < w[1]));
            bits(sites(&body, 3, planes, Some(slab)))
        }).collect();
        union.sort_unstable();
        prop_assert_eq!(union, whole);
    }
}

/// A thin slab of a body of 10^12 sites must not visit them all.
#[test]
fn a_slab_of_a_huge_body_is_cheap() {
    let body = body(block([0.0; 3], [1e4; 3]), LatticeKind::Cubic, 1.0, 0.0);
    let slab = Brick::slab(2, 10.0, 11.0);
    assert_eq!(count(&body, 3, &[], Some(slab)), 100_000_000);
    assert_eq!(index_end(&body, 3), 1_000_000_000_000);
}
