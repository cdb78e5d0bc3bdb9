//! Whole steps of the engine: what nothing changes, and what holds to rounding or to the order of
//! the scheme.
#![allow(clippy::float_cmp, reason = "what is exact is held exactly")]
#![allow(
    clippy::needless_range_loop,
    reason = "components of vectors and tensors"
)]
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

use engine::step::measurements;
use std::collections::BTreeMap;

use crate::common::outcome::{advance, everything, start};
use crate::common::{SPACING, ball, body, case, make_elastic, planes};
use comm::Comm;
use engine::step::{Reason, Simulation};
use material::{AfterSpall, Spall};
use model::{Axis, Case, ContactMode, Overlap, Potential, Shape, SmoothingLength, SphForm, Vec3};

/// A body alone, however fast, is at rest in its own frame: no force, no stress, the same velocity
/// to the last bit.
#[test]
fn free_flight_changes_nothing() {
    let shape = Shape::Sphere {
        centre: Vec3::zeros(),
        radius: 5.0 * SPACING,
    };
    let velocity = Vec3::new(3000.0, -100.0 / 3.0, 7000.0);
    let mut case = case(3, vec![body("ball", shape, SPACING, velocity)], 1.0);
    case.sph.smoothing_length = SmoothingLength::Variable { min: 0.6, max: 2.0 };
    let mut simulation = start(case);
    let first = simulation.particles.clone();
    advance(&mut simulation, 50);
    let (particles, state) = (&simulation.particles, &simulation.state);
    let velocity = <[f64; 3]>::from(velocity);
    let here: BTreeMap<u64, usize> = (0..particles.owned())
        .map(|i| (particles.id[i], i))
        .collect();
    for (old, &id) in first.id.iter().enumerate() {
        let i = here[&id];
        assert_eq!(particles.velocity[i], velocity);
        assert_eq!(particles.density[i], 2785.0);
        assert_eq!(particles.specific_energy[i], 0.0);
        assert_eq!(particles.pressure[i], 0.0);
        assert!(particles.deviatoric_stress[i].iter().all(|&s| s == 0.0));
        for a in 0..3 {
            let moved = particles.position[i][a] - first.position[old][a];
            let far = velocity[a] * state.time;
            // Fifty additions to a coordinate no larger than the distance and the ball.
            assert!((moved - far).abs() < 50.0 * 1e-16 * (far.abs() + 1e-3));
        }
    }
    assert_eq!(state.worst.energy_error, 0.0);
    assert_eq!(state.worst.momentum_error, [0.0; 3]);
}

fn angular_momentum(simulation: &Simulation) -> Vec3 {
    let particles = &simulation.particles;
    (0..particles.owned())
        .map(|i| {
            let (x, v) = (particles.position[i], particles.velocity[i]);
            Vec3::from(x).cross(&Vec3::from(v)) * particles.mass[i]
        })
        .sum()
}

/// An elastic sphere of a radius in spacings, set spinning; its speed at the equator in m/s.
fn spinning(form: SphForm, radius: f64, speed: f64) -> (Simulation, f64) {
    let mut case = case(3, vec![ball("ball", 0.0, radius, 0.0)], 1.0);
    case.sph.form = form;
    make_elastic(&mut case);
    let mut simulation = start(case);
    let spin = speed / (radius * SPACING);
    let particles = &mut simulation.particles;
    for i in 0..particles.owned() {
        let x = particles.position[i];
        particles.velocity[i] = [-spin * x[1], spin * x[0], 0.0];
        particles.velocity_gradient[i] = [0.0, -spin, 0.0, spin, 0.0, 0.0, 0.0, 0.0, 0.0];
    }
    (simulation, spin)
}

/// A spinning elastic sphere keeps its momentum and energy to rounding, and inside feels no more
/// than the centrifugal stress of order ρ v².
///
/// So does its angular momentum in the corrected form. In the conventional form it drifts: the
/// uncorrected gradient of a rotation is no pure rotation near a free surface, and stresses are not
/// central forces. The drift must fall as the surface layer does with the spacing, 1/R or faster.
#[test]
fn an_elastic_sphere_spins() {
    let drift = drift_of_spin(SphForm::Corrected);
    assert!(drift.iter().all(|&drift| drift < 1e-13), "{drift:?}");
    let drift = drift_of_spin(SphForm::Conventional);
    assert!(drift[0] < 0.06 && drift[1] < 0.5 * drift[0], "{drift:?}");
}

