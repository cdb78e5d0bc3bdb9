//! Counts, bounds and searches that look at few rows, against a walk of all sites.

use std::collections::BTreeMap;

use super::*;
use crate::lattice::Stack;
use model::{Motion, Resistance, SurfaceShape};

/// A body of any lattice in any dimension, with the shapes that the lattice fills.
fn any_body() -> impl Strategy<Value = (usize, Body)> {
    let angle = prop_oneof![Just(0.0), Just(PI), Just(0.5 * PI), -3.0..3.0f64];
    (0_usize..4, 1_usize..4, 0_usize..8, angle, 0.09..0.3f64).prop_map(
        |(kind, dimension, shape, angle, spacing)| {
            let kind = [
                LatticeKind::Cubic,
                LatticeKind::Hexagonal,
                LatticeKind::Rings,
                LatticeKind::Shells,
            ][kind];
            let shapes = [
                ball(1.0),
                shell(1.0, 0.6),
                shell(1.0, 0.93),
                plate(Axis::X),
                plate(Axis::Y),
                plate(Axis::Z),
                block([-1.0, -0.4, -0.7], [0.5, 1.0, 0.3]),
            ];
            let is_fitted = kind == LatticeKind::Cubic && shape == 7;
            let (dimension, shape) = match (kind, dimension) {
                (LatticeKind::Rings, 1 | 2) => (2, shape % 3),
                (LatticeKind::Rings, _) => (3, 5),
                (LatticeKind::Shells, _) => (3, shape % 3),
                (_, 1) => (1, 6),
                (_, 2) => (2, [0, 1, 2, 6][shape % 4]),
                _ => (3, shape.min(6)),
            };
            let has_angle = matches!(kind, LatticeKind::Cubic | LatticeKind::Hexagonal);
            let fit = is_fitted && shape == 6;
            let angle = if !has_angle || dimension == 1 || fit {
                0.0
            } else {
                angle
            };
            let mut body = body(shapes[shape].clone(), kind, spacing, angle);
            body.lattice.fit = fit;
            (dimension, body)
        },
    )
}

/// Symmetry planes of none to all axes, through the middle of bodies or beside it.
fn any_planes() -> impl Strategy<Value = Vec<SymmetryPlane>> {
    (0_usize..4, -0.5..0.5f64, any::<bool>()).prop_map(|(planes, position, is_central)| {
        let plane = |axis| SymmetryPlane {
            axis,
            position: if is_central { 0.0 } else { position },
        };
        Axis::ALL.into_iter().take(planes).map(plane).collect()
    })
}

/// Coordinates with the number of sites there; nought has one sign only.
type Counts = BTreeMap<u64, u64>;

fn add(counts: &mut Counts, x: f64, count: u64) {
    if count > 0 {
        *counts.entry((x + 0.0).to_bits()).or_default() += count;
    }
}

