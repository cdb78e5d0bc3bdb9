//! Bodies laid in touch, or into each other, at the start of a case.
#![allow(clippy::float_cmp, reason = "what is exact is held exactly")]

use crate::common::{body, case, sphere_on_plate};
use comm::Comm;
use engine::contact::overlap::{self, OFFSET_LIMIT, initial_offset};
use engine::step::Simulation;
use model::{Axis, Body, Case, LatticeKind, Shape, Vec3};
use numerics::vector::norm;
use particles::ParticleStore;

const SPACING: f64 = 1e-5;

fn start(case: Case) -> Simulation {
    Simulation::start(case, &Comm::solo()).unwrap()
}

fn check_at_rest(name: &str, simulation: &Simulation) {
    assert_eq!(simulation.state.capped_reliefs, 0, "{name}");
    let particles = &simulation.particles;
    assert!(
        particles.foreign_fraction.iter().any(|&f| f > 0.1),
        "{name}"
    );
    assert!(
        particles
            .contact_acceleration
            .iter()
            .all(|a| *a == [0.0; 3]),
        "{name}"
    );
    assert_eq!(simulation.state.contact_energy, 0.0, "{name}");
    assert_eq!(simulation.state.interpenetrated, 0, "{name}");
}

fn block(lower: [f64; 3], upper: [f64; 3], spacing: f64) -> Body {
    let shape = Shape::Box {
        lower: Vec3::from(lower) * SPACING,
        upper: Vec3::from(upper) * SPACING,
    };
    body("block", shape, spacing * SPACING, Vec3::zeros())
}

/// Bodies laid in touch start without any force, to the last bit, whatever meets; two flat
/// faces of one cubic lattice do not even need relief.
#[test]
fn bodies_laid_in_touch_start_free_of_force() {
    let slab = block([0.0, 0.0, -4.0], [10.0, 10.0, 0.0], 1.0);
    let face = block([0.0, 0.0, 0.0], [10.0, 10.0, 4.0], 1.0);
    let shifted = block([2.3, 0.4, 0.0], [9.3, 7.4, 4.0], 1.0);
    // The touching value is that of a particle straight before one of the other face; between
    // four of them the sum is larger by up to .0018 for h = 1.0–1.5 Δp.
    for (name, top, bound) in [("face", face, 1e-13), ("shifted face", shifted, 0.0018)] {
        let simulation = start(case(3, vec![slab.clone(), top], 1.0));
        check_at_rest(name, &simulation);
        let most = simulation
            .particles
            .touch_relief
            .iter()
            .copied()
            .fold(0.0, f64::max);
        assert!(most < bound, "{name}: relief {most}");
    }
    let finer = block([1.0, 1.0, 0.0], [6.0, 6.0, 4.0], 0.5);
    let mut finer = start(case(3, vec![slab.clone(), finer], 1.0));
    // Layers half of both spacings apart: the boxes touch.
    check_at_rest("finer face", &finer);
    finer.advance(&Comm::solo()).unwrap();
    check_at_rest("finer face, a step later", &finer);

    let step = vec![
        block([0.0, 0.0, 0.0], [5.0, 8.0, 5.0], 1.0),
        block([5.0, 0.0, 0.0], [10.0, 8.0, 5.0], 1.0),
        block([2.0, 0.0, 5.0], [8.0, 8.0, 9.0], 1.0),
    ];
    check_at_rest("three at a seam", &start(case(3, step, 1.0)));
    let notch = vec![
        block([0.0, 0.0, -4.0], [12.0, 6.0, 0.0], 1.0),
        block([0.0, 0.0, 0.0], [6.0, 6.0, 6.0], 1.0),
        block([6.0, 0.0, 0.0], [12.0, 6.0, 6.0], 1.0),
        block([3.0, 0.0, 6.0], [9.0, 6.0, 10.0], 1.0),
    ];
    check_at_rest("edges", &start(case(3, notch, 1.0)));

    check_at_rest(
        "sphere on plate",
        &start(sphere_on_plate(2e-5, 0.0, true, 1.0)),
    );
    let mut hexagonal = sphere_on_plate(3e-5, 0.0, false, 1.0);
    for body in &mut hexagonal.bodies {
        body.lattice.kind = LatticeKind::Hexagonal;
    }
    lay_in_touch(&mut hexagonal, Axis::Z);
    check_at_rest("hexagonal sphere on hexagonal plate", &start(hexagonal));
    for (dimension, kind, axis) in [
        (1, LatticeKind::Cubic, Axis::X),
        (2, LatticeKind::Cubic, Axis::X),
        (2, LatticeKind::Hexagonal, Axis::X),
        (2, LatticeKind::Hexagonal, Axis::Y),
    ] {
        let mut bodies = vec![block([0.0; 3], [10.0, 10.0, 0.0], 1.0); 2];
        for body in &mut bodies {
            body.lattice.kind = kind;
        }
        let mut case = case(dimension, bodies, 1.0);
        lay_in_touch(&mut case, axis);
        check_at_rest(&format!("{dimension}-D {kind:?} {axis:?}"), &start(case));
    }
}

