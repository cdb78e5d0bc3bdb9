//! Distances, faces, volumes.

use std::f64::consts::PI;
use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::{Mesh, Shape};

fn placed(primitive: Primitive) -> Solid {
    let turn = rotation(&Vec3::new(1.0, 2.0, -0.5), 0.7);
    let at = Vec3::new(0.2, -0.3, 0.4);
    Solid::Primitive(primitive, Placement::turned(turn, at))
}

fn revolved(corners: &[[f64; 2]]) -> Primitive {
    Primitive::Revolved(Polygon::new(corners.to_vec()).unwrap())
}

fn tetrahedron() -> Primitive {
    let x = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let soup: Vec<_> = faces.iter().map(|f| f.map(|c: usize| x[c])).collect();
    Primitive::Mesh(Arc::new(Mesh::new(&soup).unwrap()))
}

fn angle() -> Vec<[f64; 2]> {
    vec![
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 0.5],
        [0.5, 0.5],
        [0.5, 1.5],
        [0.0, 1.5],
    ]
}

/// Each form with its volume.
fn primitives() -> Vec<(Primitive, f64)> {
    let (radius, nose) = (0.5_f64, 1.2_f64);
    let arc = (radius * radius + nose * nose) / (2.0 * radius);
    let slices = 200_000_u32;
    let nose_volume: f64 = (0..slices)
        .map(|n| {
            let z = (f64::from(n) + 0.5) / f64::from(slices) * nose;
            let r = (arc * arc - z * z).sqrt() - (arc - radius);
            PI * r * r * nose / f64::from(slices)
        })
        .sum();
    vec![
        (Primitive::Box(Vec3::new(0.5, 1.0, 0.25)), 1.0),
        (Primitive::Ball(1.5), 4.5 * PI),
        (Primitive::Ellipsoid(Vec3::new(1.0, 0.5, 0.25)), PI / 6.0),
        (
            revolved(&[[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]]),
            2.0 * PI,
        ),
        (
            revolved(&[[0.5, -1.0], [1.0, -1.0], [1.0, 1.0], [0.5, 1.0]]),
            1.5 * PI,
        ),
        (revolved(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.5]]), 0.5 * PI),
        (
            revolved(&[[0.0, 0.0], [1.0, 0.0], [0.5, 1.2], [0.0, 1.2]]),
            0.4 * PI * 1.75,
        ),
        (
            Primitive::Torus {
                radius: 1.0,
                tube: 0.3,
            },
            0.18 * PI * PI,
        ),
        (
            Primitive::Ogive {
                radius,
                arc,
                nose,
                shank: 2.0,
            },
            nose_volume + 0.5 * PI,
        ),
        (
            Primitive::Prism {
                section: Polygon::new(angle()).unwrap(),
                half: 0.75,
            },
            1.5 * 1.5,
        ),
        (tetrahedron(), 1.0 / 6.0),
    ]
}

fn solids() -> Vec<Solid> {
    let mut all: Vec<Solid> = primitives()
        .into_iter()
        .map(|(primitive, _)| placed(primitive))
        .collect();
    let ball =
        |x: f64| Solid::Primitive(Primitive::Ball(1.0), Placement::at(Vec3::new(x, 0.0, 0.0)));
    let cube = Solid::Primitive(
        Primitive::Box(Vec3::repeat(1.0)),
        Placement::at(Vec3::zeros()),
    );
    all.push(Solid::Union(vec![ball(-0.5), ball(0.5)]));
    all.push(Solid::Intersection(vec![ball(0.5), cube.clone()]));
    all.push(Solid::Difference(Box::new(cube), vec![ball(1.0)]));
    let [units, _] = repeated();
    all.push(units);
    all
}

#[test]
fn volumes_are_those_of_geometry() {
    for (primitive, volume) in primitives() {
        let computed = primitive.volume(3);
        assert!(
            (computed / volume - 1.0).abs() < 1e-9,
            "{primitive:?}: {computed} for {volume}"
        );
        let solid = placed(primitive);
        let halved = volume::integrated(&|x| solid.distance(x), solid.bounds(), 3);
        let error = halved / volume - 1.0;
        println!("{error:e}");
        assert!(
            error.abs() < 2e-4,
            "{solid:?}: {halved} for {volume}, {error:e}"
        );
    }
}