/// Share of the angular momentum that spheres of two radii lose in half a radian.
fn drift_of_spin(form: SphForm) -> [f64; 2] {
    const SPEED: f64 = 600.0;
    let drift = [5.0, 10.0].map(|radius| {
        let (mut simulation, spin) = spinning(form, radius, SPEED);
        let before = angular_momentum(&simulation);
        let totals = |s: &mut Simulation| {
            measurements::diagnose(s, &Comm::solo());
            s.state.totals
        };
        let first = totals(&mut simulation);
        while simulation.state.time * spin < 0.5 {
            advance(&mut simulation, 1);
        }
        let (particles, last) = (&simulation.particles, simulation.state.totals);
        assert!((last.energy() - first.energy()).abs() < 1e-14 * first.energy());
        for a in 0..3 {
            let error = last.momentum[a] - first.momentum[a];
            assert!(error.abs() < 1e-15 * first.momentum_scale);
        }
        let centrifugal = 2785.0 * SPEED * SPEED;
        for i in 0..particles.owned() {
            let mut stress = particles.deviatoric_stress[i].to_vec();
            stress.push(particles.pressure[i]);
            let stress = stress.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
            let inside = Vec3::from(particles.position[i]).norm() < (radius - 3.0) * SPACING;
            let bound = if inside { 1.0 } else { 2.0 };
            assert!(
                stress < bound * centrifugal,
                "{stress:e} in {}",
                particles.id[i]
            );
        }
        (angular_momentum(&simulation) - before).norm() / before.norm()
    });
    println!("{form:?}: drift of angular momentum in half a radian: {drift:?}");
    drift
}

/// Two halves of one body collide: `kernel` contact makes them one continuum.
fn colliding_halves(dimension: usize, speed: f64) -> Case {
    let half = |name, lower: f64, speed| {
        let shape = Shape::Box {
            lower: Vec3::new(-4.0, -4.0, lower) * SPACING,
            upper: Vec3::new(4.0, 4.0, lower + 6.0) * SPACING,
        };
        let mut body = body(name, shape, SPACING, Vec3::new(0.0, 0.0, speed));
        if dimension < 3 {
            // The same along x.
            let shape = Shape::Box {
                lower: Vec3::new(lower, -4.0, 0.0) * SPACING,
                upper: Vec3::new(lower + 6.0, 4.0, 0.0) * SPACING,
            };
            body.shape = shape;
            body.velocity = Vec3::new(speed, 0.0, 0.0);
        }
        body
    };
    let bodies = vec![half("lower", -6.0, speed), half("upper", 0.0, -0.7 * speed)];
    let mut case = case(dimension, bodies, 1.0);
    case.default_contact = ContactMode::Kernel;
    case
}

/// Kinetic plus internal energy of a body is constant to rounding, however violent its motion and
/// large its time step, plasticity, shocks, spall and variable h included; momentum too.
#[test]
fn energy_of_a_body_is_constant_to_rounding() {
    for dimension in 1..=3 {
        for smoothing in [
            SmoothingLength::Constant,
            SmoothingLength::Variable { min: 0.6, max: 2.0 },
        ] {
            for symmetry in [&[][..], &[Axis::Y]] {
                if dimension == 1 && !symmetry.is_empty() {
                    continue;
                }
                let mut case = colliding_halves(dimension, 2000.0);
                case.sph.smoothing_length = smoothing;
                case.symmetry = planes(symmetry);
                case.materials[0].failure.spall = Some(Spall {
                    pressure: -1e8,
                    after: AfterSpall::Failed,
                });
                let mut simulation = start(case);
                advance(&mut simulation, 150);
                let state = &simulation.state;
                assert!(state.totals.failed_mass > 0.1 * state.totals.mass);
                let heat = state.totals.internal_energy / state.initial.kinetic_energy;
                assert!(heat > 0.1, "hardly a collision: {heat}");
                // Kicks of a few ulp each, 150 of them, in all particles.
                assert!(
                    state.worst.energy_error < 1e-14,
                    "{:e}",
                    state.worst.energy_error
                );
                let momentum = state.worst.momentum_error;
                assert!(momentum.iter().all(|&e| e < 2e-15), "{momentum:?}");
            }
        }
    }
}

/// Hot spray that flies alone does not keep others waiting; where it has a neighbour, it does.
#[test]
fn spray_that_flies_alone_sets_no_step() {
    let speck = |name: &str, x: f64| {
        let shape = Shape::Box {
            lower: Vec3::new(x, 0.0, 0.0),
            upper: Vec3::new(x + SPACING, SPACING, SPACING),
        };
        body(name, shape, SPACING, Vec3::zeros())
    };
    let step_with = |count: usize, heat: f64| {
        let mut bodies = vec![ball("ball", 0.0, 4.0, 0.0)];
        let at = [30.0, 31.5];
        bodies.extend((0..count).map(|k| speck(&format!("speck {k}"), at[k] * SPACING)));
        let mut case = case(3, bodies, 1e-6);
        case.default_contact = ContactMode::Kernel;
        case.materials[0].failure.spall = Some(Spall {
            pressure: -1e9,
            after: AfterSpall::Failed,
        });
        let mut simulation = start(case);
        let particles = &mut simulation.particles;
        for i in 0..particles.owned() {
            if particles.body[i] > 0 {
                particles.damage[i] = 1.0;
                particles.specific_energy[i] = heat;
            }
        }
        advance(&mut simulation, 3);
        simulation.state.dt
    };
    let cold = step_with(1, 0.0);
    assert_eq!(step_with(1, 4e7), cold);
    assert!(step_with(2, 4e7) < 0.5 * cold);
}

