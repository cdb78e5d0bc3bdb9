//! Rigid bodies that forces move: free rotation, bounces, rolling, eccentric impacts, a pendulum.

use crate::physics_support::{inline, run_to, run_with, start};
use engine::step::{RigidState, Simulation};
use numerics::attitude::rotation;
use numerics::vector::{dot, minus, norm};

/// A soft material, whose sound and steps are slow, and what else a case has.
fn case(dimension: usize, rest: &str) -> String {
    format!(
        r#"
dimension = {dimension}
spacing = "1 mm"
run.end_time = "100 s"
material.soft = {{ density = "1 g/cm^3", eos.linear.bulk_modulus = "4 MPa", strength.elastic.shear_modulus = "2 MPa" }}
{rest}
"#
    )
}

/// A free rigid body.
fn free(name: &str, shape: &str, more: &str) -> String {
    format!(
        "[[body]]\nname = \"{name}\"\nrigid = true\nfree = true\nmaterial = \"soft\"\n\
         lattice = \"cubic\"\nshape.{shape}\n{more}\n"
    )
}

/// A box of this many spacings about the origin.
fn brick(sides: [f64; 3]) -> String {
    let corner = |sign: f64| sides.map(|side| format!("\"{} mm\"", 0.5 * sign * side));
    format!(
        "box = {{ lower = [{}], upper = [{}] }}",
        corner(-1.0).join(", "),
        corner(1.0).join(", ")
    )
}

fn state(s: &Simulation) -> &RigidState {
    &s.state.rigid[0]
}

/// Kinetic energy of rotation (J).
fn rotation_energy(body: &RigidState) -> f64 {
    0.5 * dot(&body.spin(), &body.angular_momentum)
}

/// Errors of energy and momentum over a run.
fn errors(s: &Simulation) -> (f64, f64, f64, f64) {
    let worst = &s.state.worst;
    let most = |errors: &[f64; 3]| errors.iter().fold(0.0, |a: f64, &b| a.max(b));
    (
        worst.energy_error,
        worst.contact_defect,
        most(&worst.momentum_error),
        most(&worst.angular_momentum_error),
    )
}

/// Angular velocity in the frame of the body by Euler's equations (Runge–Kutta of fourth order).
fn euler(moments: [f64; 3], first: [f64; 3], time: f64, steps: u32) -> [f64; 3] {
    let rate = |w: [f64; 3]| {
        let [a, b, c] = moments;
        [
            (b - c) / a * w[1] * w[2],
            (c - a) / b * w[2] * w[0],
            (a - b) / c * w[0] * w[1],
        ]
    };
    let dt = time / f64::from(steps);
    let go = |w: [f64; 3], k: [f64; 3], dt: f64| std::array::from_fn(|a| w[a] + dt * k[a]);
    (0..steps).fold(first, |w, _| {
        let k1 = rate(w);
        let k2 = rate(go(w, k1, 0.5 * dt));
        let k3 = rate(go(w, k2, 0.5 * dt));
        let k4 = rate(go(w, k3, dt));
        std::array::from_fn(|a| w[a] + dt / 6.0 * (k1[a] + 2.0 * (k2[a] + k3[a]) + k4[a]))
    })
}