fn at_rest(shape: SurfaceShape, inside: bool) -> RigidSurface {
    RigidSurface {
        name: String::new(),
        shape,
        inside,
        stiffness: 2.0,
        resistance: Resistance::default(),
        bodies: vec![true],
        motion: Motion::default(),
        spin: None,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// The count along any axis is that of all sites one by one, whoever takes which rows.
    #[test]
    fn tallies_are_those_of_a_walk(
        (dimension, body) in any_body(),
        planes in any_planes(),
        parts in 1_usize..5,
    ) {
        let there: Vec<Site> = sites(&body, dimension, &planes, None).collect();
        for axis in 0..3 {
            let mut walked = Counts::new();
            for site in &there {
                add(&mut walked, site.position[axis], 1);
            }
            let mut tallied = Counts::new();
            for part in 0..parts {
                let share = Share { part, parts };
                tally(&body, dimension, &planes, axis, share, |x, n| add(&mut tallied, x, n));
            }
            prop_assert_eq!(&tallied, &walked, "axis {}", axis);
        }
    }

    /// Bounds and counts come from few layers, and are those of all.
    #[test]
    fn bounds_are_those_of_a_walk((dimension, body) in any_body(), planes in any_planes()) {
        for planes in [&planes[..], &[]] {
            let there: Vec<Site> = sites(&body, dimension, planes, None).collect();
            prop_assert_eq!(count(&body, dimension, planes, None), there.len() as u64);
            let walked = there.iter().fold(None, |bounds, site| {
                let p = site.position;
                let (lower, upper) = bounds.unwrap_or((p, p));
                Some((
                    std::array::from_fn(|a| f64::min(lower[a], p[a])),
                    std::array::from_fn(|a| f64::max(upper[a], p[a])),
                ))
            });
            prop_assert_eq!(bounds_above(&body, dimension, planes), walked);
        }
    }

    /// A search finds the smallest values that there are.
    #[test]
    fn searches_find_what_a_walk_finds(
        (dimension, body) in any_body(),
        planes in any_planes(),
        point in prop::array::uniform3(-2.0..2.0f64),
        target in 0_usize..4,
        limit in 0.05..2.0f64,
    ) {
        let box_ = block([-0.3, -0.2, -0.4], [0.3, 0.5, 0.1]);
        let target = [ball(0.4), plate(Axis::Y), shell(1.1, 0.2), box_][target].clone();
        let moved = |x: &[f64; 3]| Vec3::from(*x) + Vec3::from(point);
        let value = |x: &[f64; 3]| target.distance(&moved(x), dimension);
        let bound = |l: &[f64; 3], u: &[f64; 3]| {
            target.least_distance(&moved(l).into(), &moved(u).into(), dimension)
        };
        let mut walked: Vec<f64> = sites(&body, dimension, &planes, None)
            .map(|site| value(&site.position))
            .filter(|&value| value < limit)
            .collect();
        walked.sort_by(f64::total_cmp);
        let about = (&body, dimension, &planes[..]);
        for most in [1, 5] {
            let wanted = Wanted { most, limit, any: false };
            let nearest = search(about, wanted, bound, value);
            prop_assert_eq!(nearest.len(), most.min(walked.len()));
            for ((nearest, at), walked) in nearest.iter().zip(&walked) {
                prop_assert!((nearest - walked).abs() < 1e-12, "{} {}", nearest, walked);
                prop_assert!((value(at) - nearest).abs() < 1e-15);
            }
            let any = search(about, Wanted { any: true, ..wanted }, bound, value);
            prop_assert_eq!(any.len(), most.min(walked.len()));
        }
    }

    /// Gaps from rigid surfaces are those of the nearest site.
    #[test]
    fn gaps_are_those_of_a_walk(
        (dimension, body) in any_body(),
        planes in any_planes(),
        normal in 0_usize..4,
        position in -1.2..0.5f64,
    ) {
        let normals = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, 0.8], [-0.48, 0.64, 0.6]];
        let centre = [position, 0.3, 0.8];
        let shapes = [
            (SurfaceShape::Plane { normal: normals[normal], position }, false),
            (SurfaceShape::Sphere { centre, radius: 0.7 }, false),
            (SurfaceShape::Sphere { centre, radius: 2.4 }, true),
            (
                SurfaceShape::Cylinder {
                    centre,
                    axis: [0.0, 0.6, 0.8],
                    radius: 0.3,
                    half_length: 0.5,
                },
                false,
            ),
        ];
        for (shape, inside) in shapes {
            let surface = at_rest(shape, inside);
            let spacing = body.lattice.spacing;
            let walked = sites(&body, dimension, &planes, None)
                .map(|site| surface.gap(&site.position, spacing))
                .fold(f64::INFINITY, f64::min);
            let gap = smallest_gap(&body, dimension, &planes, &surface);
            if walked < spacing {
                prop_assert!((gap - walked).abs() < 1e-12, "{} {}", gap, walked);
            } else {
                prop_assert!(gap >= spacing, "{} {}", gap, walked);
            }
        }
    }
}

/// A plate with a tenth of a billion particles.
fn large_plate(kind: LatticeKind) -> Body {
    body(plate(Axis::Z), kind, 0.0024, 0.0)
}

/// Bounds need some layers only, the count of a plate one of each kind, a gap the sites near it.
#[test]
fn large_bodies_are_not_walked() {
    for kind in KINDS {
        let plate = large_plate(kind);
        assert!(count(&plate, 3, &[], None) > 90_000_000);
        let rows = Stack::new(&plate, 3).counts[1];
        let ball = body(ball(1.0), kind, 0.003, 0.3);
        let tool = SurfaceShape::Sphere {
            centre: [0.0, 0.0, 1.0],
            radius: 0.8,
        };
        let tool = at_rest(tool, false);
        for body in [&plate, &ball] {
            let few = 8 * rows;
            assert!(visits::of(|| bounds(body, 3)) < few);
            assert!(visits::of(|| bounds_above(body, 3, &planes())) < few);
            assert!(visits::of(|| smallest_gap(body, 3, &planes(), &tool)) < 40 * rows);
        }
        assert!(visits::of(|| count(&plate, 3, &[], None)) <= 2 * rows);
        for axis in 0..3 {
            let all = Share { part: 0, parts: 1 };
            let whole = || tally(&plate, 3, &[], axis, all, |_, _| ());
            assert!(visits::of(whole) <= 2 * rows);
        }
    }
}

/// Ranks that count together look each at its part of the rows, and one that fills its slab at
/// those of the slab.
#[test]
fn a_rank_visits_its_part_only() {
    let parts = 16;
    for kind in KINDS {
        let ball = body(ball(1.0), kind, 0.01, 0.0);
        let counts = Stack::new(&ball, 3).counts;
        let all = counts[1] * counts[2];
        for axis in 0..3 {
            for part in [0, 7, 15] {
                let share = Share { part, parts };
                let own = visits::of(|| tally(&ball, 3, &[], axis, share, |_, _| ()));
                assert!(own * 15 < all, "{kind:?} {axis}: {own} of {all}");
            }
        }
        for axis in [1, 2] {
            let slab = Brick::slab(axis, 0.1, 0.225);
            let own = visits::of(|| count(&ball, 3, &[], Some(slab)));
            assert!(own * 15 < all, "{kind:?} {axis}: {own} of {all}");
        }
        // Along the rows each has a piece of the slab, unless it is cut away by a plane.
        let slab = Brick::slab(0, 0.1, 0.225);
        let own = visits::of(|| count(&ball, 3, &planes(), Some(slab)));
        assert!(own <= all / 2 + counts[2], "{kind:?}: {own} of {all}");
    }
}
