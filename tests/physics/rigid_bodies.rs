//! Rigid bodies that forces move: free rotation, bounces, rolling, eccentric impacts, a pendulum.

use crate::physics_support::{inline, run_to, run_with, start};
use engine::step::{RigidState, Simulation};
use numerics::attitude::rotation;
use numerics::vector::{dot, minus, norm};

/// A case of a soft material, of a spacing and a bulk modulus (mm, `MPa`), with gravity downwards or none, and what else it
/// has.
fn case((dimension, spacing): (usize, f64), modulus: f64, falls: bool, rest: &str) -> Simulation {
    let gravity = format!("gravity = [{}\"-10 m/s^2\"]", "0, ".repeat(dimension - 1));
    start(inline(&format!(
        r#"
dimension = {dimension}
spacing = "{spacing} mm"
run.end_time = "100 s"
{gravity}
[material.soft]
density = "1 g/cm^3"
eos.linear.bulk_modulus = "{modulus} MPa"
strength.elastic.shear_modulus = "{shear} MPa"
{rest}
"#,
        gravity = if falls { &gravity } else { "" },
        shear = 0.5 * modulus
    )))
}

/// A free rigid body.
fn free(name: &str, lattice: &str, shape: &str, more: &str) -> String {
    format!(
        "[[body]]\nname = \"{name}\"\nrigid = true\nfree = true\nmaterial = \"soft\"\n\
         lattice = \"{lattice}\"\nshape.{shape}\n{more}\n"
    )
}

fn state(s: &Simulation) -> &RigidState {
    &s.state.rigid[0]
}

fn most(errors: &[f64; 3]) -> f64 {
    errors.iter().fold(0.0, |most, &error| error.max(most))
}

/// Momentum and angular momentum are exact.
fn assert_momenta(s: &Simulation) {
    let worst = &s.state.worst;
    let errors = [&worst.momentum_error, &worst.angular_momentum_error].map(most);
    println!(
        "{} steps, energy {:e}, momenta {errors:?}",
        s.state.step, worst.energy_error
    );
    assert!(errors[0] < 1e-13 && errors[1] < 1e-12, "{errors:?}");
}

/// Solves `y' = f(y)` from `first` on (Runge–Kutta of fourth order).
fn solve<const N: usize>(
    first: [f64; N],
    (time, steps): (f64, u32),
    f: impl Fn(&[f64; N]) -> [f64; N],
) -> [f64; N] {
    let dt = time / f64::from(steps);
    let go = |y: &[f64; N], k: &[f64; N], dt: f64| std::array::from_fn(|a| y[a] + dt * k[a]);
    (0..steps).fold(first, |y, _| {
        let k1 = f(&y);
        let k2 = f(&go(&y, &k1, 0.5 * dt));
        let k3 = f(&go(&y, &k2, 0.5 * dt));
        let k4 = f(&go(&y, &k3, dt));
        std::array::from_fn(|a| y[a] + dt / 6.0 * (k1[a] + 2.0 * (k2[a] + k3[a]) + k4[a]))
    })
}

/// A brick that spins about each of its axes, tumbles from the middle one and turns at random, by Euler's equations.
#[test]
fn a_free_brick_turns_as_euler_says() {
    for (spin, within) in [
        ([300.0, 0.0, 0.0], 1e-14),
        ([0.0, 300.0, 0.0], 1e-14),
        ([0.0, 0.0, 300.0], 1e-14),
        ([1.0, 300.0, 2.0], 1e-6),
        ([200.0, -150.0, 90.0], 1e-6),
    ] {
        let [x, y, z] = spin;
        let brick = free(
            "brick",
            "cubic",
            "box.size = [\"3 mm\", \"4 mm\", \"6 mm\"]",
            &format!(
                "velocity = [\"3 m/s\", 0, 0]\n\
                 angular_velocity = [\"{x} rad/s\", \"{y} rad/s\", \"{z} rad/s\"]"
            ),
        );
        let mut s = case((3, 1.0), 4.0, false, &brick);
        let begin = *state(&s);
        let energy = |body: &RigidState| 0.5 * dot(&body.spin(), &body.angular_momentum);
        let mut off = 0.0_f64;
        run_with(&mut s, 0.02, |s| {
            off = off.max((energy(state(s)) / energy(&begin) - 1.0).abs());
        });
        let end = state(&s);
        assert_eq!(begin.angular_momentum, end.angular_momentum);
        let (rotation, now) = (rotation(&end.attitude), end.spin());
        let own = std::array::from_fn(|a| (0..3).map(|b| rotation[b][a] * now[b]).sum());
        let [a, b, c, ..] = begin.inertia;
        let exact = solve(spin, (s.state.time, 20_000), |w| {
            [
                (b - c) / a * w[1] * w[2],
                (c - a) / b * w[2] * w[0],
                (a - b) / c * w[0] * w[1],
            ]
        });
        let error = norm(&minus(&own, &exact)) / norm(&spin);
        println!("{spin:?}: spin {error:e}, energy {off:e}");
        assert!(error < within && off < within, "{error:e} {off:e}");
        assert_momenta(&s);
    }
}