/// Two balls meet at `speed` (m/s) each, in steps of at most `dt` (s), for .1 µs: what contact
/// has lost or made, relative to the initial kinetic energy.
fn contact_defect(contact: &ContactMode, speed: f64, dt: f64) -> f64 {
    let bodies = vec![
        ball("lower", -4.0, 4.0, speed),
        ball("upper", 4.0, 4.0, -speed),
    ];
    let mut case = case(3, bodies, 1e-7);
    case.default_contact = contact.clone();
    case.time_step.max = dt;
    let mut simulation = start(case);
    while !simulation.is_finished() {
        advance(&mut simulation, 1);
        let reason = simulation.state.last_reason;
        assert!(
            matches!(reason, Reason::Maximum | Reason::End),
            "{reason:?}"
        );
    }
    let worst = &simulation.state.worst;
    // All that the energy balance lacks, contact lacks.
    assert!((worst.energy_error - worst.contact_defect).abs() < 1e-14 + 1e-11 * worst.energy_error);
    worst.contact_defect
}

/// The energy of contact is conserved to the order of the scheme: the defect falls with the square
/// of the time step. Overlap sets in with a kink of its force, so it is measured over two halvings.
#[test]
fn contact_energy_is_conserved_to_second_order() {
    let overlap = ContactMode::Overlap(Overlap::default());
    let potential = ContactMode::Potential(Potential::default());
    let defects = [8e-10, 4e-10, 2e-10].map(|dt| contact_defect(&potential, 800.0, dt));
    for pair in defects.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((3.8..4.2).contains(&ratio), "{defects:?}");
    }
    let defects = [8e-10, 2e-10].map(|dt| contact_defect(&overlap, 800.0, dt));
    println!("overlap: {defects:?}");
    assert!(
        defects[0] < 1e-4 && defects[1] < defects[0] / 10.0,
        "{defects:?}"
    );
}

/// The ledger of a pair of bodies is what changes the momentum of each.
#[test]
fn the_impulse_of_a_pair_is_the_change_of_momentum() {
    let bodies = vec![
        ball("lower", -4.0, 4.0, 800.0),
        ball("upper", 4.0, 4.0, -300.0),
    ];
    let mut simulation = start(case(3, bodies, 1.0));
    let momentum = |simulation: &Simulation, body: u32| -> Vec3 {
        let particles = &simulation.particles;
        (0..particles.owned())
            .filter(|&i| particles.body[i] == body)
            .map(|i| Vec3::from(particles.velocity[i]) * particles.mass[i])
            .sum()
    };
    let before = [0, 1].map(|body| momentum(&simulation, body));
    for _ in 0..5 {
        advance(&mut simulation, 20);
        let impulse = Vec3::from(simulation.state.pairs[0].impulse);
        let gained = [
            momentum(&simulation, 0) - before[0],
            momentum(&simulation, 1) - before[1],
        ];
        for (gained, impulse) in gained.into_iter().zip([impulse, -impulse]) {
            assert!((gained - impulse).norm() < 1e-14 * before[0].norm());
        }
    }
    assert!(simulation.state.pairs[0].impulse[2] < -0.1 * before[0].norm());
}

/// A particle that is no number any more ends the run at once, by name.
#[test]
fn a_particle_that_is_no_number_is_reported() {
    for what in 0..3 {
        let mut simulation = start(everything());
        let particles = &mut simulation.particles;
        let slot = particles.owned() / 3;
        match what {
            0 => particles.velocity[slot][1] = f64::NAN,
            1 => particles.density[slot] = f64::NAN,
            _ => particles.position[slot][2] = 1e13,
        }
        let id = particles.id[slot];
        let error = simulation.advance(&Comm::solo()).unwrap_err().to_string();
        assert!(error.contains("step 1: particle "), "{error}");
        // Neighbours catch a NaN in the same step, and the smallest id speaks for all.
        if what == 2 {
            assert!(error.contains(&format!("particle {id} ")), "{error}");
        }
    }
}
