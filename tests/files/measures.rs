//! Measures against made-up clouds whose answers are known, also where these are turned and shifted.

use crate::common::outcome::start;
use crate::common::virtual_ranks::on_virtual_ranks;
use crate::common::{body, case};
use comm::{Comm, Machine};
use engine::measure::{Findings, Told};
use engine::step::Simulation;
use engine::step::measurements;
use model::{
    Axis, Bar, Case, Debris, FrontLine, Include, LatticeKind, Measure, MeasureKind, Shape, Slab,
    SymmetryPlane, Vec3, Zone, ZonePlace, rotation,
};
use std::f64::consts::PI;

/// Particle spacing (m).
const D: f64 = 1e-4;

/// A plate or block between two corners in spacings, struck by a ball from above.
fn struck(lower: [f64; 3], upper: [f64; 3]) -> Case {
    let [lower, upper] = [lower, upper].map(|x| Vec3::from(x) * D);
    let ball = Shape::Sphere {
        centre: Vec3::new(0.0, 0.0, upper.z + 6.0 * D),
        radius: 4.0 * D,
    };
    let block = Shape::Box { lower, upper };
    let bodies = vec![
        body("ball", ball, D, Vec3::new(0.0, 0.0, -3000.0)),
        body("block", block, D, Vec3::zeros()),
    ];
    case(3, bodies, 1.0)
}

fn measured(kind: MeasureKind) -> Vec<Measure> {
    let name = "it".to_owned();
    vec![Measure { name, kind }]
}

/// Number of a figure of the first measure.
fn number(found: &[Findings], name: &str) -> f64 {
    match told(found, name) {
        Told::Number(number) => number,
        Told::Word(word) => panic!("{name} is {word}"),
    }
}

fn told(found: &[Findings], name: &str) -> Told {
    let figures = found.iter().flat_map(|found| &found.figures);
    let figure = figures.clone().find(|figure| figure.name == name);
    figure
        .unwrap_or_else(|| panic!("no {name} in {figures:?}"))
        .value
}

/// That a figure is what it should be within what it says of its uncertainty.
fn is(found: &[Findings], name: &str, expected: f64) {
    let mut figures = found.iter().flat_map(|found| &found.figures);
    let figure = figures.find(|figure| figure.name == name).unwrap();
    let value = number(found, name);
    let doubt = figure.uncertainty.unwrap();
    assert!(
        (value - expected).abs() <= doubt,
        "{name}: {value} ± {doubt} for {expected}"
    );
}

/// Moves each particle of a body: from where it stands (in spacings) to where it is to be, with its velocity; what
/// moves has flowed.
fn deform(
    simulation: &mut Simulation,
    body: u32,
    to: impl Fn([f64; 3]) -> Option<([f64; 3], [f64; 3])>,
) {
    let particles = &mut simulation.particles;
    for i in 0..particles.owned() {
        if particles.body[i] != body {
            continue;
        }
        if let Some((x, v)) = to(particles.position[i].map(|x| x / D)) {
            particles.position[i] = x.map(|x| x * D);
            particles.velocity[i] = v;
            particles.plastic_strain[i] = 1.0;
        }
    }
}

/// Turns and shifts all matter, and whatever a measure states of directions and places.
fn move_all(simulation: &mut Simulation, turn: &nalgebra::Matrix3<f64>, shift: Vec3) {
    let particles = &mut simulation.particles;
    for i in 0..particles.owned() {
        let x = turn * Vec3::from(particles.position[i]) + shift;
        particles.position[i] = x.into();
        particles.velocity[i] = (turn * Vec3::from(particles.velocity[i])).into();
    }
    for body in &mut simulation.case.bodies {
        let mut solid = body.shape.solid(3);
        solid.rotate(turn, &Vec3::zeros());
        solid.translate(&shift);
        body.shape = Shape::Solid(solid);
    }
    let way = |n: &mut [f64; 3]| *n = (turn * Vec3::from(*n)).into();
    let place = |x: &mut [f64; 3]| *x = (turn * Vec3::from(*x) + shift).into();
    for measure in &mut simulation.case.measure.measures {
        match &mut measure.kind {
            MeasureKind::Plate(slab) | MeasureKind::Target(slab) => {
                way(&mut slab.normal);
                let along = Vec3::from(slab.normal).dot(&shift);
                slab.front += along;
                slab.rear += along;
            }
            MeasureKind::Bar(bar) => way(&mut bar.foot),
            MeasureKind::Debris(debris) => {
                way(&mut debris.direction);
                place(&mut debris.point);
            }
            MeasureKind::Front(line) => {
                place(&mut line.from);
                place(&mut line.to);
            }
            MeasureKind::Zone(_) => {}
        }
    }
}