#[test]
fn together_solids_have_the_volume_of_geometry() {
    let ball =
        |x: f64| Solid::Primitive(Primitive::Ball(1.0), Placement::at(Vec3::new(x, 0.0, 0.0)));
    // Two caps of height 1 − d/2.
    let lens = |d: f64| PI * (2.0 - d).powi(2) * (d * d + 4.0 * d) / (12.0 * d);
    let whole = 4.0 / 3.0 * PI;
    for (solid, volume) in [
        (
            Solid::Union(vec![ball(0.0), ball(0.8)]),
            2.0 * whole - lens(0.8),
        ),
        (Solid::Intersection(vec![ball(0.0), ball(0.8)]), lens(0.8)),
        (
            Solid::Difference(Box::new(ball(0.0)), vec![ball(0.8)]),
            whole - lens(0.8),
        ),
    ] {
        let error = solid.volume(3) / volume - 1.0;
        println!("{error:e}");
        assert!(error.abs() < 1e-5, "{error:e}");
        let half = solid.volume_above(&[(1, 0.0)], 3) / (0.5 * volume) - 1.0;
        assert!(half.abs() < 1e-5, "{half:e}");
    }
    let flat = Solid::Difference(Box::new(ball(0.0)), vec![ball(3.0)]);
    assert!((flat.volume(2) / PI - 1.0).abs() < 1e-6);
}

#[test]
fn a_solid_lies_within_its_box() {
    for solid in solids() {
        let (lower, upper) = solid.bounds();
        for n in 0..4000 {
            let f = |k: u32| f64::from(n * k % 4001) / 4000.0 * 8.0 - 4.0;
            let x = Vec3::new(f(1), f(61), f(997));
            let is_within = (0..3).all(|a| x[a] >= lower[a] && x[a] <= upper[a]);
            assert!(is_within || solid.distance(&x) > 0.0, "{solid:?} at {x}");
        }
    }
}

#[test]
fn ready_shapes_are_the_solids_that_they_become() {
    let centre = Vec3::new(0.3, -0.1, 0.2);
    let shapes = [
        Shape::Box {
            lower: Vec3::new(-1.0, -2.0, 0.5),
            upper: Vec3::new(1.0, 3.0, 1.5),
        },
        Shape::Sphere {
            centre,
            radius: 1.2,
        },
        Shape::Shell {
            centre,
            radius: 1.2,
            inner_radius: 0.7,
        },
        Shape::Cylinder {
            centre,
            axis: crate::Axis::X,
            radius: 0.8,
            length: 1.7,
        },
    ];
    for shape in shapes {
        let solid = shape.solid(3);
        for n in 0..500 {
            let f = |k: u32| f64::from(n * k % 503) / 502.0 * 5.0 - 2.5;
            let x = Vec3::new(f(1), f(31), f(97));
            let (own, other) = (shape.distance(&x, 3), solid.distance(&x));
            assert!(
                (own - other).abs() < 1e-12,
                "{shape:?} at {x}: {own}, {other}"
            );
        }
    }
}

proptest! {
    /// The distance changes no faster than the point moves, and a way as long as the depth along a
    /// face's normal leads out.
    #[test]
    fn distances_are_bounds_and_faces_lie_where_they_say(
        which in 0_usize..15,
        x in prop::array::uniform3(-1.5_f64..1.5),
        aside in prop::array::uniform3(-0.5_f64..0.5),
    ) {
        let solid = &solids()[which];
        let (x, aside) = (Vec3::from(x), Vec3::from(aside));
        let here = solid.distance(&x);
        let there = solid.distance(&(x + aside));
        prop_assert!((here - there).abs() <= aside.norm() * (1.0 + 1e-9) + 1e-9);
        if here < -1e-6 {
            let mut least = f64::INFINITY;
            let mut wrong = None;
            solid.faces(&x, 10.0, &mut |depth, normal| {
                least = least.min(depth);
                if (normal.norm() - 1.0).abs() > 1e-9 {
                    wrong = Some(format!("normal {normal}"));
                }
                // On the surface of the part whose face it is, so never deep inside.
                let on = solid.distance(&(x + normal * (depth + 1e-6)));
                let is_union = matches!(solid, Solid::Union(_) | Solid::Repeat(..));
                if on < -1e-4 && !is_union && depth <= -here + 1e-9 {
                    wrong = Some(format!("depth {depth}, beyond it {on}"));
                }
            });
            prop_assert!(wrong.is_none(), "{:?}", wrong);
            prop_assert!((least + here).abs() < 1e-6, "nearest face {} for {}", least, -here);
        }
    }
}

#[test]
fn polygons_that_cross_themselves_are_refused() {
    assert!(Polygon::new(vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]).is_none());
    assert!(Polygon::new(vec![[0.0, 0.0], [1.0, 1.0]]).is_none());
    assert!(Polygon::new(Vec::new()).is_none());
    let clockwise = Polygon::new(angle().into_iter().rev().collect()).unwrap();
    assert_eq!(clockwise.area(), 1.5);
}