/// A brick that spins about each of its axes and, about the middle one, tumbles.
#[test]
fn a_free_brick_turns_as_euler_says() {
    let spins = [
        [300.0, 0.0, 0.0],
        [0.0, 300.0, 0.0],
        [0.0, 0.0, 300.0],
        [1.0, 300.0, 2.0],
        [200.0, -150.0, 90.0],
    ];
    for spin in spins {
        let shape = brick([4.0, 6.0, 9.0]);
        let [x, y, z] = spin;
        let turn = format!(
            "velocity = [\"3 m/s\", 0, 0]\nangular_velocity = [\"{x} rad/s\", \"{y} rad/s\", \"{z} rad/s\"]"
        );
        let mut s = start(inline(&case(3, &free("brick", &shape, &turn))));
        let begin = *state(&s);
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        run_with(&mut s, 0.2, |s| {
            let energy = rotation_energy(state(s)) / rotation_energy(&begin);
            (least, most) = (least.min(energy), most.max(energy));
        });
        let end = *state(&s);
        assert_eq!(begin.angular_momentum, end.angular_momentum);
        let back = rotation(&end.attitude);
        let own: [f64; 3] = std::array::from_fn(|a| {
            let now = end.spin();
            (0..3).map(|b| back[b][a] * now[b]).sum()
        });
        let [xx, yy, zz, ..] = begin.inertia;
        let exact = euler([xx, yy, zz], spin, s.state.time, 40_000);
        let off = norm(&minus(&own, &exact)) / norm(&spin);
        println!(
            "{spin:?}: steps {}, spin off {off:e}, energy {:e} to {:e}, errors {:?}",
            s.state.step,
            least - 1.0,
            most - 1.0,
            errors(&s)
        );
        assert!(off < 1e-6, "{off:e}");
        assert!(errors(&s).0 < 1e-6);
    }
}

/// A ball thrown at a plane, and at a rigid block.
#[test]
fn a_ball_bounces_with_its_speed() {
    for (ground, place) in [
        ("[[plane]]\nnormal = \"+z\"\npoint = [0, 0, \"-8 mm\"]", ""),
        (
            "[[body]]\nname = \"floor\"\nrigid = true\n\
             shape.box = { lower = [\"-9 mm\", \"-9 mm\", \"-12 mm\"], upper = [\"9 mm\", \"9 mm\", \"-8 mm\"] }",
            "",
        ),
    ] {
        for courant in [0.65, 0.2, 0.05, 0.0125] {
            let ball = free(
                "ball",
                "sphere = { radius = \"5 mm\" }",
                "velocity = [0, 0, \"-1 m/s\"]",
            );
            let text = format!("time_step.courant = {courant}\n{ground}\n{ball}{place}");
            let mut s = start(inline(&case(3, &text)));
            run_to(&mut s, 8e-3);
            println!(
                "courant {courant}: steps {}, speed {:e}, spin {:e}, errors {:?}",
                s.state.step,
                state(&s).velocity[2] - 1.0,
                norm(&state(&s).spin()),
                errors(&s)
            );
        }
    }
}

/// A disc and a ball that slide on a plane with friction until they roll.
#[test]
fn what_slides_ends_rolling() {
    for (dimension, shape, gravity, velocity, share) in [
        (
            2,
            "sphere = { radius = \"20 mm\" }",
            "[0, \"-10 m/s^2\"]",
            "[\"0.5 m/s\", 0]",
            2.0 / 3.0,
        ),
        (
            3,
            "sphere = { radius = \"10 mm\" }",
            "[0, 0, \"-10 m/s^2\"]",
            "[\"0.5 m/s\", 0, 0]",
            5.0 / 7.0,
        ),
    ] {
        let up = if dimension == 2 { "+y" } else { "+z" };
        let point = if dimension == 2 {
            "[0, \"-20 mm\"]"
        } else {
            "[0, 0, \"-10 mm\"]"
        };
        let body = free("wheel", shape, &format!("velocity = {velocity}"));
        let lattice = if dimension == 2 { "rings" } else { "shells" };
        let body = body.replace("lattice = \"cubic\"", &format!("lattice = \"{lattice}\""));
        let text = format!(
            "gravity = {gravity}\n[[plane]]\nnormal = \"{up}\"\npoint = {point}\nfriction = 0.3\ndamping = 0.2\n{body}"
        );
        let mut s = start(inline(&case(dimension, &text)));
        let mut speeds = Vec::new();
        run_with(&mut s, 0.16, |s| {
            if s.state.time > 0.1 {
                speeds.push((state(s).velocity[0], state(s).spin()));
            }
        });
        let mean = speeds.iter().map(|(v, _)| v).sum::<f64>() / speeds.len() as f64;
        let least = speeds.iter().fold(1.0, |a: f64, (v, _)| a.min(*v));
        let most = speeds.iter().fold(0.0, |a: f64, (v, _)| a.max(*v));
        println!(
            "{dimension}: steps {}, speed over exact {} ({} to {}), spin {:?} {:?}, errors {:?}",
            s.state.step,
            mean / (0.5 * share),
            least / (0.5 * share),
            most / (0.5 * share),
            speeds.last(),
            state(&s),
            errors(&s)
        );
    }
}