/// A turn about no axis in particular, and a shift.
fn moved() -> (nalgebra::Matrix3<f64>, Vec3) {
    (
        rotation(&Vec3::new(1.0, -2.0, 0.5), 0.7),
        Vec3::new(0.003, -0.001, 0.002),
    )
}

fn measure(simulation: &mut Simulation) -> Vec<Findings> {
    measurements::findings(simulation, &Comm::solo())
}

/// A plate of 40 × 40 × 4 spacings with all that is made of it.
fn plate(to: impl Fn([f64; 3]) -> Option<([f64; 3], [f64; 3])>) -> Simulation {
    let mut case = struck([-20.0, -20.0, -4.0], [20.0, 20.0, 0.0]);
    let slab = Slab::new(&case, 1, [0.0, 0.0, 1.0], Include::All);
    assert_eq!(slab.before, [0, 1]);
    let rear = Debris {
        of: Some(0),
        point: [0.0, 0.0, -4.0 * D],
        direction: [0.0, 0.0, -1.0],
        bodies: vec![0, 1],
        outline: 1e-3,
        spacing: D,
    };
    case.measure.measures = measured(MeasureKind::Plate(slab));
    case.measure.measures.push(Measure {
        name: "debris".into(),
        kind: MeasureKind::Debris(rear),
    });
    let mut simulation = start(case);
    deform(&mut simulation, 1, to);
    simulation
}

const STILL: [f64; 3] = [0.0; 3];

/// A hole of radius 8 with lips to radius 10, two spacings high, before the face.
#[test]
fn a_plate_has_its_hole_and_lips() {
    let make = || {
        plate(|[x, y, z]| {
            let r = x.hypot(y);
            if r < 8.0 && z > -2.0 {
                // The lip: matter of the hole laid out on the rim.
                let turn = y.atan2(x);
                let (near, level) = (8.0 + 2.0 * (r / 8.0).powi(2), z + 2.0);
                Some(([near * turn.cos(), near * turn.sin(), level], STILL))
            } else if r < 8.0 {
                Some(([1.5 * x, 1.5 * y, z - 30.0], [0.0, 0.0, -2000.0]))
            } else {
                (r < 10.0).then_some(([x, y, z], STILL))
            }
        })
    };
    let mut simulation = make();
    let check = |simulation: &mut Simulation| {
        let found = measure(simulation);
        assert_eq!(told(&found, "verdict"), Told::Word("perforated"));
        is(&found, "hole_diameter", 16.0 * D);
        is(&found, "opening_diameter", 16.0 * D);
        is(&found, "mid_plane_hole_diameter", 16.0 * D);
        is(&found, "dish_depth", 0.0);
        assert!(number(&found, "deciding_spacing").is_nan());
        assert_eq!(number(&found, "rear_speed"), 0.0);
        is(&found, "front_lip_inner_diameter", 16.0 * D);
        is(&found, "front_lip_outer_diameter", 20.0 * D);
        is(&found, "front_height", 2.0 * D);
        is(&found, "rear_height", 0.0);
        assert!(number(&found, "rear_lip_inner_diameter").is_nan());
        // Half of the hole's matter has left, all of it to the rear.
        let density = simulation.case.density_of(1);
        let half = PI * 64.0 * 2.0 * D.powi(3) * density;
        let rear = number(&found, "rear_mass");
        assert!((rear / half - 1.0).abs() < 0.05, "{rear} for {half}");
        assert_eq!(number(&found, "front_mass"), 0.0);
        assert_eq!(number(&found, "passed_mass"), 0.0);
        // And flies together.
        assert!((number(&found, "mass") / rear - 1.0).abs() < 1e-12);
        let speed = number(&found, "axial_velocity");
        assert!((speed / 2000.0 - 1.0).abs() < 1e-9, "{speed}");
        is(&found, "front", 30.0 * D - 0.5 * D);
        found
    };
    check(&mut simulation);
    let (turn, shift) = moved();
    move_all(&mut simulation, &turn, shift);
    check(&mut simulation);
}

