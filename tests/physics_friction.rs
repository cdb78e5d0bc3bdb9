//! Coulomb friction: a block on a slope.

mod physics_support;

use physics_support::{inline, run_with, slope, start};
use whipple::comm::Comm;
use whipple::step::Simulation;

/// A soft block on a rigid slope, whose weight is a hundredth of its stiffness; two dimensions.
/// Gravity has a component along the slope.
fn block(friction: &str, tangent: f64, angle: f64, end: &str) -> String {
    let down = 200.0;
    let along = tangent * down;
    format!(
        r#"
dimension = 2
spacing = "1 mm"
gravity = ["{along:.12} m/s^2", "-{down} m/s^2"]
[run]
end_time = "{end}"
[material.soft]
density = "1 g/cm^3"
eos.linear = {{ bulk_modulus = "4 MPa" }}
strength.elastic = {{ shear_modulus = "2 MPa" }}
[contact]
friction = {friction}
damping = 0.2
[[body]]
name = "slope"
rigid = true
shape.box = {{ lower = ["-15 mm", "-4 mm"], upper = ["40 mm", 0] }}
[[body]]
name = "block"
material = "soft"
lattice = {{ kind = "cubic", angle = "{angle} deg" }}
shape.box = {{ lower = ["-10 mm", 0], upper = ["10 mm", "8 mm"] }}
touch = {{ body = "slope", direction = "-y" }}
"#
    )
}

/// Mean velocity of the block along the slope (m/s).
fn speed(s: &Simulation) -> f64 {
    s.state.totals.momentum[0] / s.state.totals.mass
}

/// The block at rest on a slope of tangent `tangent`, laid there with less.
fn settle(friction: &str, tangent: f64, angle: f64) -> Simulation {
    let mut s = start(inline(&block(friction, tangent, angle, "1 s")));
    run_with(&mut s, 10e-3, |_| {});
    s
}

/// The same particles on another slope.
fn tilt(s: &Simulation, friction: &str, tangent: f64, angle: f64) -> Simulation {
    let case = inline(&block(friction, tangent, angle, "1 s"));
    let mut store = s.store.clone();
    store.resize_halo(0);
    Simulation::resume(case, &Comm::solo(), s.state.clone(), store).expect("it resumes")
}

/// Tilts the slope in small steps until the block has slid by a hundredth of a spacing within one,
/// and returns the tangent.
fn critical(friction: &str, step: f64, angle: f64) -> f64 {
    let mut tangent = 46.0 * step;
    let mut s = settle(friction, 0.0, angle);
    for part in 1..=12 {
        s = tilt(&s, friction, f64::from(part) / 12.0 * tangent, angle);
        let end = s.state.time + 3e-3;
        run_with(&mut s, end, |_| {});
    }
    loop {
        tangent += step;
        s = tilt(&s, friction, tangent, angle);
        let end = s.state.time + 4e-3;
        let mut way = 0.0;
        run_with(&mut s, end, |s| way += s.state.last_dt * speed(s));
        let sliding = s.store.sliding.iter().filter(|&&x| x == 1).count();
        println!(
            "{friction} {angle} {tangent:.4}: way {way:e}, sliding {sliding} of {}, speed {:e}",
            s.state.pairs[0].touching,
            speed(&s)
        );
        if way > 1e-5 {
            return tangent;
        }
    }
}

/// Acceleration from 5 to 25 ms (m/s²), and the way (m). Prints the friction of the interface and that
/// of the laws of its particles over the normal force.
fn slide(s: &mut Simulation) -> (f64, f64) {
    let (mut normal, mut along, mut laws) = (0.0, 0.0, 0.0);
    let from = s.state.time;
    let (mut points, mut way) = (Vec::new(), 0.0);
    run_with(s, from + 25e-3, |s| {
        way += s.state.last_dt * speed(s);
        if s.state.time > from + 5e-3 {
            points.push((s.state.time, speed(s)));
            let f = s.state.pairs[0].force;
            normal -= f[1];
            along += f[0];
            for i in 0..s.store.owned() {
                let sign = if s.store.body[i] == 1 { -1.0 } else { 1.0 };
                laws += sign * s.store.friction_force.get(i).map_or(0.0, |f| f[0]);
            }
        }
    });
    println!(
        "along/normal {:.4}, laws/normal {:.4}",
        along / normal,
        laws / normal
    );
    (slope(&points), way)
}

#[test]
fn a_block_starts_to_slide_at_the_angle_of_friction() {
    for angle in [0.0, 30.0] {
        let tangent = critical("0.3", 0.006, angle);
        // The slope is tilted by two hundredths of that at a time.
        assert!((tangent / 0.3 - 1.0).abs() <= 0.021, "{angle}: {tangent}");
    }
}

#[test]
fn a_block_slides_with_the_exact_acceleration() {
    for (friction, kinetic) in [
        ("0.3", 0.3),
        ("{ static = 0.4, kinetic = 0.3 }", 0.3),
        ("0", 0.0),
    ] {
        for angle in [0.0, 30.0] {
            {
                let tangent = 0.45;
                let mut s = start(inline(&block(friction, tangent, angle, "1 s")));
                let (acceleration, way) = slide(&mut s);
                let exact = 200.0 * (tangent - kinetic);
                let worst = &s.state.worst;
                println!(
                    "{friction} {tangent} {angle}: {:.5}, way {way:e}, heat {:e}, error {:e}, defect {:e}, momentum {:?}",
                    acceleration / exact - 1.0,
                    s.state.contact_heat(),
                    worst.energy_error,
                    worst.contact_defect,
                    worst.momentum_error
                );
                let error = (acceleration / exact - 1.0).abs();
                // A turned lattice stands on three particles and rocks: measured, not held.
                assert!(
                    angle > 0.0 || error <= 0.02,
                    "{friction} {tangent} {angle}: {error}"
                );
                assert!(worst.contact_defect < 0.002);
            }
        }
    }
}

/// What is wrong with friction in an input.
#[test]
fn mistakes_are_told() {
    for (friction, told) in [
        ("-0.1", "`friction` must be zero or positive"),
        (
            "{ static = 0.3, kinetic = 0.4 }",
            "`kinetic` must be at most `static`",
        ),
        (
            "\"much\"",
            "a number, or a table with `static` and `kinetic`",
        ),
        (
            "0.3\nmode = \"potential\"",
            "acts in no contact but that of mode `overlap`",
        ),
    ] {
        let text = block(friction, 0.0, 0.0, "1 s");
        let error = whipple::input::parse("test.toml", &text, &[]).expect_err("a mistake");
        assert!(error.to_string().contains(told), "{error}");
    }
}
