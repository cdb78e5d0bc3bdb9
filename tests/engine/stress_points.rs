//! Stress points: linear fields, what forces conserve, the alternating mode, volumes.

use crate::common::outcome::{advance, start};
use crate::common::random::Random;
use crate::common::virtual_ranks::on_each;
use crate::common::{ball, body, case, make_elastic, planes, sphere_on_plate};
use crate::linear_field::free_block;
use comm::Comm;
use engine::step::Simulation;
use model::{Axis, Case, Shape, SmoothingLength, SphForm, Vec3};
use nalgebra::Matrix3;

const SPACING: f64 = 1e-4;

/// A box of so many particles along each axis, its lower corner at `lower` (m).
fn block(dimension: usize, lower: f64, counts: [f64; 3]) -> Case {
    let corner = |far: f64| {
        let at = |a: usize| {
            if a < dimension {
                lower + far * counts[a] * SPACING
            } else {
                0.0
            }
        };
        Vec3::new(at(0), at(1), at(2))
    };
    let shape = Shape::Box {
        lower: corner(0.0),
        upper: corner(1.0),
    };
    let bodies = vec![body("block", shape, SPACING, Vec3::zeros())];
    let mut case = case(dimension, bodies, 1.0);
    make_elastic(&mut case);
    case.sph.form = SphForm::StressPoints;
    case
}

fn is_point(s: &Simulation, i: usize) -> bool {
    s.particles.stress_mass[i] > 0.0
}

/// Moves particles and stress points off their lattices, each by its id.
fn stir(s: &mut Simulation, by: f64) {
    for i in 0..s.particles.owned() {
        let mut random = Random::new(s.particles.id[i] + 1);
        let jitter = random.vector(s.case.dimension, by);
        for a in 0..3 {
            s.particles.position[i][a] += jitter[a];
        }
    }
}

/// Gradients of what moves as a linear field stay exact to 1e-12 while a block turns and stretches,
/// and stress points stay where the field carries them: with free surfaces, behind mirrors, in each
/// dimension, on one rank and on two.
#[test]
fn linear_fields_are_exact() {
    on_each(&[1, 2], |comm| {
        for (dimension, mirrors) in [
            (1, &[][..]),
            (2, &[]),
            (3, &[]),
            (1, &[Axis::X]),
            (2, &[Axis::X]),
            (3, &[Axis::X, Axis::Y]),
        ] {
            check_linear(comm, dimension, mirrors);
        }
    });
}

fn check_linear(comm: &Comm, dimension: usize, mirrors: &[Axis]) {
    let (case, field) = free_block(dimension, mirrors, SphForm::StressPoints);
    let mut s = Simulation::start(case, comm).unwrap();
    assert_eq!(s.state.uncorrected, 0);
    stir(&mut s, 0.2 * SPACING);
    for i in 0..s.particles.owned() {
        s.particles.velocity[i] = (field * Vec3::from(s.particles.position[i])).into();
    }
    // Nothing is known of velocities before.
    s.state.last_dt = 1e30;
    let (mut gradient, mut velocity) = (0.0_f64, 0.0_f64);
    for _ in 0..12 {
        s.advance(comm).unwrap();
        let motion = Matrix3::identity() + field * s.state.time;
        let wanted = field * motion.try_inverse().unwrap();
        for i in (0..s.particles.owned()).filter(|&i| is_point(&s, i)) {
            for c in 0..9 {
                let error = s.particles.velocity_gradient[i][c] - wanted[(c / 3, c % 3)];
                gradient = gradient.max(error.abs() / field.norm());
            }
            let error =
                Vec3::from(s.particles.velocity[i]) - wanted * Vec3::from(s.particles.position[i]);
            velocity = velocity.max(error.norm() / (field.norm() * SPACING));
        }
    }
    let steepest = s.particles.fit_norm.iter().copied().fold(0.0, f64::max);
    println!("steepest fit {steepest:.2}");
    assert_eq!(s.state.worst.uncorrected, 0);
    println!("{dimension}-D {mirrors:?}: gradients {gradient:e}, velocities {velocity:e}");
    assert!(gradient <= 1e-12, "{dimension}-D {mirrors:?}: {gradient:e}");
    assert!(velocity <= 1e-11, "{dimension}-D {mirrors:?}: {velocity:e}");
}

/// Stress points hold the volume of the body, but for half a spacing at each end of a bar.
#[test]
fn volumes_are_a_partition() {
    let masses = |case: Case| {
        let s = start(case);
        let particles: f64 = s.particles.mass.iter().sum();
        (particles, s.particles.stress_mass.iter().sum::<f64>())
    };
    let mut shapes = vec![
        block(2, 0.0, [9.0, 4.0, 0.0]),
        block(3, 0.0, [5.0, 4.0, 3.0]),
    ];
    let mut turned = block(2, 0.0, [12.0, 12.0, 0.0]);
    turned.bodies[0].lattice.angle = 0.5;
    let mut mirrored = block(3, -3e-4, [6.0; 3]);
    mirrored.symmetry = planes(&Axis::ALL);
    let mut quarter = sphere_on_plate(5e-5, 0.0, true, 1.0);
    quarter.sph.form = SphForm::StressPoints;
    shapes.extend([turned, mirrored, quarter]);
    for case in shapes {
        let (particles, points) = masses(case);
        println!("{points:e} of {particles:e}");
        assert!((points / particles - 1.0).abs() < 1e-12);
    }
    let (particles, points) = masses(block(1, 0.0, [10.0; 3]));
    assert!((points / particles - 0.9).abs() < 1e-12);
    // On a plane stands half a point.
    let mut half = block(1, -5e-4, [10.0; 3]);
    half.symmetry = planes(&[Axis::X]);
    let (particles, points) = masses(half);
    assert!((points / particles - 0.9).abs() < 1e-12);
}

