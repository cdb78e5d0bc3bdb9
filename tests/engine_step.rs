//! Whole steps of the engine: what must not change at all, and what must hold to rounding.
#![allow(clippy::float_cmp, reason = "what is exact is held exactly")]
#![allow(
    clippy::needless_range_loop,
    reason = "components of vectors and tensors"
)]
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

mod common;

use std::collections::BTreeMap;
use std::process::Command;

use common::outcome::{Outcome, assert_same, everything};
use common::random::Random;
use common::{body, case};
use whipple::comm::Comm;
use whipple::material::{Elastic, Eos, Linear, LinearForm, Strength};
use whipple::model::{
    Axis, Body, Case, ContactMode, Overlap, Potential, Shape, SmoothingLength, SymmetryPlane, Vec3,
};
use whipple::sph::dispatch::available;
use whipple::step::{Reason, Simulation};

const SPACING: f64 = 1e-4;

fn start(case: Case) -> Simulation {
    Simulation::start(case, &Comm::solo()).unwrap()
}

fn advance(simulation: &mut Simulation, steps: usize) {
    for _ in 0..steps {
        simulation.advance(&Comm::solo()).unwrap();
        simulation.diagnose(&Comm::solo());
    }
}

fn ball(name: &str, z: f64, radius: f64, speed: f64) -> Body {
    let shape = Shape::Sphere {
        centre: Vec3::new(0.0, 0.0, z) * SPACING,
        radius: radius * SPACING,
    };
    body(name, shape, SPACING, Vec3::new(0.0, 0.0, speed))
}

fn planes(axes: &[Axis]) -> Vec<SymmetryPlane> {
    let plane = |&axis| SymmetryPlane {
        axis,
        position: 0.0,
    };
    axes.iter().map(plane).collect()
}

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
    let first = simulation.store.clone();
    advance(&mut simulation, 50);
    let (store, state) = (&simulation.store, &simulation.state);
    let velocity = <[f64; 3]>::from(velocity);
    let here: BTreeMap<u64, usize> = (0..store.owned()).map(|i| (store.id[i], i)).collect();
    for (old, &id) in first.id.iter().enumerate() {
        let i = here[&id];
        assert_eq!(store.velocity[i], velocity);
        assert_eq!(store.density[i], 2785.0);
        assert_eq!(store.specific_energy[i], 0.0);
        assert_eq!(store.pressure[i], 0.0);
        assert!(store.deviatoric_stress[i].iter().all(|&s| s == 0.0));
        for a in 0..3 {
            let moved = store.position[i][a] - first.position[old][a];
            let far = velocity[a] * state.time;
            // Fifty additions to a coordinate no larger than the distance and the ball.
            assert!((moved - far).abs() < 50.0 * 1e-16 * (far.abs() + 1e-3));
        }
    }
    assert_eq!(state.worst.energy_error, 0.0);
    assert_eq!(state.worst.momentum_error, [0.0; 3]);
}

/// Linear elastic aluminium.
fn make_elastic(case: &mut Case) {
    case.materials[0].eos = Eos::Linear(Linear {
        bulk_modulus: 79e9,
        form: LinearForm::Logarithmic,
    });
    case.materials[0].strength = Strength::Elastic(Elastic {
        shear_modulus: 28.6e9,
    });
    case.materials[0].spall = None;
}

fn angular_momentum(simulation: &Simulation) -> Vec3 {
    let store = &simulation.store;
    (0..store.owned())
        .map(|i| {
            let (x, v) = (store.position[i], store.velocity[i]);
            Vec3::from(x).cross(&Vec3::from(v)) * store.mass[i]
        })
        .sum()
}

/// An elastic sphere of a radius in spacings, set spinning; its speed at the equator in m/s.
fn spinning(radius: f64, speed: f64) -> (Simulation, f64) {
    let mut case = case(3, vec![ball("ball", 0.0, radius, 0.0)], 1.0);
    make_elastic(&mut case);
    let mut simulation = start(case);
    let spin = speed / (radius * SPACING);
    let store = &mut simulation.store;
    for i in 0..store.owned() {
        let x = store.position[i];
        store.velocity[i] = [-spin * x[1], spin * x[0], 0.0];
        store.velocity_gradient[i] = [0.0, -spin, 0.0, spin, 0.0, 0.0, 0.0, 0.0, 0.0];
    }
    (simulation, spin)
}

