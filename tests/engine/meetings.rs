//! Bodies that meet: none flies through another unseen, however it came by its speed, and what is
//! kept of pairs of bodies is of those that have met.

use crate::common::outcome::start;
use crate::common::{SPACING, ball, case, make_elastic};
use comm::Comm;
use engine::step::measurements;
use engine::step::{Reason, Simulation};
use material::{Elastic, Eos, Linear, LinearForm, Strength};
use model::{Case, Motion, Region, Resistance, RigidSurface, Spin, SurfaceShape, VelocityLoad};

/// Speed of all that flies here (m/s), some two hundred spacings in a step by sound.
const SPEED: f64 = 4000.0;

/// Balls of a solid so soft that sound is at 6.5 m/s.
fn soft(bodies: Vec<model::Body>) -> Case {
    let mut case = case(3, bodies, 1.0);
    make_elastic(&mut case);
    case.materials[0].eos = Eos::Linear(Linear {
        bulk_modulus: 79e3,
        form: LinearForm::Logarithmic,
    });
    case.materials[0].strength = Strength::Elastic(Elastic {
        shear_modulus: 28.6e3,
    });
    case
}

/// True if anything is felt of `met` before so many steps are over or a time (s) has come.
fn meets(mut simulation: Simulation, until: f64, met: fn(&Simulation) -> bool) -> bool {
    for _ in 0..2000 {
        if met(&simulation) || simulation.state.time > until {
            break;
        }
        if simulation.advance(&Comm::solo()).is_err() {
            // What is hit so hard is out of range at once.
            break;
        }
    }
    met(&simulation)
}

fn bodies_are_near(simulation: &Simulation) -> bool {
    simulation.state.worst.closest.is_some()
}

fn surface_pushes(simulation: &Simulation) -> bool {
    simulation.state.loads[0].force != [0.0; 3]
}

fn table(speed: f64) -> Motion {
    Motion {
        times: vec![0.0, 1e-6],
        velocities: [None, None, Some(vec![0.0, speed])],
    }
}

/// A rigid punch that begins at rest, of which only its table knows the speed.
#[test]
fn a_fast_punch_is_seen() {
    for k in 0..6 {
        let z = 100.0 + 31.0 * f64::from(k);
        let mut case = soft(vec![
            ball("target", 0.0, 1.6, 0.0),
            ball("punch", z, 1.6, 0.0),
        ]);
        let mut motion = table(-SPEED);
        motion.velocities[0] = Some(vec![0.0; 2]);
        motion.velocities[1] = Some(vec![0.0; 2]);
        case.bodies[1].rigid = Some(motion);
        assert!(
            meets(start(case), 2e-4, bodies_are_near),
            "from {z} spacings"
        );
    }
}

/// A body that a load accelerates and then sets free.
#[test]
fn a_body_accelerated_by_a_load_is_seen() {
    for k in 0..6 {
        let z = 1000.0 + 31.0 * f64::from(k);
        let mut case = soft(vec![
            ball("target", 0.0, 1.6, 0.0),
            ball("thrown", z, 1.6, 0.0),
        ]);
        case.loads.velocities.push(VelocityLoad {
            name: "throw".into(),
            body: 1,
            region: Region::OPEN,
            motion: table(-SPEED),
            until: 4e-6,
            starts: false,
        });
        assert!(
            meets(start(case), 2e-4, bodies_are_near),
            "from {z} spacings"
        );
    }
}

fn surface(shape: SurfaceShape) -> RigidSurface {
    RigidSurface {
        name: "tool".into(),
        shape,
        inside: false,
        stiffness: 2.0,
        resistance: Resistance::default(),
        bodies: vec![true],
        motion: Motion::default(),
        spin: None,
    }
}

/// A rigid sphere that is shot at a body, and a bar that turns into one.
#[test]
fn fast_surfaces_are_seen() {
    for k in 0..6 {
        let z = 100.0 + 31.0 * f64::from(k);
        let mut case = soft(vec![ball("target", 0.0, 1.6, 0.0)]);
        let mut sphere = surface(SurfaceShape::Sphere {
            centre: [0.0, 0.0, z * SPACING],
            radius: 2.0 * SPACING,
        });
        sphere.motion = table(-SPEED);
        case.loads.surfaces.push(sphere);
        assert!(
            meets(start(case), 2e-4, surface_pushes),
            "from {z} spacings"
        );
    }
    for k in 0..6 {
        let angle = 1.0 + 0.1 * f64::from(k);
        let mut case = soft(vec![ball("target", 80.0, 1.6, 0.0)]);
        let mut bar = surface(SurfaceShape::Cylinder {
            centre: [0.0; 3],
            axis: [angle.sin(), 0.0, angle.cos()],
            radius: 2.0 * SPACING,
            half_length: 100.0 * SPACING,
        });
        bar.spin = Some(Spin {
            point: [0.0; 3],
            axis: [0.0, 1.0, 0.0],
            rate: Motion {
                times: vec![0.0],
                velocities: [Some(vec![-SPEED / (80.0 * SPACING)]), None, None],
            },
        });
        case.loads.surfaces.push(bar);
        assert!(meets(start(case), 2e-5, surface_pushes), "from {angle} rad");
    }
}

/// Two bodies in touch, one of which has lost a particle that is at `z` spacings and flies with
/// `speed` (m/s) along z: whether flight limits one of the next steps.
fn is_limited(z: f64, speed: f64) -> bool {
    let bodies = vec![ball("target", 0.0, 3.0, 0.0), ball("other", 6.0, 3.0, 0.0)];
    let mut s = start(soft(bodies));
    let of_target = s.particles.body.iter().position(|&body| body == 0);
    let i = of_target.expect("a particle");
    s.particles.position[i] = [0.0, 0.0, z * SPACING];
    s.particles.velocity[i] = [0.0, 0.0, speed];
    (0..8).any(|_| {
        s.advance(&Comm::solo()).expect("a step");
        s.state.dt_reason == Reason::Flight
    })
}

/// A fast particle limits the step where it flies towards the other body, and not where it flies
/// away from it, though the box of its body then holds the other one.
#[test]
fn ejecta_limit_the_step_only_where_they_can_meet() {
    assert!(is_limited(-1000.0, SPEED));
    assert!(is_limited(1000.0, -SPEED));
    assert!(!is_limited(-50.0, -SPEED));
    assert!(!is_limited(50.0, SPEED));
}

/// A hundred balls in a row, each in touch with the next ones alone: the exact sums of 99 pairs,
/// and not of 4950, which took 14 MB for each thread.
#[test]
fn sums_are_of_pairs_that_have_met() {
    let balls = (0..100_u32).map(|k| ball(&format!("ball {k}"), 2.0 * f64::from(k), 1.0, 0.0));
    let mut simulation = start(case(3, balls.collect(), 1.0));
    for _ in 0..3 {
        simulation.advance(&Comm::solo()).expect("a step");
    }
    measurements::join_extremes(&mut simulation, &Comm::solo());
    let met = simulation
        .state
        .pairs
        .iter()
        .filter(|p| p.extremes.closest.is_some());
    assert!((99..200).contains(&met.count()));
    assert!(simulation.state.pairs.len() < 200);
    assert!(simulation.memory() < 8_000_000, "{}", simulation.memory());
}