/// Moves the first body up an axis or down it, until it touches the second from above.
fn lay_in_touch(case: &mut Case, axis: Axis) {
    let [body, other, ..] = &case.bodies[..] else {
        panic!("two bodies");
    };
    let way = populate::touching_distance(body, other, case.dimension, axis, false).unwrap();
    let mut along = Vec3::zeros();
    along[axis.index()] = way;
    case.bodies[0].shape.translate(&along);
}

/// A body laid into another is not forgiven beyond the limit; the particles are counted.
#[test]
fn relief_is_capped_and_counted() {
    let fraction = |s: f64| overlap::Fraction {
        fraction: s,
        touching: 0.23,
        ..Default::default()
    };
    assert_eq!(initial_offset(&fraction(0.2)), (0.0, false));
    assert_eq!(initial_offset(&fraction(0.3)), (0.3 - 0.23, false));
    assert_eq!(initial_offset(&fraction(0.5)), (OFFSET_LIMIT - 0.23, true));

    let slab = block([0.0, 0.0, -6.0], [10.0, 10.0, 0.0], 1.0);
    let sunk = block([2.0, 2.0, -3.5], [8.0, 8.0, 4.5], 1.0);
    let simulation = start(case(3, vec![slab, sunk], 1.0));
    let particles = &simulation.particles;
    let mut capped = 0;
    for i in 0..particles.owned() {
        let level = particles.touching_value[i] + particles.touch_relief[i];
        assert!(level <= OFFSET_LIMIT + 1e-15);
        let beyond = particles.foreign_fraction[i] > OFFSET_LIMIT;
        capped += i64::from(beyond);
        assert_eq!(particles.contact_excess[i] > 0.0, beyond);
    }
    assert!(capped > 20);
    assert_eq!(simulation.state.capped_reliefs, capped);
    assert!(simulation.state.contact_energy > 0.0);
}

/// A particle in a vacancy of a foreign lattice has room; one between its sites is enclosed.
#[test]
fn a_vacancy_is_room() {
    let bodies = vec![
        block([-4.5; 3], [4.5; 3], 1.0),
        block([10.0, -0.5, -0.5], [11.0, 0.5, 0.5], 1.0),
    ];
    let mut simulation = start(case(3, bodies, 1.0));
    let particles = &mut simulation.particles;
    let at = |particles: &ParticleStore, place: [f64; 3]| {
        let distance = |i: usize| {
            norm(&std::array::from_fn(|a| {
                particles.position[i][a] - place[a]
            }))
        };
        (0..particles.owned())
            .find(|&i| distance(i) < 0.1 * SPACING)
            .unwrap()
    };
    let speck = at(particles, [10.5 * SPACING, 0.0, 0.0]);
    let middle = at(particles, [0.0; 3]);
    particles.position[middle] = [0.0, 0.0, 20.0 * SPACING];
    let mut enclosed = |aside: f64| {
        simulation.particles.position[speck] = [aside * SPACING; 3];
        simulation.advance(&Comm::solo()).unwrap();
        assert!(simulation.particles.foreign_fraction[speck] > 0.5);
        simulation.particles.enclosed_time[speck]
    };
    assert_eq!(enclosed(0.0), 0.0);
    assert!(enclosed(2.5) > 0.0);
}