#[test]
fn plates_are_judged() {
    let verdict = |simulation: &mut Simulation| told(&measure(simulation), "verdict");
    let mut untouched = plate(|_| None);
    assert_eq!(verdict(&mut untouched), Told::Word("not_loaded"));
    // It flies as a whole, which is no load either; one particle that is pushed is one.
    deform(&mut untouched, 1, |x| Some((x, [0.0, 5.0, -300.0])));
    untouched.particles.plastic_strain.fill(0.0);
    assert_eq!(verdict(&mut untouched), Told::Word("not_loaded"));
    let struck = untouched.particles.body.iter().position(|&body| body == 1);
    untouched.particles.velocity[struck.unwrap()][2] -= 1.0;
    assert_eq!(verdict(&mut untouched), Told::Word("held"));
    // A dent without a gap.
    let dent = |[x, y, z]: [f64; 3]| {
        let deep = 3.0 * (1.0 - (x * x + y * y) / 144.0).max(0.0);
        Some(([x, y, z - deep], STILL))
    };
    let mut dented = plate(dent);
    assert_eq!(verdict(&mut dented), Told::Word("held"));
    is(&measure(&mut dented), "rear_height", 3.0 * D);
    is(&measure(&mut dented), "dish_depth", 3.0 * D);
    // The rear layers have parted from the others, and hold at the rim.
    let mut parted = plate(|[x, y, z]| {
        let deep = if z < -2.0 { 5.0 } else { 0.0 } * (1.0 - (x * x + y * y) / 144.0).max(0.0);
        Some(([x, y, z - deep], STILL))
    });
    assert_eq!(verdict(&mut parted), Told::Word("attached spall"));
    // They have left.
    let mut left = plate(|[x, y, z]| {
        let deep = if z < -2.0 && x.hypot(y) < 9.0 {
            12.0
        } else {
            0.0
        };
        Some(([x, y, z - deep], [0.0, 0.0, -deep]))
    });
    assert_eq!(verdict(&mut left), Told::Word("detached spall"));
    // What bulges far is not open, and has let nothing pass that lies in the bulge.
    let mut bulged = plate(|[x, y, z]| {
        let deep = 10.0 * (1.0 - (x * x + y * y) / 225.0).max(0.0);
        Some(([x, y, z - deep], [0.0, 0.0, -deep]))
    });
    deform(&mut bulged, 0, |[x, y, z]| {
        Some(([0.5 * x, 0.5 * y, 0.5 * z - 10.5], STILL))
    });
    let found = measure(&mut bulged);
    assert_eq!(told(&found, "verdict"), Told::Word("held"));
    assert_eq!(number(&found, "hole_diameter"), 0.0);
    is(&found, "dish_depth", 10.0 * D);
    assert!((number(&found, "rear_speed") - 10.0).abs() < 0.1);
    // As long as it goes on, that is no verdict.
    for i in 0..bulged.particles.owned() {
        bulged.particles.velocity[i][2] *= 50.0;
    }
    let found = measure(&mut bulged);
    assert_eq!(told(&found, "verdict"), Told::Word("still_moving"));
    let (speed, settling) = (
        number(&found, "moving_speed"),
        number(&found, "settling_time"),
    );
    println!("{speed} m/s, {settling} s");
    assert!((100.0..500.0).contains(&speed) && (1e-8..1e-4).contains(&settling));
    // What lies loose in the bulge has not left to the rear, however deep the bulge is.
    let mut loose = plate(|[x, y, z]| {
        let deep = 10.0 * (1.0 - (x * x + y * y) / 225.0).max(0.0);
        let up = if z > -1.0 && x.hypot(y) < 6.0 {
            3.5
        } else {
            0.0
        };
        Some(([x, y, z - deep + up], STILL))
    });
    let found = measure(&mut loose);
    assert_eq!(told(&found, "verdict"), Told::Word("held"));
    assert_eq!(number(&found, "rear_mass"), 0.0);
    let layer = PI * 36.0 * D.powi(3) * loose.case.density_of(1);
    let front = number(&found, "front_mass");
    assert!((front / layer - 1.0).abs() < 0.1, "{front} for {layer}");
    // The ball is behind it, though nothing is open.
    let mut passed = plate(|_| None);
    deform(&mut passed, 0, |[x, y, z]| Some(([x, y, z - 30.0], STILL)));
    assert_eq!(verdict(&mut passed), Told::Word("perforated"));
    let ball = passed.case.density_of(0) * 4.0 / 3.0 * PI * (4.0 * D).powi(3);
    let mass = number(&measure(&mut passed), "passed_mass");
    assert!((mass / ball - 1.0).abs() < 0.05);
    // What flies past the rim has not gone through, wherever it is by then; what came through and flies
    // outward has.
    for (x, sideways, through) in [(40.0, 0.0, false), (10.0, -1.0, false), (40.0, 1.0, true)] {
        let mut flown = plate(|_| None);
        deform(&mut flown, 0, |[a, b, c]| {
            Some(([a + x, b, c - 50.0], [30.0 * sideways, 0.0, -45.0]))
        });
        let found = measure(&mut flown);
        let word = if through { "perforated" } else { "not_loaded" };
        assert_eq!(told(&found, "verdict"), Told::Word(word), "{x} {sideways}");
        assert_eq!(number(&found, "passed_mass") > 0.0, through, "{x}");
    }
}

