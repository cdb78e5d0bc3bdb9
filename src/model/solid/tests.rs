//! Distances, faces, volumes.

use std::f64::consts::PI;
use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::model::{Mesh, Shape};

fn placed(form: Form) -> Solid {
    let turn = rotation(&Vec3::new(1.0, 2.0, -0.5), 0.7);
    let at = Vec3::new(0.2, -0.3, 0.4);
    Solid::Form(form, Placement::turned(turn, at))
}

fn revolved(corners: &[[f64; 2]]) -> Form {
    Form::Revolved(Polygon::new(corners.to_vec()).unwrap())
}

fn tetrahedron() -> Form {
    let x = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let soup: Vec<_> = faces.iter().map(|f| f.map(|c: usize| x[c])).collect();
    Form::Mesh(Arc::new(Mesh::new(&soup).unwrap()))
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
fn forms() -> Vec<(Form, f64)> {
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
        (Form::Box(Vec3::new(0.5, 1.0, 0.25)), 1.0),
        (Form::Ball(1.5), 4.5 * PI),
        (Form::Ellipsoid(Vec3::new(1.0, 0.5, 0.25)), PI / 6.0),
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
            Form::Torus {
                radius: 1.0,
                tube: 0.3,
            },
            0.18 * PI * PI,
        ),
        (
            Form::Ogive {
                radius,
                arc,
                nose,
                shank: 2.0,
            },
            nose_volume + 0.5 * PI,
        ),
        (
            Form::Prism {
                section: Polygon::new(angle()).unwrap(),
                half: 0.75,
            },
            1.5 * 1.5,
        ),
        (tetrahedron(), 1.0 / 6.0),
    ]
}

fn solids() -> Vec<Solid> {
    let mut all: Vec<Solid> = forms().into_iter().map(|(form, _)| placed(form)).collect();
    let ball = |x: f64| Solid::Form(Form::Ball(1.0), Placement::at(Vec3::new(x, 0.0, 0.0)));
    let cube = Solid::Form(Form::Box(Vec3::repeat(1.0)), Placement::at(Vec3::zeros()));
    all.push(Solid::Union(vec![ball(-0.5), ball(0.5)]));
    all.push(Solid::Intersection(vec![ball(0.5), cube.clone()]));
    all.push(Solid::Difference(Box::new(cube), vec![ball(1.0)]));
    all
}

#[test]
fn volumes_are_those_of_geometry() {
    for (form, volume) in forms() {
        let told = form.volume(3);
        assert!(
            (told / volume - 1.0).abs() < 1e-9,
            "{form:?}: {told} for {volume}"
        );
        let solid = placed(form);
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
    let ball = |x: f64| Solid::Form(Form::Ball(1.0), Placement::at(Vec3::new(x, 0.0, 0.0)));
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
            axis: crate::model::Axis::X,
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
        which in 0_usize..14,
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
                let is_union = matches!(solid, Solid::Union(_));
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