/// Points of space, evenly enough.
fn directions() -> impl Iterator<Item = Vec3> {
    (0..60).map(|n| {
        let z = (f64::from(n) + 0.5) / 30.0 - 1.0;
        let (r, turn) = ((1.0 - z * z).sqrt(), 2.399_963 * f64::from(n));
        Vec3::new(r * turn.cos(), r * turn.sin(), z)
    })
}

/// No point of the surface lies beyond the support, and one reaches it.
#[test]
fn forms_reach_as_far_as_their_support() {
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    for (primitive, _) in primitives() {
        let (lower, upper) = primitive.bounds();
        for n in directions().chain(axes).chain(axes.map(|n| -n)) {
            let support = primitive.support(&n);
            // Into the surface from far beyond along the direction, from many places.
            let mut farthest = f64::NEG_INFINITY;
            let cells = 12;
            for k in 0..cells * cells * cells {
                let part = |k: i32| f64::from(k % cells) / f64::from(cells - 1);
                let at = Vec3::new(part(k), part(k / cells), part(k / cells / cells));
                let mut x = lower + at.component_mul(&(upper - lower));
                let distance = primitive.distance(&x);
                if distance > 1e-9 {
                    continue;
                }
                x += n * -distance;
                farthest = farthest.max(n.dot(&x));
            }
            assert!(
                farthest <= support + 1e-9,
                "{primitive:?} {n}: {farthest} beyond {support}"
            );
            let size = (upper - lower).norm();
            assert!(
                support - farthest < 0.12 * size,
                "{primitive:?} {n}: {farthest} of {support}"
            );
        }
        // Along axes it is the box, to rounding.
        for a in 0..3 {
            assert!(
                (primitive.support(&axes[a]) - upper[a]).abs() < 1e-12,
                "{primitive:?}"
            );
            assert!(
                (primitive.support(&-axes[a]) + lower[a]).abs() < 1e-12,
                "{primitive:?}"
            );
        }
    }
}

#[test]
fn boxes_of_turned_solids_are_exact() {
    let turn = rotation(&Vec3::z(), 0.3);
    let (sin, cos) = 0.3_f64.sin_cos();
    let put = |primitive, turn| {
        Solid::Primitive(primitive, Placement::turned(turn, Vec3::new(1.0, 2.0, 3.0)))
    };
    let near = |solid: &Solid, lower: [f64; 3], upper: [f64; 3]| {
        let (l, u) = solid.bounds();
        let off = (l - Vec3::from(lower)).norm() + (u - Vec3::from(upper)).norm();
        assert!(off < 1e-12, "{solid:?}: {l} {u}");
    };
    let reach = 0.5 * cos + 0.25 * sin;
    let brick = put(Primitive::Box(Vec3::new(0.5, 0.25, 1.0)), turn);
    let other = 0.5 * sin + 0.25 * cos;
    near(
        &brick,
        [1.0 - reach, 2.0 - other, 2.0],
        [1.0 + reach, 2.0 + other, 4.0],
    );
    // A rod that lies askew is no wider than its slanted end adds.
    let tilt = rotation(&Vec3::y(), 0.3);
    let rod = put(
        revolved(&[[0.0, -2.0], [0.5, -2.0], [0.5, 2.0], [0.0, 2.0]]),
        tilt,
    );
    let (x, z) = (2.0 * sin + 0.5 * cos, 2.0 * cos + 0.5 * sin);
    near(&rod, [1.0 - x, 1.5, 3.0 - z], [1.0 + x, 2.5, 3.0 + z]);
    let ring = put(
        Primitive::Torus {
            radius: 1.0,
            tube: 0.25,
        },
        tilt,
    );
    let (x, z) = (cos + 0.25, sin + 0.25);
    near(&ring, [1.0 - x, 0.75, 3.0 - z], [1.0 + x, 3.25, 3.0 + z]);
    let pair = Solid::Union(vec![brick.clone(), ring.clone()]);
    let lowest = crate::Shape::Solid(pair).lowest(&Vec3::y());
    assert!((lowest - 0.75).abs() < 1e-12, "{lowest}");
    let slope = Vec3::new(0.6, 0.0, 0.8);
    let lowest = crate::Shape::Solid(brick).lowest(&slope);
    let at = slope.dot(&Vec3::new(1.0, 2.0, 3.0));
    assert!(
        (lowest - (at - 0.6 * reach - 0.8)).abs() < 1e-12,
        "{lowest}"
    );
}