/// A hole in the bottom of a dish is what one sees through it, one column wide it is a pinhole, and a few
/// particles behind a plate are no spall.
#[test]
fn plates_are_judged_by_what_is_clear() {
    for (radius, deep, word) in [(5.0, 10.0, "perforated"), (0.6, 0.0, "pinhole")] {
        let mut pierced = plate(|[x, y, z]| {
            let deep = deep * (1.0 - (x * x + y * y) / 225.0).max(0.0);
            let r = (x - 1.0).hypot(y - 0.5);
            let out = if r < radius {
                1.0 + 12.0 / r.max(0.5)
            } else {
                1.0
            };
            Some((
                [
                    out * x,
                    out * y,
                    if r < radius { 10.0 + z } else { z - deep },
                ],
                STILL,
            ))
        });
        let found = measure(&mut pierced);
        let hole = number(&found, "hole_diameter");
        assert_eq!(told(&found, "verdict"), Told::Word(word), "{hole}");
        assert!(
            (hole - 2.0 * radius * D).abs() < 1.5 * D,
            "{radius}: {hole}"
        );
        let deciding = number(&found, "deciding_spacing");
        assert!(deciding == hole / 4.0 || word == "perforated" && deciding.is_nan());
        // What has bent away from the middle of the plate is no hole there.
        let middle = number(&found, "mid_plane_hole_diameter");
        assert!(
            if deep > 0.0 {
                middle.is_nan()
            } else {
                middle == hole
            },
            "{middle}"
        );
        is(
            &found,
            "dish_depth",
            deep * D * (1.0 - radius * radius / 225.0),
        );
    }
    // A slit is no wider than a rod that passes it, however long it is: it opens what a wide one does not.
    for (wide, word) in [(0.6, "pinhole"), (2.1, "perforated")] {
        let mut slit = plate(|[x, y, z]| {
            let (x0, y0) = (x - 0.5, y - 0.5);
            let is_open = x0.abs() < 9.0 && y0.abs() < wide;
            Some(([x, y, if is_open { z + 20.0 } else { z }], STILL))
        });
        let found = measure(&mut slit);
        let (hole, opening) = (
            number(&found, "hole_diameter"),
            number(&found, "opening_diameter"),
        );
        assert_eq!(told(&found, "verdict"), Told::Word(word), "{hole}");
        assert!((hole - 2.0 * wide * D).abs() < 1.5 * D, "{wide}: {hole}");
        let area = 18.0 * 2.0 * wide;
        assert!(
            (opening / D - (4.0 * area / PI).sqrt()).abs() < 1.0,
            "{opening}"
        );
    }
    // What has left to the rear besides a narrow way does not decide that.
    let mut both = plate(|[x, y, z]| {
        if (x - 1.0).hypot(y - 0.5) < 0.6 {
            return Some(([x, y, z + 20.0], STILL));
        }
        let left = (x + 8.0).hypot(y) < 5.0 && z < -2.0;
        Some(([x, y, if left { z - 15.0 } else { z }], STILL))
    });
    let found = measure(&mut both);
    assert_eq!(told(&found, "verdict"), Told::Word("detached spall"));
    let hole = number(&found, "hole_diameter");
    assert_eq!(number(&found, "deciding_spacing"), hole / 4.0);
    // A few particles behind it are no spall.
    let mut stray = plate(|[x, y, z]| {
        (x.hypot(y) < 1.0 && z < -3.0).then_some(([x, y, z - 20.0], [0.0, 0.0, -500.0]))
    });
    let found = measure(&mut stray);
    assert_eq!(told(&found, "verdict"), Told::Word("held"));
    assert_eq!(number(&found, "rear_mass"), 0.0);
}

/// A crater of a ball is told against the ball's own surface, not against the plane before it.
#[test]
fn a_crater_of_a_ball_does_not_count_its_curvature() {
    let radius = 24.0;
    let ball = |centre: f64, radius: f64| Shape::Sphere {
        centre: Vec3::new(0.0, 0.0, centre * D),
        radius: radius * D,
    };
    let bodies = vec![
        body("grain", ball(6.0, 4.0), D, Vec3::new(0.0, 0.0, -3000.0)),
        body("moon", ball(-radius, radius), D, Vec3::zeros()),
    ];
    let mut case = case(3, bodies, 1.0);
    let slab = Slab::new(&case, 1, [0.0, 0.0, 1.0], Include::All);
    case.measure.measures = measured(MeasureKind::Target(slab));
    let mut simulation = start(case);
    deform(&mut simulation, 1, |[x, y, z]| {
        let r = (x * x + y * y + z * z).sqrt();
        if r < 8.0 {
            Some(([2.0 * x, 2.0 * y, 40.0 - z], [100.0 * x, 100.0 * y, 500.0]))
        } else {
            (r < 10.0).then_some(([x, y, z], STILL))
        }
    });
    // What two balls share.
    let drop = 64.0 / (2.0 * radius);
    let cap = |radius: f64, height: f64| PI * height * height * (radius - height / 3.0);
    let volume = (cap(8.0, 8.0 - drop) + cap(radius, drop)) * D.powi(3);
    for _ in 0..2 {
        let found = measure(&mut simulation);
        is(&found, "crater_depth", 8.0 * D);
        is(
            &found,
            "crater_diameter",
            2.0 * (64.0 - drop * drop).sqrt() * D,
        );
        is(&found, "crater_volume", volume);
        is(&found, "rim_height", 0.0);
        let (turn, shift) = moved();
        move_all(&mut simulation, &turn, shift);
    }
}