/// A ball bounces from a plane and from a block with its speed: the error falls with the square of the step.
#[test]
fn a_ball_bounces_with_its_speed() {
    let plane = "[[plane]]\nnormal = \"+z\"\npoint = [0, 0, \"-5 mm\"]";
    let block = "[[body]]\nname = \"floor\"\nrigid = true\nlattice = \"cubic\"\nshape.box = \
                 { lower = [\"-7 mm\", \"-7 mm\", \"-9 mm\"], upper = [\"7 mm\", \"7 mm\", \"-5 mm\"] }";
    let ball = free(
        "ball",
        "cubic",
        "sphere.radius = \"5 mm\"",
        "velocity = [0, 0, \"-1 m/s\"]",
    );
    let steps = [(0.65, 1e-3), (0.05, 2e-5), (0.0125, 1e-6)];
    for (ground, steps) in [(plane, &steps[..]), (block, &steps[..2])] {
        for &(courant, within) in steps {
            let text = format!("{ground}\n{ball}[time_step]\ncourant = {courant}");
            let mut s = case((3, 1.0), 4.0, false, &text);
            run_to(&mut s, 0.45e-3);
            let error = state(&s).velocity[2] - 1.0;
            println!("courant {courant}: {error:e}");
            assert!(error.abs() < within, "{error:e}");
            assert!(norm(&state(&s).spin()) < 1e-9);
            assert_momenta(&s);
        }
    }
}

/// A ring of one layer of particles that slides on a plane until it rolls: its speed then over `v/(1 + I/M r²)`, less one.
fn rolled(spacing: f64, stiffness: f64) -> f64 {
    let ring = format!(
        "sphere = {{ radius = \"20 mm\", inner_radius = \"{} mm\" }}",
        20.0 - spacing
    );
    let ring = free("ring", "rings", &ring, "velocity = [\"0.2 m/s\", 0]");
    let text = format!(
        "{ring}[[plane]]\nnormal = \"+y\"\npoint = [0, \"-20 mm\"]\nfriction = 0.3\n\
         stiffness = {stiffness}"
    );
    let mut s = case((2, spacing), 0.04, true, &text);
    run_to(&mut s, 0.06);
    assert_momenta(&s);
    let (r, body) = (1e-3 * (20.0 - 0.5 * spacing), state(&s));
    let exact = 0.2 / (1.0 + body.inertia[2] / (body.mass * r * r));
    let error = body.velocity[0] / exact - 1.0;
    println!("{spacing} mm: {error:e}");
    error
}

/// A ring is a polygon, whose corners are the rougher the fewer it has.
#[test]
fn a_ring_that_slides_ends_rolling() {
    assert!(rolled(1.0, 0.08).abs() < 1e-2);
    assert!(rolled(0.25, 0.3).abs() < 1e-3);
}

#[test]
#[ignore = "slow"]
fn a_fine_ring_rolls_exactly() {
    assert!(rolled(0.0625, 1.2).abs() < 2e-6);
}

/// A disc and a ball end at `v/(1 + I/M r²)`, two thirds and five sevenths for a radius without its last half spacing, but for
/// their roughness.
#[test]
fn a_disc_and_a_ball_end_rolling() {
    for (dimension, lattice, stiffness) in [(2, "rings", 0.08), (3, "shells", 0.02)] {
        let zeros = "0, ".repeat(dimension - 1);
        let rest = ", 0".repeat(dimension - 1);
        let up = ["+y", "+z"][dimension - 2];
        let velocity = format!("velocity = [\"0.2 m/s\"{rest}]");
        let body = free("body", lattice, "sphere.radius = \"10 mm\"", &velocity);
        let text = format!(
            "{body}[[plane]]\nnormal = \"{up}\"\npoint = [{zeros}\"-10 mm\"]\nfriction = 0.3\n\
             stiffness = {stiffness}"
        );
        let mut s = case((dimension, 1.0), 0.04, true, &text);
        run_to(&mut s, 0.04);
        let (r, body) = (9.5e-3, state(&s));
        let exact = 0.2 / (1.0 + body.inertia[2] / (body.mass * r * r));
        let error = body.velocity[0] / exact - 1.0;
        println!("{error:e}, share {}", body.velocity[0] / 0.2);
        assert!(error.abs() < 0.03, "{error:e}");
        assert_momenta(&s);
    }
}