/// A spinning elastic sphere keeps its momentum and energy to rounding, and inside feels no more
/// than the centrifugal stress of order ρ v².
///
/// Its angular momentum does drift: the uncorrected gradient of a rotation is no pure rotation
/// near a free surface, and stresses are not central forces. The drift must fall as the surface
/// layer does with the spacing, 1/R or faster.
#[test]
fn an_elastic_sphere_spins() {
    const SPEED: f64 = 600.0;
    let drift = [5.0, 10.0].map(|radius| {
        let (mut simulation, spin) = spinning(radius, SPEED);
        let before = angular_momentum(&simulation);
        let totals = |s: &mut Simulation| {
            s.diagnose(&Comm::solo());
            s.state.totals
        };
        let first = totals(&mut simulation);
        while simulation.state.time * spin < 0.5 {
            advance(&mut simulation, 1);
        }
        let (store, last) = (&simulation.store, simulation.state.totals);
        assert!((last.energy() - first.energy()).abs() < 1e-14 * first.energy());
        for a in 0..3 {
            let error = last.momentum[a] - first.momentum[a];
            assert!(error.abs() < 1e-15 * first.momentum_scale);
        }
        let centrifugal = 2785.0 * SPEED * SPEED;
        for i in 0..store.owned() {
            let mut stress = store.deviatoric_stress[i].to_vec();
            stress.push(store.pressure[i]);
            let stress = stress.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
            let inside = Vec3::from(store.position[i]).norm() < (radius - 3.0) * SPACING;
            let bound = if inside { 1.0 } else { 2.0 };
            assert!(
                stress < bound * centrifugal,
                "{stress:e} in {}",
                store.id[i]
            );
        }
        (angular_momentum(&simulation) - before).norm() / before.norm()
    });
    println!("drift of angular momentum in half a radian: {drift:?}");
    assert!(drift[0] < 0.06 && drift[1] < 0.5 * drift[0], "{drift:?}");
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
                let mut simulation = start(case);
                advance(&mut simulation, 150);
                let state = &simulation.state;
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

/// Largest differences of position (in spacings) and velocity (relative to `speed`) between the
/// particles of a reduced model and the same ones of the whole.
fn largest_difference(reduced: &Simulation, whole: &Simulation, speed: f64) -> (f64, f64) {
    let whole_slot: BTreeMap<u64, usize> = (0..whole.store.owned())
        .map(|i| (whole.store.id[i], i))
        .collect();
    let (mut position, mut velocity) = (0.0_f64, 0.0_f64);
    for i in 0..reduced.store.owned() {
        let j = whole_slot[&reduced.store.id[i]];
        for a in 0..3 {
            let dx = reduced.store.position[i][a] - whole.store.position[j][a];
            let dv = reduced.store.velocity[i][a] - whole.store.velocity[j][a];
            position = position.max(dx.abs() / SPACING);
            velocity = velocity.max(dv.abs() / speed);
        }
    }
    (position, velocity)
}

/// A mirrored half, quarter or eighth of a symmetric case moves as the whole does, with contact
/// across the planes and without.
#[test]
fn mirrored_models_equal_the_whole() {
    let overlap = ContactMode::Overlap(Overlap::default());
    let potential = ContactMode::Potential(Potential::default());
    for (contact, axes) in [
        (ContactMode::Kernel, &[Axis::X][..]),
        (ContactMode::Kernel, &[Axis::X, Axis::Y]),
        (ContactMode::Kernel, &[Axis::X, Axis::Y, Axis::Z]),
        (overlap, &[Axis::X, Axis::Y]),
        (potential, &[Axis::X, Axis::Y]),
    ] {
        let model = |symmetry: &[Axis]| {
            let bodies = vec![
                ball("lower", -4.0, 4.0, 800.0),
                ball("upper", 4.0, 4.0, -800.0),
            ];
            let mut case = case(3, bodies, 1.0);
            case.default_contact = contact.clone();
            case.sph.smoothing_length = SmoothingLength::Variable { min: 0.6, max: 2.0 };
            case.symmetry = planes(symmetry);
            start(case)
        };
        let (mut reduced, mut whole) = (model(axes), model(&[]));
        let share = 1_u32 << axes.len();
        assert_eq!(
            whole.store.owned(),
            (share as usize) * reduced.store.owned()
        );
        advance(&mut reduced, 60);
        advance(&mut whole, 60);
        let (position, velocity) = largest_difference(&reduced, &whole, 800.0);
        let name = contact.name();
        // Sums in other orders: rounding, which sixty steps amplify little.
        assert!(
            position < 1e-12 && velocity < 1e-12,
            "{name} {axes:?}: {position:e} {velocity:e}"
        );
        let energies = [&reduced, &whole].map(|model| model.state.totals.energy());
        let error = f64::from(share) * energies[0] - energies[1];
        assert!(error.abs() < 1e-12 * energies[1]);
        let momentum = reduced.state.worst.momentum_error;
        assert!(momentum.iter().all(|&e| e < 1e-12), "{momentum:?}");
    }
}

/// Particles that cross a plane change places with their images and go on as in the whole model;
/// the impulse of that is booked.
#[test]
fn particles_that_cross_a_plane_go_on_as_their_images() {
    let model = |symmetry: &[Axis]| {
        let mut case = case(3, vec![ball("ball", 0.0, 4.0, 0.0)], 1.0);
        make_elastic(&mut case);
        (case.sph.alpha, case.sph.beta) = (0.0, 0.0);
        case.symmetry = planes(symmetry);
        let mut simulation = start(case);
        let store = &mut simulation.store;
        for i in 0..store.owned() {
            let [x, y, z] = store.position[i].map(|x| x / SPACING);
            // The layers nearest to the plane x = 0 fly through it and each other, in shear.
            if x.abs() < 1.0 {
                store.velocity[i] = [-30e3 * x.signum(), 900.0 * z, 700.0 * y];
            }
        }
        simulation
    };
    let (mut reduced, mut whole) = (model(&[Axis::X]), model(&[]));
    reduced.diagnose(&Comm::solo());
    let before = reduced.state.totals;
    let whole_slot = |whole: &Simulation| -> BTreeMap<u64, usize> {
        (0..whole.store.owned())
            .map(|i| (whole.store.id[i], i))
            .collect()
    };
    let mut crossed = 0;
    for _ in 0..40 {
        advance(&mut reduced, 1);
        advance(&mut whole, 1);
        let slots = whole_slot(&whole);
        let (half, full) = (&reduced.store, &whole.store);
        for i in 0..half.owned() {
            let j = slots[&half.id[i]];
            let side = if full.position[j][0] < 0.0 { -1.0 } else { 1.0 };
            crossed += usize::from(side < 0.0);
            let odd = [side, 1.0, 1.0];
            for a in 0..3 {
                let dx = half.position[i][a] - odd[a] * full.position[j][a];
                let dv = half.velocity[i][a] - odd[a] * full.velocity[j][a];
                assert!(
                    dx.abs() < 1e-10 * SPACING && dv.abs() < 1e-10 * 30e3,
                    "{dx:e} {dv:e}"
                );
                for b in 0..3 {
                    let (l, m) = (half.velocity_gradient[i], full.velocity_gradient[j]);
                    let error = l[3 * a + b] - odd[a] * odd[b] * m[3 * a + b];
                    assert!(error.abs() < 1e-9 * 30e3 / SPACING);
                }
            }
            let (s, t) = (half.deviatoric_stress[i], full.deviatoric_stress[j]);
            for (c, flip) in [1.0, 1.0, 1.0, side, side, 1.0].into_iter().enumerate() {
                assert!((s[c] - flip * t[c]).abs() < 1e-9 * 28.6e9, "component {c}");
            }
        }
    }
    assert!(crossed > 100, "{crossed}");
    let after = reduced.state.totals;
    for a in 0..3 {
        let error = after.momentum[a] - before.momentum[a] - reduced.state.plane_impulse[a];
        assert!(error.abs() < 1e-14 * before.momentum_scale, "{error:e}");
    }
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
        let store = &simulation.store;
        (0..store.owned())
            .filter(|&i| store.body[i] == body)
            .map(|i| Vec3::from(store.velocity[i]) * store.mass[i])
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
        let store = &mut simulation.store;
        let slot = store.owned() / 3;
        match what {
            0 => store.velocity[slot][1] = f64::NAN,
            1 => store.density[slot] = f64::NAN,
            _ => store.position[slot][2] = 1e13,
        }
        let id = store.id[slot];
        let error = simulation.advance(&Comm::solo()).unwrap_err().to_string();
        assert!(error.contains("step 1: particle "), "{error}");
        // Neighbours catch a NaN in the same step, and the smallest id speaks for all.
        if what == 2 {
            assert!(error.contains(&format!("particle {id} ")), "{error}");
        }
    }
}