/// A half ball of radius 8 thrown out of a block of 40 × 40 × 16 spacings.
#[test]
fn a_target_has_its_crater() {
    let mut case = struck([-20.0, -20.0, -16.0], [20.0, 20.0, 0.0]);
    let slab = Slab::new(&case, 1, [0.0, 0.0, 1.0], Include::All);
    case.measure.measures = measured(MeasureKind::Target(slab));
    case.measure.measures.push(Measure {
        name: "ejecta".into(),
        kind: MeasureKind::Debris(Debris {
            of: Some(0),
            point: STILL,
            direction: [0.0, 0.0, 1.0],
            bodies: vec![0, 1],
            outline: 1e-3,
            spacing: D,
        }),
    });
    let mut simulation = start(case);
    deform(&mut simulation, 1, |[x, y, z]| {
        let r = (x * x + y * y + z * z).sqrt();
        if r < 8.0 {
            Some(([2.0 * x, 2.0 * y, 40.0 - z], [100.0 * x, 100.0 * y, 500.0]))
        } else {
            (r < 10.0).then_some(([x, y, z], STILL))
        }
    });
    let check = |simulation: &mut Simulation| {
        let found = measure(simulation);
        let volume = 2.0 / 3.0 * PI * (8.0 * D).powi(3);
        is(&found, "crater_depth", 8.0 * D);
        is(&found, "crater_diameter", 16.0 * D);
        is(&found, "crater_volume", volume);
        is(&found, "rim_height", 0.0);
        let mass = volume * simulation.case.density_of(1);
        let removed = number(&found, "removed_mass");
        assert!((removed / mass - 1.0).abs() < 0.05, "{removed} for {mass}");
        let impulse = simulation.state.remembered[0].impulse.unwrap();
        let beta = number(&found, "momentum_enhancement");
        assert!((beta - 1.0 - removed * 500.0 / impulse).abs() < 1e-9);
        // The profile is that of the half ball.
        for [from, to, depth] in &found[0].distributions[0].bins {
            let r = 0.5 * (from + to) / D;
            let expected = (64.0 - r * r).max(0.0).sqrt() * D;
            if (r - 8.0).abs() > 1.5 {
                assert!(
                    (depth - expected).abs() < 0.6 * D,
                    "{r}: {depth} {expected}"
                );
            }
        }
    };
    check(&mut simulation);
    let (turn, shift) = moved();
    move_all(&mut simulation, &turn, shift);
    check(&mut simulation);
}

/// A bar of a diameter and a length (in spacings) on its foot, filled by a lattice, with its measure.
fn rod(kind: LatticeKind, [diameter, length]: [f64; 2]) -> Case {
    let shape = Shape::Cylinder {
        centre: Vec3::new(0.0, 0.0, 0.5 * length * D),
        axis: Axis::Z,
        radius: 0.5 * diameter * D,
        length: length * D,
    };
    let mut rod = body("bar", shape, D, Vec3::zeros());
    rod.lattice.kind = kind;
    let mut case = case(3, vec![rod], 1.0);
    case.measure.measures = measured(MeasureKind::Bar(Bar {
        body: 0,
        foot: [0.0, 0.0, -1.0],
        spacing: D,
    }));
    case
}

/// The same cut by planes through its axis.
fn cut(mut case: Case, axes: &[Axis]) -> Case {
    let plane = |&axis: &Axis| SymmetryPlane {
        axis,
        position: 0.0,
    };
    case.symmetry = axes.iter().map(plane).collect();
    case
}

const QUARTER: [Axis; 2] = [Axis::X, Axis::Y];

/// Stretches a bar across itself, by a factor of the height (in spacings), and squeezes it along itself so that it
/// keeps its volume; gives the height of its head (in spacings).
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small counts"
)]
fn stretch(simulation: &mut Simulation, length: f64, by: impl Fn(f64) -> f64) -> f64 {
    const PIECES: usize = 20_000;
    let piece = length / PIECES as f64;
    let mut heights = vec![0.0];
    for k in 0..PIECES {
        let squeezed = by((k as f64 + 0.5) * piece).powi(-2);
        heights.push(heights[k] + piece * squeezed);
    }
    deform(simulation, 0, |[x, y, z]| {
        let at = z / piece;
        let below = (at as usize).min(PIECES - 1);
        let height = heights[below] + (at - below as f64) * (heights[below + 1] - heights[below]);
        Some(([by(z) * x, by(z) * y, height], STILL))
    });
    heights[PIECES]
}