/// A box of triangles, each face of four.
fn meshed(half: Vec3) -> Primitive {
    let mut soup = Vec::new();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let at = |p: f64, q: f64| {
                let mut x = [0.0; 3];
                x[axis] = sign * half[axis];
                x[u] = p * half[u];
                x[v] = q * sign * half[v];
                x
            };
            let rim = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
            for k in 0..4 {
                soup.push([at(0.2, -0.1), rim[k], rim[(k + 1) % 4]]);
            }
        }
    }
    Primitive::Mesh(Arc::new(Mesh::new(&soup).unwrap()))
}

#[test]
fn a_mesh_tells_the_faces_of_what_it_is_a_mesh_of() {
    let half = Vec3::new(1.0, 0.8, 0.5);
    let (cuboid, mesh) = (Primitive::Box(half), meshed(half));
    let faces_of = |primitive: &Primitive, x: &Vec3| {
        let mut all: Vec<(f64, Vec3)> = Vec::new();
        primitive.faces(x, 0.3, &mut |depth, normal| all.push((depth, normal)));
        all.sort_by(|a, b| a.1.iter().partial_cmp(b.1.iter()).unwrap());
        all
    };
    for n in 0..2000 {
        let n = f64::from(n);
        let x = Vec3::new(
            libm::sin(1.3 * n),
            0.8 * libm::sin(2.1 * n + 1.0),
            0.5 * libm::sin(3.7 * n + 2.0),
        ) * 0.999;
        assert!((cuboid.distance(&x) - mesh.distance(&x)).abs() < 1e-12);
        let [a, b] = [faces_of(&cuboid, &x), faces_of(&mesh, &x)];
        assert_eq!(a.len(), b.len(), "{x}: {a:?} {b:?}");
        for (a, b) in a.iter().zip(&b) {
            assert!(
                (a.0 - b.0).abs() < 1e-12 && (a.1 - b.1).norm() < 1e-12,
                "{x}"
            );
        }
    }
}

#[test]
fn a_smooth_mesh_tells_one_face() {
    let (rows, radius) = (40_u32, 1.0);
    let corner = |i: u32, j: u32| {
        let theta = PI * f64::from(i) / f64::from(rows);
        let turn = 2.0 * PI * f64::from(j % (2 * rows)) / f64::from(2 * rows);
        let (s, c) = (libm::sin(theta), libm::cos(theta));
        // Poles are one place.
        let s = if i == 0 || i == rows { 0.0 } else { s };
        [
            radius * s * libm::cos(turn),
            radius * s * libm::sin(turn),
            radius * c,
        ]
    };
    let mut soup = Vec::new();
    for i in 0..rows {
        for j in 0..2 * rows {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
            soup.extend([[a, b, c], [a, c, d]]);
        }
    }
    let mesh = Primitive::Mesh(Arc::new(Mesh::new(&soup).unwrap()));
    assert!((mesh.volume(3) / (4.0 / 3.0 * PI) - 1.0).abs() < 0.01);
    for n in directions() {
        for depth in [0.01, 0.1, 0.2] {
            let x = n * (0.997 - depth);
            let mut emitted = Vec::new();
            mesh.faces(&x, 0.3, &mut |depth, normal| emitted.push((depth, normal)));
            let [(computed, normal)] = emitted[..] else {
                panic!("{n} {depth}: {emitted:?}");
            };
            // Triangles turn by 4.5° from one to the next.
            assert!(
                (computed - depth).abs() < 0.005 && normal.dot(&n) > 0.997,
                "{n} {depth}: {computed} {normal}"
            );
        }
    }
}

/// Balls on a lattice of triangles, aslant in space, and what they are one by one.
fn repeated() -> [Solid; 2] {
    let unit = Solid::Primitive(
        Primitive::Ball(0.3),
        Placement::at(Vec3::new(0.2, 0.1, -0.4)),
    );
    let steps = [Vec3::x(), Vec3::new(0.5, 0.75_f64.sqrt(), 0.0)];
    let (lower, upper) = (Vec3::new(-1.2, -1.8, 5.0), Vec3::new(2.0, 0.9, 5.0));
    let units = Repeat::new(unit.clone(), steps.to_vec(), (lower, upper)).unwrap();
    let mut parts = Vec::new();
    for a in -9..=9 {
        for b in -9..=9 {
            let at = steps[0] * f64::from(a) + steps[1] * f64::from(b);
            if (0..2).all(|c| lower[c] <= at[c] && at[c] <= upper[c]) {
                let mut part = unit.clone();
                part.translate(&at);
                parts.push(part);
            }
        }
    }
    let mut both = [
        Solid::Repeat(Box::new(units), Placement::at(Vec3::zeros())),
        Solid::Union(parts),
    ];
    for solid in &mut both {
        solid.rotate(
            &rotation(&Vec3::new(1.0, 2.0, -0.5), 0.7),
            &Vec3::new(0.1, 0.2, 0.3),
        );
        solid.translate(&Vec3::new(0.0, -0.7, 0.2));
    }
    both
}