/// Whatever particles and stress points are at: forces keep momentum and angular momentum, and put
/// into heat just what they take from the motion.
#[test]
fn forces_are_the_adjoint_of_strain() {
    for dimension in 1..=3 {
        for variable in [false, true] {
            let mut case = block(dimension, 0.0, [8.0, 7.0, 6.0]);
            if variable {
                case.sph.smoothing_length = SmoothingLength::Variable { min: 0.6, max: 2.0 };
            }
            let mut s = start(case);
            stir(&mut s, 0.2 * SPACING);
            for i in 0..s.particles.owned() {
                let mut random = Random::new(s.particles.id[i] + 7);
                s.particles.velocity[i] = random.vector(dimension, 100.0);
                if is_point(&s, i) {
                    s.particles.deviatoric_stress[i] =
                        std::array::from_fn(|_| 1e9 * random.vector(1, 1.0)[0]);
                    s.particles.density[i] *= 1.0 + 0.05 * random.vector(1, 1.0)[0];
                }
            }
            s.case.time_step.max = 1e-12;
            s.state.dt = 1e-12;
            s.advance(&Comm::solo()).unwrap();
            let (mut sums, mut sizes) = ([0.0; 7], [0.0; 7]);
            let particles = &s.particles;
            let mut add = |k: usize, x: f64| {
                sums[k] += x;
                sizes[k] += x.abs();
            };
            for i in 0..particles.owned() {
                let force = Vec3::from(particles.acceleration[i]) * particles.mass[i];
                let turn = Vec3::from(particles.position[i]).cross(&force);
                for a in 0..3 {
                    add(a, force[a]);
                    // What turns in the model's own dimensions.
                    if dimension == 3 || (dimension == 2 && a == 2) {
                        add(3 + a, turn[a]);
                    }
                }
                add(6, Vec3::from(particles.predicted_velocity[i]).dot(&force));
                if is_point(&s, i) {
                    add(
                        6,
                        particles.stress_mass[i] * particles.d_specific_energy_dt[i],
                    );
                }
            }
            println!("{dimension}-D: {sums:?} of {sizes:?}");
            for (sum, size) in sums.iter().zip(sizes) {
                assert!(sum.abs() <= 1e-12 * size, "{sums:?} of {sizes:?}");
            }
        }
    }
}

/// Velocities that alternate from particle to particle along all axes: the largest rate of strain
/// along an axis, over `2v/Δp`.
fn seen(form: SphForm, dimension: usize) -> f64 {
    let mut case = block(dimension, 0.0, [12.0; 3]);
    case.sph.form = form;
    let mut s = start(case);
    for i in 0..s.particles.owned() {
        let cells = s.particles.position[i].map(|x| (x / SPACING).floor());
        let odd = cells.iter().sum::<f64>() % 2.0 != 0.0;
        s.particles.velocity[i] = if odd {
            [1e-3, 0.0, 0.0]
        } else {
            [-1e-3, 0.0, 0.0]
        };
    }
    s.case.time_step.max = 1e-15;
    s.state.dt = 1e-15;
    s.state.last_dt = 1e30;
    s.advance(&Comm::solo()).unwrap();
    let inside = |i: &usize| {
        let x = &s.particles.position[*i];
        (0..dimension).all(|a| (x[a] / SPACING - 6.0).abs() < 2.2)
    };
    let rates = (0..s.particles.owned()).filter(inside);
    let rates = rates.map(|i| s.particles.velocity_gradient[i][0].abs());
    rates.fold(0.0, f64::max) * SPACING / 2e-3
}

#[test]
fn alternating_velocities_are_strain() {
    for dimension in 1..=3 {
        let [conventional, normalised, points] = [
            SphForm::Conventional,
            SphForm::Normalised,
            SphForm::StressPoints,
        ]
        .map(|form| seen(form, dimension));
        println!("{dimension}-D: {conventional:e}, {normalised:e}, {points:.3}");
        assert!(conventional < 1e-9 && normalised < 1e-9);
        let least = [0.0, 0.95, 0.7, 0.4][dimension];
        assert!(points > least, "{dimension}-D: {points}");
    }
}

/// Two balls that meet: momentum to round-off, and energy but for the defect of contact, which is
/// .17 % in the conventional form.
#[test]
fn balls_collide() {
    let bodies = vec![
        ball("lower", -4.0, 4.0, 200.0),
        ball("upper", 4.0, 4.0, -200.0),
    ];
    let mut case = case(3, bodies, 1.0);
    make_elastic(&mut case);
    case.sph.form = SphForm::StressPoints;
    let mut s = start(case);
    advance(&mut s, 150);
    let state = &s.state;
    println!(
        "momentum {:?}, energy {:e}, contact defect {:e}, impulse {:e}, uncorrected {}",
        state.worst.momentum_error,
        state.worst.energy_error,
        state.worst.contact_defect,
        state.pairs[0].impulse[2],
        state.worst.uncorrected,
    );
    assert!(state.worst.momentum_error.iter().all(|&e| e < 1e-13));
    assert!(state.pairs[0].impulse[2] < 0.0);
    assert!(state.worst.contact_defect < 2e-3);
    let rest = state.worst.energy_error - state.worst.contact_defect;
    assert!(rest.abs() < 1e-12, "{rest:e}");
}