/// That a bar's figure is what it should be (in spacings) to half a spacing, which has grown so many times.
fn is_near(found: &[Findings], name: &str, expected: f64, grown: f64, what: &str) {
    let off = (number(found, name) - expected * D) / (grown * D);
    println!("{what}: {name} {off:+.2}");
    assert!(off.abs() <= 0.5, "{what}: {name} is off by {off} spacings");
}

/// Bars as they are filled, whole and in quarters, are as long and as wide as their shape.
#[test]
fn bars_have_their_diameter_in_any_filling() {
    for kind in [
        LatticeKind::Cubic,
        LatticeKind::BodyCentred,
        LatticeKind::FaceCentred,
        LatticeKind::Hexagonal,
        LatticeKind::Rings,
        LatticeKind::Glass,
    ] {
        for diameter in [8.0, 12.0, 16.0, 24.0] {
            let whole = rod(kind, [diameter, 3.0 * diameter]);
            let mut figures = Vec::new();
            for case in [whole.clone(), cut(whole, &QUARTER)] {
                let what = format!("{kind:?} {diameter} {}", case.symmetry.len());
                let found = measure(&mut start(case));
                // Layers of some lattices are closer than particles, and do not fit the length.
                let fits = matches!(kind, LatticeKind::Cubic | LatticeKind::Glass);
                let doubt = if fits { 1.0 } else { 2.0 };
                is_near(&found, "length", 3.0 * diameter, doubt, &what);
                is_near(&found, "foot_diameter", diameter, 1.0, &what);
                is_near(&found, "largest_diameter", diameter, 1.0, &what);
                figures.push(number(&found, "largest_diameter") / D);
            }
            assert!((figures[0] - figures[1]).abs() < 0.5, "{figures:?}");
        }
    }
}

/// A mushroom whose foot is squeezed to less than a third of its height: quarter, whole, turned; one stray particle
/// changes nothing.
#[test]
fn a_mushroom_has_its_foot() {
    for kind in [LatticeKind::Cubic, LatticeKind::Glass] {
        let (diameter, length) = (16.0, 48.0);
        let whole = rod(kind, [diameter, length]);
        for (case, moves) in [
            (cut(whole.clone(), &QUARTER), false),
            (cut(whole.clone(), &QUARTER[..1]), false),
            (whole.clone(), false),
            (whole, true),
        ] {
            let what = format!("{kind:?} {} {moves}", case.symmetry.len());
            let mut simulation = start(case);
            let by = |z: f64| 1.0 + 0.8 * (-(z / 8.0).powi(2)).exp();
            let head = stretch(&mut simulation, length, by);
            if moves {
                let (turn, shift) = moved();
                move_all(&mut simulation, &turn, shift);
            }
            let found = measure(&mut simulation);
            is_near(&found, "length", head, 1.0, &what);
            is_near(&found, "foot_diameter", 1.8 * diameter, 1.8, &what);
            is_near(&found, "largest_diameter", 1.8 * diameter, 1.8, &what);
            assert!(number(&found, "largest_at") < 2.0 * D);
            let profile = &found[0].distributions[0].bins;
            let [from, to, shaft] = profile[profile.len() / 2];
            assert!(
                (shaft - diameter * D).abs() < 0.5 * D,
                "{from} {to} {shaft}"
            );
            let ends: Vec<f64> = profile
                .windows(2)
                .map(|pair| pair[1][0] - pair[0][1])
                .collect();
            assert!(ends.iter().all(|gap| *gap == 0.0), "{profile:?}");
            assert_eq!(profile[profile.len() - 1][1], number(&found, "length"));
            // A stray particle beside the foot.
            let before = number(&found, "largest_diameter");
            let particles = &mut simulation.particles;
            let foot = number(&found, "foot_diameter");
            if !moves {
                let lowest = (0..particles.owned())
                    .min_by(|&a, &b| particles.position[a][2].total_cmp(&particles.position[b][2]));
                particles.position[lowest.unwrap()][0] = 2.0 * foot;
                let after = number(&measure(&mut simulation), "largest_diameter");
                assert!(
                    (after - before).abs() < 0.25 * D,
                    "{what}: {before} {after}"
                );
            }
        }
    }
}