const STEPS: usize = 40;

fn reference() -> Outcome {
    let mut simulation = start(everything());
    advance(&mut simulation, STEPS);
    Outcome::of(&simulation)
}

/// NaN in everything that is not state, between any two steps, changes no bit.
#[test]
fn only_state_carries_over_a_step() {
    let mut poisoned = start(everything());
    poisoned.poison = true;
    advance(&mut poisoned, STEPS);
    assert_same(&Outcome::of(&poisoned), &reference());
}

#[test]
fn threads_change_no_bit() {
    let reference = reference();
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        assert_same(&pool.unwrap().install(self::reference), &reference);
    }
}

/// The order of particles in memory is nobody's business.
#[test]
fn order_in_memory_changes_no_bit() {
    let mut simulation = start(everything());
    let mut random = Random::new(2);
    for _ in 0..STEPS {
        let mut order: Vec<u32> = (0..u32::try_from(simulation.store.owned()).unwrap()).collect();
        random.shuffle(&mut order);
        simulation.store.keep(&order, &mut Vec::new());
        advance(&mut simulation, 1);
    }
    assert_same(&Outcome::of(&simulation), &reference());
}

/// A run taken up again from its state alone goes on as if nothing had happened.
#[test]
fn resuming_changes_no_bit() {
    let mut first = start(everything());
    advance(&mut first, STEPS / 2);
    let mut saved = first.store.clone();
    saved.resize_halo(0);
    saved.poison();
    let state = first.state.clone();
    let mut second = Simulation::resume(everything(), &Comm::solo(), state, saved).unwrap();
    advance(&mut second, STEPS - STEPS / 2);
    assert_same(&Outcome::of(&second), &reference());
}

const DIGEST: &str = "WHIPPLE_TEST_DIGEST";

/// Every instruction set of this processor gives the same bits.
#[test]
fn instruction_sets_change_no_bit() {
    if std::env::var_os(DIGEST).is_some() {
        let Outcome { rows, state } = reference();
        // FNV-1a.
        let digest = rows
            .into_values()
            .flatten()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            });
        println!("digest {digest:x} {state}");
        return;
    }
    let outputs: Vec<String> = available()
        .into_iter()
        .map(|set| {
            let output = Command::new(std::env::current_exe().unwrap())
                .args(["--exact", "instruction_sets_change_no_bit", "--nocapture"])
                .env(DIGEST, "1")
                .env("WHIPPLE_SIMD", set.name())
                .output()
                .unwrap();
            assert!(output.status.success());
            let text = String::from_utf8(output.stdout).unwrap();
            let line = text.lines().find_map(|line| line.split_once("digest "));
            line.expect("a digest").1.to_owned()
        })
        .collect();
    for (output, set) in outputs.iter().zip(available()) {
        assert_eq!(*output, outputs[0], "{}", set.name());
    }
}
