//! The core of overlap contact: how near two lone particles come that meet at any speed, what they
//! leave with, and where the rest of the energy goes.

use crate::world::{SPACING, World, case_of, some_body};
use engine::contact::ContactForce;
use material::Material;
use numerics::vector::{dot, norm};
use particles::neighbours::MotionRecord;

/// What becomes of two particles that meet.
struct Bounce {
    /// The least distance in spacings.
    closest: f64,
    /// Kinetic energy of the approach after over before.
    left: f64,
    /// What is missing of the energy, over what there was.
    lost: f64,
}

/// The reduced mass (kg) and the way between two particles.
fn relative(world: &World) -> (f64, [f64; 3], [f64; 3]) {
    let mass = &world.particles.mass;
    let of = |value: fn(&MotionRecord) -> [f64; 3]| {
        let [a, b] = [0, 1].map(|i| value(&world.motion[i]));
        std::array::from_fn(|k| a[k] - b[k])
    };
    let reduced = mass[0] * mass[1] / (mass[0] + mass[1]);
    (reduced, of(|m| m.position), of(|m| m.velocity))
}

/// Two particles of bodies of the materials `materials` that meet at `speed` (m/s), `aside` spacings
/// off, in a case that states no speed.
fn bounce(dimension: usize, materials: [usize; 2], speed: f64, aside: f64) -> Bounce {
    let bodies = materials.map(|material| some_body(material, SPACING, 1.3));
    let case = case_of(dimension, bodies.to_vec());
    let places = [(0, [0.0; 3]), (1, [3.0 * SPACING, aside * SPACING, 0.0])];
    let mut world = World::new(case, &places);
    world.motion[1].velocity = [-speed, 0.0, 0.0];
    let (mass, _, before) = relative(&world);
    let start = 0.5 * mass * dot(&before, &before);
    let mut closest = f64::INFINITY;
    let mut heat = 0.0;
    let dt = 2e-4 * SPACING / speed;
    let mut forces = forces_on(&mut world);
    loop {
        kick(&mut world, &forces, 0.5 * dt);
        for i in 0..2 {
            for a in 0..3 {
                world.shift(i, a, dt * world.motion[i].velocity[a]);
            }
        }
        forces = forces_on(&mut world);
        kick(&mut world, &forces, 0.5 * dt);
        heat += dt * forces.iter().map(|f| f.heat).sum::<f64>();
        let (_, way, rate) = relative(&world);
        closest = norm(&way).min(closest * SPACING) / SPACING;
        if dot(&way, &rate) > 0.0 && norm(&way) > 3.0 * SPACING {
            let kinetic = 0.5 * mass * dot(&rate, &rate);
            return Bounce {
                closest,
                left: kinetic / start,
                lost: 1.0 - (kinetic + heat) / start,
            };
        }
    }
}

fn forces_on(world: &mut World) -> Vec<ContactForce> {
    let lists = world.lists();
    world.forces(&lists).0
}

/// A kick of `dt` (s).
fn kick(world: &mut World, forces: &[ContactForce], dt: f64) {
    for (i, force) in forces.iter().enumerate() {
        for a in 0..3 {
            let whole = force.force[a] + force.drag[a];
            world.motion[i].velocity[a] += dt * whole / world.particles.mass[i];
        }
    }
}

/// `q² = ln(1 + 2 B e)/B` of the depth `q = 1 − r/r_c`, with the energy e of the approach over
/// `κ_c M V̄` (theory page "Contact"): the least distance in spacings, and the share of the energy
/// that is left.
fn expected(materials: [usize; 2], speed: f64) -> [f64; 2] {
    let case = case_of(3, vec![some_body(0, SPACING, 1.3)]);
    let mean = |value: fn(&Material) -> f64| {
        let [a, b] = materials.map(|m| value(&case.materials[m]));
        2.0 / (1.0 / a + 1.0 / b)
    };
    let scale = 2.2 * mean(Material::p_wave_modulus);
    let energy = 0.25 * mean(|m| m.reference_density) * speed * speed / scale;
    let square = (1.0 + 10.0 * energy).ln() / 5.0;
    [0.6 * (1.0 - square.sqrt()), 0.5 * square / energy]
}

/// Lone particles that are faster than anything that the case states turn back where the theory
/// says; the energy of their approach is kinetic again, or heat. Aside, they come no nearer.
#[test]
fn lone_particles_of_any_speed_stay_apart() {
    for dimension in [2, 3] {
        for materials in [[0, 0], [1, 1], [0, 1]] {
            for speed in [500.0, 3e3, 7e3, 1.2e4] {
                let [distance, left] = expected(materials, speed);
                let what = format!("{dimension} {materials:?} {speed}: {distance}, {left}");
                let [ahead, aside] = [0.0, 0.2].map(|y| bounce(dimension, materials, speed, y));
                for bounce in [&ahead, &aside] {
                    assert!(bounce.lost.abs() < 5e-4, "{what}: {}", bounce.lost);
                    assert!(
                        bounce.closest > distance - 1e-3,
                        "{what}: {}",
                        bounce.closest
                    );
                }
                assert!(
                    (ahead.closest - distance).abs() < 1e-3,
                    "{what}: {}",
                    ahead.closest
                );
                assert!((ahead.left - left).abs() < 1e-3, "{what}: {}", ahead.left);
            }
            assert!(expected(materials, 7e3)[0] > 0.28);
        }
    }
}