/// A bar that hits its mirror image, a thin wire, a prism, a tube, and a bar without particles.
#[test]
fn bars_of_all_kinds_have_diameters() {
    let half = cut(rod(LatticeKind::Cubic, [10.0, 40.0]), &[Axis::Z]);
    let found = measure(&mut start(half));
    is_near(&found, "length", 80.0, 1.0, "mirrored");
    is_near(&found, "largest_diameter", 10.0, 1.0, "mirrored");
    let found = measure(&mut start(rod(LatticeKind::Cubic, [2.0, 20.0])));
    is_near(&found, "length", 20.0, 1.0, "wire");
    is_near(&found, "largest_diameter", 2.0, 1.0, "wire");
    let mut prism = rod(LatticeKind::Cubic, [1.0, 1.0]);
    let corner = Vec3::new(6.0, 6.0, 0.0) * D;
    prism.bodies[0].shape = Shape::Box {
        lower: -corner,
        upper: corner + Vec3::new(0.0, 0.0, 40.0 * D),
    };
    let found = measure(&mut start(prism));
    is_near(&found, "length", 40.0, 1.0, "prism");
    let wide = number(&found, "largest_diameter") / D;
    assert!((12.0..12.0 * 2_f64.sqrt()).contains(&wide), "{wide}");
    let mut simulation = start(rod(LatticeKind::Cubic, [10.0, 40.0]));
    simulation.particles.body.fill(7);
    simulation
        .case
        .bodies
        .resize(8, simulation.case.bodies[0].clone());
    assert!(number(&measure(&mut simulation), "length").is_nan());
}

/// The same bits on any number of ranks.
#[test]
fn bars_have_the_same_bits_on_any_ranks() {
    let figures = |ranks: usize| {
        let found = on_virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let case = rod(LatticeKind::Glass, [12.0, 36.0]);
            let mut simulation = Simulation::start(case, comm).unwrap();
            format!("{:?}", measurements::findings(&mut simulation, comm))
        });
        assert!(found.iter().all(|figures| *figures == found[0]));
        found[0].clone()
    };
    let alone = figures(1);
    for ranks in [2, 5, 16] {
        assert_eq!(figures(ranks), alone, "{ranks} ranks");
    }
}

/// A ball of debris that flies and grows.
#[test]
fn debris_has_its_extents_and_velocities() {
    let shape = Shape::Sphere {
        centre: Vec3::new(0.0, 0.0, 40.0 * D),
        radius: 12.0 * D,
    };
    let mut case = case(3, vec![body("cloud", shape, D, Vec3::zeros())], 1.0);
    let density = case.density_of(0);
    case.measure.measures = measured(MeasureKind::Debris(Debris {
        of: None,
        point: STILL,
        direction: [0.0, 0.0, 1.0],
        bodies: vec![0],
        // Half of one particle in its own square.
        outline: 0.5 * density * D,
        spacing: D,
    }));
    let mut simulation = start(case);
    deform(&mut simulation, 0, |[x, y, z]| {
        Some(([x, y, z], [10.0 * x, 10.0 * y, 1000.0 + 10.0 * (z - 40.0)]))
    });
    let check = |simulation: &mut Simulation| {
        let found = measure(simulation);
        let mass = density * 4.0 / 3.0 * PI * (12.0 * D).powi(3);
        assert!((number(&found, "mass") / mass - 1.0).abs() < 0.02);
        is(&found, "middle_50", 40.0 * D);
        is(&found, "front", 51.5 * D);
        // Where the ends of a ball with a hundredth of its volume begin.
        is(&found, "front_99", (40.0 + 12.0 * 0.8826) * D);
        is(&found, "rear_1", (40.0 - 12.0 * 0.8826) * D);
        is(&found, "outline_length", 24.0 * D);
        is(&found, "outline_width", 24.0 * D);
        let speed = number(&found, "axial_velocity");
        assert!((speed - 1000.0).abs() < 1e-9 * speed);
        // Mean distance from the axis, 3π/16 of the radius, times the rate.
        let radial = number(&found, "radial_momentum") / number(&found, "mass");
        let expected = 10.0 * 12.0 * 3.0 * PI / 16.0;
        assert!(
            (radial / expected - 1.0).abs() < 0.01,
            "{radial} {expected}"
        );
        for distribution in &found[0].distributions {
            let sum: f64 = distribution.bins.iter().map(|bin| bin[2]).sum();
            assert!((sum / number(&found, "mass") - 1.0).abs() < 1e-9);
        }
    };
    check(&mut simulation);
    let (turn, shift) = moved();
    move_all(&mut simulation, &turn, shift);
    check(&mut simulation);
}

