//! One and two dimensions through the whole engine: the same code as in three, to the same figures.

use std::collections::BTreeMap;

use crate::common::outcome::{advance, every_option, start};
use crate::common::{SPACING, body, case, make_elastic, planes};
use engine::step::Simulation;
use model::{Axis, Case, ContactMode, Overlap, Potential, Shape, SmoothingLength, SphForm, Vec3};

/// What the conventional sums give a linear field on a cubic lattice at h = 1.3 Δp (see `engine_sph`).
const FACTORS: [f64; 3] = [
    1.022_373_166_205_665,
    1.010_542_957_253_393,
    0.993_483_699_944_107,
];

/// A cube of twelve spacings, or what a dimension leaves of it, in the conventional form.
fn cube(dimension: usize) -> Case {
    let corner = 6.0 * SPACING * Vec3::new(1.0, 1.0, 1.0);
    let shape = Shape::Box {
        lower: -corner,
        upper: corner,
    };
    let mut case = case(
        dimension,
        vec![body("cube", shape, SPACING, Vec3::zeros())],
        1.0,
    );
    make_elastic(&mut case);
    case.sph.form = SphForm::Conventional;
    case
}

/// Owned particles at least three spacings inside the cube.
fn inside(s: &Simulation) -> Vec<usize> {
    let deep = |i: &usize| {
        s.particles.position[*i]
            .iter()
            .all(|x| x.abs() < 3.0 * SPACING)
    };
    (0..s.particles.owned()).filter(deep).collect()
}

#[test]
fn a_linear_velocity_field_gives_its_gradient_inside() {
    let field = [0.3, -1.0, 0.2, 0.7, 0.1, -0.4, 0.5, -0.6, -0.2].map(|x| 1e3 * x);
    for (dimension, factor) in (1..).zip(FACTORS) {
        let mut case = cube(dimension);
        case.time_step.max = 1e-15;
        let mut s = start(case);
        assert_eq!(
            s.particles.owned(),
            12_usize.pow(u32::try_from(dimension).unwrap())
        );
        for (v, x) in s.particles.velocity.iter_mut().zip(&s.particles.position) {
            for a in 0..dimension {
                v[a] = (0..dimension).map(|b| field[3 * a + b] * x[b]).sum();
            }
        }
        advance(&mut s, 1);
        let inside = inside(&s);
        assert!(inside.len() >= 6_usize.pow(u32::try_from(dimension).unwrap()));
        for i in inside {
            for c in 0..9 {
                let known = c / 3 < dimension && c % 3 < dimension;
                let wanted = if known { factor * field[c] } else { 0.0 };
                let error = (s.particles.velocity_gradient[i][c] - wanted).abs();
                assert!(error < 1e-9 * 1e3, "{dimension}-D, {c}: {error:e}");
            }
        }
    }
}

/// A block with a deviatoric stress is turned rigidly in its plane: inside, the stress turns with
/// it (by the lattice's factor, as all gradients), its invariants stay and no pressure comes.
#[test]
fn a_stressed_block_that_turns_keeps_its_invariants() {
    const SPIN: f64 = 1e5;
    const SHEAR: f64 = 1e8;
    let mut case = cube(2);
    case.time_step.max = 1e-8;
    let mut s = start(case);
    let particles = &mut s.particles;
    let gradient = FACTORS[1] * SPIN;
    for i in 0..particles.owned() {
        particles.deviatoric_stress[i] = [SHEAR, -SHEAR, 0.0, 0.0, 0.0, 0.0];
        particles.velocity_gradient[i] = [0.0, -gradient, 0.0, gradient, 0.0, 0.0, 0.0, 0.0, 0.0];
    }
    let reference: BTreeMap<u64, [f64; 3]> = (0..particles.owned())
        .map(|i| (particles.id[i], particles.position[i]))
        .collect();
    let turned = |x: &[f64; 3], angle: f64| {
        let (sin, cos) = angle.sin_cos();
        [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], 0.0]
    };
    let mut angle = 0.0;
    for _ in 0..500 {
        // Velocities and accelerations that the drift takes to the turned place, with the turned
        // velocity.
        let dt = s.state.dt;
        let particles = &mut s.particles;
        for i in 0..particles.owned() {
            let rest = &reference[&particles.id[i]];
            let (here, there) = (turned(rest, angle), turned(rest, angle + SPIN * dt));
            let last = [-SPIN * there[1], SPIN * there[0], 0.0];
            for a in 0..3 {
                let mean = (there[a] - here[a]) / dt;
                particles.position[i][a] = here[a];
                particles.velocity[i][a] = 2.0 * mean - last[a];
                particles.acceleration[i][a] = 2.0 * (last[a] - mean) / dt;
            }
        }
        advance(&mut s, 1);
        angle += SPIN * dt;
    }
    assert!(angle > 0.2, "{angle}");
    let (sin, cos) = (2.0 * FACTORS[1] * angle).sin_cos();
    for i in inside(&s) {
        let [xx, yy, zz, xy, xz, yz] = s.particles.deviatoric_stress[i];
        assert!(s.particles.pressure[i].abs() < 1e-9 * SHEAR);
        assert!(xz == 0.0 && yz == 0.0 && zz.abs() < 1e-9 * SHEAR);
        let square = 0.5 * (xx * xx + yy * yy) + xy * xy;
        assert!((square / (SHEAR * SHEAR) - 1.0).abs() < 1e-9, "{square:e}");
        assert!((xx - SHEAR * cos).abs() < 1e-6 * SHEAR);
        assert!((xy - SHEAR * sin).abs() < 1e-6 * SHEAR);
    }
}