#[test]
fn what_is_repeated_is_the_union_of_its_units() {
    let [units, union] = repeated();
    let mut outside = 0;
    for n in 0..4000 {
        let f = |k: u32| f64::from(n * k % 4001) / 4000.0 * 8.0 - 4.0;
        let x = Vec3::new(f(1), f(61), f(997));
        let [a, b] = [&units, &union].map(|solid| solid.distance(&x));
        assert!((a - b).abs() < 1e-12, "{x}: {a} for {b}");
        outside += u32::from(a > 0.0);
        if a < 0.0 {
            let faces = |solid: &Solid| {
                let mut found = Vec::new();
                solid.faces(&x, 1.0, &mut |depth, normal| found.push((depth, normal)));
                found
            };
            let [a, b] = [&units, &union].map(faces);
            assert!(a.len() == 1 && (a[0].0 - b[0].0).abs() < 1e-12);
            assert!((a[0].1 - b[0].1).norm() < 1e-9);
        }
    }
    assert!(outside > 100);
    let volume = union.volume(3);
    assert!((units.volume(3) / volume - 1.0).abs() < 1e-6);
    let (low, high) = units.bounds();
    let (l, h) = union.bounds();
    assert!((0..3).all(|a| low[a] <= l[a] + 1e-12 && h[a] - 1e-12 <= high[a]));
}

/// A core of hexagonal cells: walls of a tenth of a cell fill what hexagons leave.
#[test]
fn hexagons_cut_out_of_a_box_leave_the_walls_of_a_honeycomb() {
    let hexagon = |across: f64| {
        let radius = 0.5 * across / (PI / 6.0).cos();
        let corner = |n: u32| {
            let angle = f64::from(2 * n + 1) * PI / 6.0;
            [radius * angle.cos(), radius * angle.sin()]
        };
        Polygon::new((0..6).map(corner).collect()).unwrap()
    };
    let (cell, across) = (1.0, 0.9);
    let unit = Solid::Primitive(
        Primitive::Prism {
            section: hexagon(across),
            half: 1.0,
        },
        Placement::at(Vec3::zeros()),
    );
    let rows = 0.75_f64.sqrt();
    let steps = vec![Vec3::x() * cell, Vec3::new(0.5, rows, 0.0)];
    let region = (Vec3::repeat(-9.0), Vec3::repeat(9.0));
    let cells = Repeat::new(unit, steps, region).unwrap();
    // Two cells by two pairs of rows, whose sides cut cells in halves.
    let half = Vec3::new(1.0, 2.0 * rows, 0.5);
    let core = Solid::Difference(
        Box::new(Solid::Primitive(
            Primitive::Box(half),
            Placement::at(Vec3::zeros()),
        )),
        vec![Solid::Repeat(Box::new(cells), Placement::at(Vec3::zeros()))],
    );
    let walls = 1.0 - across * across / (cell * cell);
    let share = core.volume(2) / (4.0 * half.x * half.y);
    assert!((share / walls - 1.0).abs() < 1e-3, "{share} for {walls}");
    assert!(core.distance(&Vec3::new(0.5, 0.0, 0.0)) < -0.049);
    assert!(core.distance(&Vec3::zeros()) > 0.4);
}

#[test]
fn lattices_without_a_point_or_with_too_many_are_none() {
    let ball =
        |radius: f64| Solid::Primitive(Primitive::Ball(radius), Placement::at(Vec3::zeros()));
    let line = |unit: Solid, from: f64, to: f64| {
        let region = (Vec3::repeat(from), Vec3::repeat(to));
        Repeat::new(unit, vec![Vec3::y()], region)
    };
    assert!(line(ball(0.3), 0.2, 0.8).is_err());
    assert!(line(ball(0.3), 0.2, 1e6).is_err());
    assert!(line(ball(40.0), 0.2, 1.8).is_err());
    let units = line(ball(0.3), 0.2, 1.8).unwrap();
    let twice = Solid::Repeat(Box::new(units), Placement::at(Vec3::zeros()));
    assert!(line(twice, 0.2, 1.8).is_err());
    let nowhere = (Vec3::zeros(), Vec3::zeros());
    assert!(Repeat::new(ball(0.3), vec![Vec3::y(), Vec3::y()], nowhere).is_err());
}