/// The mean of a field, and who belongs to a region that moves.
#[test]
fn regions_tell_means_and_extremes() {
    let mut case = struck([-6.0, -6.0, -12.0], [6.0, 6.0, 0.0]);
    let zone = |mark| {
        MeasureKind::Zone(Zone {
            place: ZonePlace::Ball {
                centre: [0.0, 0.0, -6.0 * D],
                radius: 4.0 * D,
            },
            mark,
            body: Some(1),
            fields: vec!["velocity".into(), "pressure".into()],
        })
    };
    case.measure.measures = measured(zone(Some(3)));
    let mut fixed = case.clone();
    fixed.measure.measures = measured(zone(None));
    let (mut simulation, mut fixed) = (start(case), start(fixed));
    for simulation in [&mut simulation, &mut fixed] {
        // It moves by two spacings, and turns about its axis.
        deform(simulation, 1, |[x, y, z]| {
            Some(([x, y, z + 2.0], [-y, x, 7.0]))
        });
        for i in 0..simulation.particles.owned() {
            simulation.particles.pressure[i] = 1e9 * simulation.particles.position[i][2] / D;
        }
    }
    let found = measure(&mut simulation);
    let mass = simulation.case.density_of(1) * 4.0 / 3.0 * PI * (4.0 * D).powi(3);
    assert!((number(&found, "mass") / mass - 1.0).abs() < 0.1);
    assert!(number(&found, "velocity_x_mean").abs() < 1e-12);
    assert!((number(&found, "velocity_z_mean") - 7.0).abs() < 1e-12);
    assert_eq!(number(&found, "velocity_x_largest"), 3.5);
    assert!((number(&found, "pressure_mean") + 4e9).abs() < 1.0);
    assert_eq!(number(&found, "pressure_least").round(), -7.5e9);
    // What is fixed reads other matter now.
    let found = measure(&mut fixed);
    assert!((number(&found, "pressure_mean") + 6e9).abs() < 1.0);
}

/// A step of pressure that moves along a line.
#[test]
fn a_front_is_followed() {
    let lower = Vec3::new(-30.0, -4.0, -4.0) * D;
    let upper = Vec3::new(30.0, 4.0, 4.0) * D;
    let block = body("block", Shape::Box { lower, upper }, D, Vec3::zeros());
    let mut case = case(3, vec![block], 1.0);
    case.measure.measures = measured(MeasureKind::Front(FrontLine {
        from: [-28.0 * D, 0.0, 0.0],
        to: [28.0 * D, 0.0, 0.0],
        radius: 1.5 * D,
        piece: 0.5 * D,
        pressure: None,
    }));
    let mut simulation = start(case);
    let found = measure(&mut simulation);
    assert!(number(&found, "position").is_nan() && number(&found, "speed").is_nan());
    for (step, turned) in [(0, false), (1, false), (2, true)] {
        let at = -10.0 + 5.0 * f64::from(step);
        for i in 0..simulation.particles.owned() {
            let x = simulation.particles.position[i][0] / D;
            simulation.particles.pressure[i] = 5e9 * (0.5 - 0.25 * (x - at)).clamp(0.0, 1.0);
        }
        if turned {
            let (turn, shift) = moved();
            move_all(&mut simulation, &turn, shift);
        }
        simulation.state.time = f64::from(step) * 1e-7;
        let found = measure(&mut simulation);
        is(&found, "position", (28.0 + at) * D);
        if step > 0 {
            is(&found, "speed", 5.0 * D / 1e-7);
        }
    }
}

/// A plate that is turned, with a hole that it is made with: its face is its own, and that hole is none.
#[test]
fn turned_and_pierced_plates_are_plates() {
    let text = r#"
dimension = 3
spacing = "0.1 mm"
run.end_time = "1 us"
[material.metal]
library = "aluminium-2024"
[[body]]
name = "ball"
material = "metal"
shape.sphere = { centre = [0, 0, "2 mm"], radius = "0.4 mm" }
velocity = [0, 0, "-3 km/s"]
[[body]]
name = "panel"
material = "metal"
lattice = "cubic"
[body.shape]
turn = { axis = "x", angle = "30 deg" }
difference = [
    { box = { lower = ["-2 mm", "-2 mm", "-0.2 mm"], upper = ["2 mm", "2 mm", "0.2 mm"] } },
    { cylinder = { axis = "z", radius = "0.4 mm", length = "1 mm", centre = ["1.3 mm", "1.3 mm", 0] } },
]
"#;
    let case = files::input::parse("case", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let MeasureKind::Plate(slab) = &case.measure.measures[0].kind else {
        panic!("{:?}", case.measure.measures);
    };
    let normal = [0.0, -0.5, 0.75_f64.sqrt()];
    for (a, b) in slab.normal.iter().zip(normal) {
        assert!((a - b).abs() < 1e-12, "{:?}", slab.normal);
    }
    assert!((slab.thickness() - 4.0 * D).abs() < 1e-12);
    let mut simulation = start(case);
    deform(&mut simulation, 1, |x| Some((x, STILL)));
    let found = measure(&mut simulation);
    assert_eq!(told(&found, "verdict"), Told::Word("held"));
    assert_eq!(number(&found, "hole_diameter"), 0.0);
    // A hole is shot through its middle.
    deform(&mut simulation, 1, |[x, y, z]| {
        let along = 0.75_f64.sqrt() * y + 0.5 * z;
        (x.hypot(along) < 6.0).then_some(([x, y + 15.0, z - 26.0], STILL))
    });
    let found = measure(&mut simulation);
    assert_eq!(told(&found, "verdict"), Told::Word("perforated"));
    is(&found, "hole_diameter", 12.0 * D);
}