/// Two free balls that meet off their centres keep momentum, angular momentum and energy.
#[test]
fn balls_that_meet_off_centre_keep_all_momenta() {
    let ball = |name, at: &str, speed: &str| {
        let motion = format!(
            "velocity = [\"{speed}\", 0, 0]\nangular_velocity = [\"20 rad/s\", 0, \"50 rad/s\"]"
        );
        let shape = format!("sphere = {{ radius = \"4 mm\", centre = [{at}] }}");
        free(name, "glass", &shape, &motion)
    };
    let one = ball("one", "\"-5 mm\", 0, 0", "1 m/s");
    let two = ball("two", "\"5 mm\", \"3 mm\", \"1 mm\"", "-1 m/s");
    for (courant, within) in [(0.65, 2e-3), (0.2, 2e-4)] {
        let text = format!("{one}{two}[time_step]\ncourant = {courant}");
        let mut s = case((3, 1.0), 4.0, false, &text);
        let spin = state(&s).spin();
        run_to(&mut s, 4e-3);
        let [a, b] = [&s.state.rigid[0], &s.state.rigid[1]];
        assert!(a.velocity[0] < 0.0 && b.velocity[0] > 0.0);
        assert!(norm(&minus(&a.spin(), &spin)) > 10.0);
        assert_momenta(&s);
        assert!(s.state.worst.energy_error < within);
    }
}

/// A block that deforms takes what a ball that does not loses.
#[test]
fn a_block_takes_what_a_ball_loses() {
    let ball = free(
        "ball",
        "cubic",
        "sphere = { radius = \"3 mm\", centre = [\"1 mm\", 0, \"4 mm\"] }",
        "velocity = [\"1 m/s\", 0, \"-4 m/s\"]",
    );
    let block = "[[body]]\nname = \"block\"\nmaterial = \"soft\"\n\
                 shape.box = { lower = [\"-7 mm\", \"-7 mm\", \"-6 mm\"], upper = [\"7 mm\", \"7 mm\", 0] }\n";
    let mut s = case((3, 1.0), 4.0, false, &format!("{block}{ball}"));
    run_to(&mut s, 3e-3);
    let body = state(&s);
    assert!(body.velocity[2] > -2.0 && norm(&body.spin()) > 1.0);
    assert_momenta(&s);
    assert!(s.state.worst.energy_error < 5e-3);
}

/// A rod swings about its end from the horizontal.
#[test]
fn a_pendulum_swings_as_it_should() {
    let rod = free(
        "rod",
        "cubic",
        "box = { lower = [0, \"-1 mm\"], upper = [\"40 mm\", \"1 mm\"] }",
        "pivot = [0, 0]",
    );
    let mut s = case((2, 1.0), 0.004, true, &rod);
    run_to(&mut s, 0.5);
    let body = state(&s);
    let rate = -10.0 * body.mass * body.lever[0] / body.inertia[2];
    let [angle, spin] = solve([0.0; 2], (s.state.time, 20_000), |[angle, spin]| {
        [*spin, rate * libm::cos(*angle)]
    });
    let [w, .., z] = body.attitude;
    let error = [2.0 * libm::atan2(z, w) - angle, body.spin()[2] / spin - 1.0];
    println!("{angle} {error:?}");
    assert!(error.iter().all(|error| error.abs() < 1e-5), "{error:?}");
    assert!(body.place == [0.0; 3] && body.velocity == [0.0; 3]);
    assert!(s.state.worst.energy_error < 1e-4);
    assert_momenta(&s);
    // The pivot bears what gravity gives, but for the momentum that the rod has.
    let [x, y, _] = s.state.totals.momentum;
    let [held_x, held_y, _] = s.state.load_impulse();
    let fallen = -10.0 * body.mass * s.state.time;
    let scale = fallen.abs();
    assert!((held_x - x).abs() < 1e-12 * scale && (held_y + fallen - y).abs() < 1e-12 * scale);
}