/// Largest difference of position, in spacings, between a reduced model and the whole.
fn difference(reduced: &Simulation, whole: &Simulation) -> f64 {
    let places: BTreeMap<u64, [f64; 3]> = (0..whole.particles.owned())
        .map(|i| (whole.particles.id[i], whole.particles.position[i]))
        .collect();
    let particles = &reduced.particles;
    (0..particles.owned())
        .map(|i| (Vec3::from(places[&particles.id[i]]) - Vec3::from(particles.position[i])).norm())
        .fold(0.0, f64::max)
        / SPACING
}

/// Models cut at planes equal the whole in each dimension, with every option of the sums.
#[test]
fn mirrored_models_equal_the_whole_with_every_option() {
    let overlap = ContactMode::Overlap(Overlap::default());
    let potential = ContactMode::Potential(Potential::default());
    for (dimension, axes) in [
        (1, &[Axis::X][..]),
        (2, &[Axis::X]),
        (2, &[Axis::X, Axis::Y]),
        (3, &[Axis::X, Axis::Y]),
    ] {
        for contact in [&overlap, &potential] {
            let model = |symmetry: &[Axis]| {
                // Two balls that fly at a third between them.
                let ball = |name, x: f64, speed| {
                    let shape = Shape::Sphere {
                        centre: Vec3::new(x, 0.0, 0.0) * SPACING,
                        radius: 3.0 * SPACING,
                    };
                    let shape = if dimension == 1 {
                        Shape::Box {
                            lower: Vec3::new(x - 3.0, 0.0, 0.0) * SPACING,
                            upper: Vec3::new(x + 3.0, 0.0, 0.0) * SPACING,
                        }
                    } else {
                        shape
                    };
                    body(name, shape, SPACING, Vec3::new(speed, 0.0, 0.0))
                };
                let mut bodies = vec![ball("middle", 0.0, 0.0), ball("right", 6.0, -900.0)];
                if !symmetry.contains(&Axis::X) {
                    bodies.push(ball("left", -6.0, 900.0));
                }
                let mut case = case(dimension, bodies, 1.0);
                case.default_contact = contact.clone();
                case.sph = every_option().sph;
                case.sph.smoothing_length = SmoothingLength::Variable { min: 0.6, max: 2.0 };
                case.symmetry = planes(symmetry);
                start(case)
            };
            let (mut reduced, mut whole) = (model(axes), model(&[]));
            advance(&mut reduced, 60);
            advance(&mut whole, 60);
            let error = difference(&reduced, &whole);
            println!("{dimension}-D {axes:?} {}: {error:e}", contact.name());
            // Sums in other orders: rounding, which sixty steps amplify little.
            assert!(error < 1e-11, "{dimension}-D {axes:?}: {error:e}");
            let moved = whole.state.totals.kinetic_energy / whole.state.initial.kinetic_energy;
            assert!((moved - 1.0).abs() > 0.1, "hardly a collision: {moved}");
        }
    }
}