/// Two free balls that meet off their centres.
#[test]
fn balls_that_meet_off_centre_keep_all_momenta() {
    let ball = |name, at: &str, speed: &str| {
        let more = format!(
            "velocity = [\"{speed}\", 0, 0]\nangular_velocity = [\"20 rad/s\", 0, \"50 rad/s\"]"
        );
        free(
            name,
            &format!("sphere = {{ radius = \"4 mm\", centre = [{at}] }}"),
            &more,
        )
    };
    for contact in ["", "[contact]\nfriction = 0.3"] {
        let text = [
            contact.to_owned(),
            ball("one", "\"-6 mm\", 0, 0", "1 m/s"),
            ball("two", "\"6 mm\", \"3 mm\", \"1 mm\"", "-1 m/s"),
        ];
        let mut s = start(inline(&case(3, &text.join("\n"))));
        run_to(&mut s, 10e-3);
        println!(
            "steps {}, {:?}, errors {:?}",
            s.state.step,
            s.state
                .rigid
                .iter()
                .map(|b| (b.velocity, b.spin()))
                .collect::<Vec<_>>(),
            errors(&s)
        );
    }
}

/// A block that deforms, hit by a ball that does not.
#[test]
fn a_block_takes_what_the_ball_loses() {
    let ball = free(
        "ball",
        "sphere = { radius = \"3 mm\", centre = [\"1 mm\", 0, \"4 mm\"] }",
        "velocity = [\"1 m/s\", 0, \"-4 m/s\"]",
    );
    let block = "[[body]]\nname = \"block\"\nmaterial = \"soft\"\nshape.box = { lower = [\"-7 mm\", \"-7 mm\", \"-6 mm\"], upper = [\"7 mm\", \"7 mm\", 0] }\n";
    let mut s = start(inline(&case(3, &format!("{block}{ball}"))));
    run_to(&mut s, 4e-3);
    println!(
        "steps {}, {:?}, errors {:?}",
        s.state.step,
        state(&s),
        errors(&s)
    );
}

/// A rod that swings about its end.
#[test]
fn a_pendulum_swings() {
    let rod = free(
        "rod",
        "box = { lower = [0, \"-1 mm\"], upper = [\"40 mm\", \"1 mm\"] }",
        "pivot = [0, 0]",
    );
    let text = format!("gravity = [0, \"-10 m/s^2\"]\n{rod}");
    let mut s = start(inline(&case(2, &text)));
    let first = state(&s).lever;
    run_with(&mut s, 0.5, |_| {});
    println!(
        "steps {}, {first:?} {:?}, errors {:?}",
        s.state.step,
        state(&s),
        errors(&s)
    );
}

/// Half of a ball in front of a symmetry plane, on a plane.
#[test]
fn half_a_ball_moves_as_the_whole_does() {
    let mut ends = Vec::new();
    for planes in ["", "[[symmetry]]\naxis = \"y\"\n"] {
        let ball = free(
            "ball",
            "sphere = { radius = \"5 mm\" }",
            "velocity = [\"1 m/s\", 0, \"-1 m/s\"]\nangular_velocity = [0, \"30 rad/s\", 0]",
        );
        let text = format!(
            "gravity = [0, 0, \"-10 m/s^2\"]\n{planes}[[plane]]\nnormal = \"+z\"\npoint = [0, 0, \"-6 mm\"]\nfriction = 0.3\n{ball}"
        );
        let mut s = start(inline(&case(3, &text)));
        run_to(&mut s, 8e-3);
        println!(
            "{:?} {:?} errors {:?}",
            state(&s),
            s.state.loads,
            errors(&s)
        );
        ends.push(*state(&s));
    }
    println!("{:?}", ends[0].spin());
    println!("{:?}", ends[1].spin());
}