/// Half of a ball behind a symmetry plane moves as the whole ball does.
#[test]
fn half_a_ball_moves_as_the_whole_does() {
    let ball = free(
        "ball",
        "cubic",
        "sphere.radius = \"5 mm\"",
        "velocity = [\"1 m/s\", 0, \"-1 m/s\"]\nangular_velocity = [0, \"30 rad/s\", 0]",
    );
    let plane = "[[plane]]\nnormal = \"+z\"\npoint = [0, 0, \"-6 mm\"]\nfriction = 0.3\n";
    let ends = ["", "[[symmetry]]\naxis = \"y\"\n"].map(|half| {
        let mut s = case((3, 1.0), 4.0, true, &format!("{ball}{plane}{half}"));
        run_to(&mut s, 4e-3);
        assert_momenta(&s);
        *state(&s)
    });
    let [whole, half] = ends;
    assert!((half.mass / whole.mass - 0.5).abs() < 1e-14);
    assert!(norm(&minus(&half.velocity, &whole.velocity)) < 1e-12);
    assert!(norm(&minus(&half.spin(), &whole.spin())) < 1e-9);
}

/// Half of a hammer that a symmetry plane cuts swings as the whole one does.
#[test]
fn half_a_hammer_swings_as_the_whole_does() {
    let hammer = free(
        "hammer",
        "cubic",
        "box = { lower = [0, \"-2 mm\", \"-1 mm\"], upper = [\"8 mm\", \"2 mm\", \"1 mm\"] }",
        "pivot = [0, 0, 0]\nangular_velocity = [0, \"3 rad/s\", 0]",
    );
    let ends = ["", "[[symmetry]]\naxis = \"y\"\n"].map(|half| {
        let mut s = case((3, 1.0), 0.04, true, &format!("{hammer}{half}"));
        run_to(&mut s, 0.05);
        assert_momenta(&s);
        *state(&s)
    });
    let [whole, half] = ends.map(|end| end.spin());
    assert!(norm(&minus(&half, &whole)) < 1e-12, "{half:?} {whole:?}");
    assert!(half[1] > 10.0);
}

/// A weight that a guide keeps upright falls on the edge of a block: the guide bears the rest, and no work is done on it.
#[test]
fn a_guided_weight_falls_straight() {
    let weight = free(
        "weight",
        "cubic",
        "box = { lower = [\"3 mm\", \"-2 mm\", 0], upper = [\"9 mm\", \"3 mm\", \"4 mm\"] }",
        "velocity = [0, 0, \"-2 m/s\"]\nmoves = [\"z\"]\nturns = []",
    );
    let block = "[[body]]\nname = \"block\"\nmaterial = \"soft\"\nshape.box = \
                 { lower = [\"-6 mm\", \"-6 mm\", \"-6 mm\"], upper = [\"6 mm\", \"6 mm\", 0] }\n";
    let mut s = case((3, 1.0), 4.0, true, &format!("{block}{weight}"));
    run_to(&mut s, 3e-3);
    assert_momenta(&s);
    let body = state(&s);
    assert!(body.velocity[2] > -1.5 && body.velocity[..2] == [0.0; 2]);
    assert_eq!(
        (body.spin(), body.place[..2].to_vec()),
        ([0.0; 3], body.origin[..2].to_vec())
    );
    let guide = &s.state.loads[0];
    assert!(
        guide.impulse[0].abs() > 1e-9 && guide.work == 0.0,
        "{guide:?}"
    );
    assert!(s.state.worst.energy_error < 1e-2);
}

/// A brick that turns about one axis alone keeps its rate.
#[test]
fn a_brick_on_an_axle_keeps_its_rate() {
    let brick = free(
        "brick",
        "cubic",
        "box = { lower = [0, 0, 0], upper = [\"3 mm\", \"4 mm\", \"6 mm\"] }",
        "turns = [\"x\"]\nvelocity = [0, 0, \"1 m/s\"]\nangular_velocity = [\"300 rad/s\", 0, 0]",
    );
    let mut s = case((3, 1.0), 4.0, false, &brick);
    run_to(&mut s, 5e-3);
    assert_momenta(&s);
    let spin = state(&s).spin();
    assert!(norm(&minus(&spin, &[300.0, 0.0, 0.0])) < 1e-9, "{spin:?}");
}
