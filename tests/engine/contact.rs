//! Contact forces against the numerical gradient of an energy that is written down again here,
//! and what contact promises about them.
#![allow(clippy::float_cmp, reason = "what is exact is held exactly")]
#![allow(
    clippy::needless_range_loop,
    reason = "components of vectors and tensors"
)]
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

use crate::common::random::Random;
use crate::world::{Lists, SPACING, World, case_of, some_body};
use engine::contact::ContactTable;
use model::{
    Case, ContactClass, ContactMode, ContactPair, LatticeKind, Overlap, Potential, PotentialRange,
};
use numerics::kernel::Kernel;

/// Two or three interlocking random clouds of the bodies, about one spacing apart.
fn blobs(case: &Case, seed: u64) -> Vec<(usize, [f64; 3])> {
    let mut random = Random::new(seed);
    let mut particles = Vec::new();
    let size = [3.0, 1.6, 1.2][case.dimension - 1] * SPACING;
    for b in 0..case.bodies.len() {
        for _ in 0..[6, 14, 18][case.dimension - 1] {
            particles.push((b, random.vector(case.dimension, size)));
        }
    }
    particles
}

/// Forces are minus the gradient of the energy, whose parts in the ledger add up to it; no net
/// force, no torque.
fn check_gradient(world: &mut World) {
    let lists = world.lists();
    let (forces, by_body) = world.forces(&lists);
    let energy = world.energy();
    let ledger: f64 = forces.iter().map(|f| f.energy).sum();
    assert!(energy > 0.0);
    assert!(
        (ledger - energy).abs() < 1e-13 * energy,
        "{ledger} is not {energy}"
    );
    let by_body: f64 = by_body.iter().map(|b| b.energy).sum();
    assert!((by_body - energy).abs() < 1e-13 * energy);

    let largest = forces
        .iter()
        .flat_map(|f| f.force)
        .fold(0.0, |most: f64, f| most.max(f.abs()));
    let step = 1e-6 * SPACING;
    for (i, contact) in forces.iter().enumerate() {
        for axis in 0..world.case.dimension {
            world.shift(i, axis, step);
            let up = world.energy();
            world.shift(i, axis, -2.0 * step);
            let down = world.energy();
            world.shift(i, axis, step);
            let slope = (up - down) / (2.0 * step);
            // Rounding of the energy by 1e-15 over the step, and the step squared.
            let bound = 1e-9 * energy / SPACING + 1e-7 * largest;
            let error = (slope + contact.force[axis]).abs();
            assert!(
                error < bound,
                "{slope} against {}: {error:e}",
                contact.force[axis]
            );
        }
        for axis in world.case.dimension..3 {
            assert_eq!(contact.force[axis], 0.0);
        }
    }
    let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
    for (contact, record) in forces.iter().zip(&world.motion) {
        let (f, x) = (contact.force, record.position);
        for a in 0..3 {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            force[a] += f[a];
            torque[a] += x[b] * f[c] - x[c] * f[b];
        }
    }
    for a in 0..3 {
        assert!(force[a].abs() < 1e-13 * largest, "{force:?} of {largest}");
        assert!(torque[a].abs() < 1e-13 * largest * SPACING, "{torque:?}");
    }
}

/// Pair forces are opposite to the last bit but one.
fn check_pairs(world: &mut World, class: ContactClass) {
    let lists = world.lists();
    world.fractions(&lists);
    for i in 0..world.len() {
        for j in world.neighbours(i, class) {
            let j = j as usize;
            let (here, there) = (world.pair_force(i, j, class), world.pair_force(j, i, class));
            let size: f64 = here.iter().map(|f| f.abs()).sum();
            for a in 0..3 {
                assert!((here[a] + there[a]).abs() <= 1e-15 * size);
            }
        }
    }
}

/// Random initial overlap offsets for the particles of a world, small enough to leave some excess.
fn give_offsets(world: &mut World, seed: u64) {
    let mut random = Random::new(seed);
    for offset in &mut world.particles.touch_relief {
        *offset = random.within(-0.1, 0.1).max(0.0);
    }
}

#[test]
fn overlap_forces_are_the_gradient_of_the_energy() {
    for dimension in 1..=3 {
        for seed in 0..4 {
            // Like bodies; unlike ones with other spacings and materials; three at a seam.
            for bodies in [
                vec![some_body(0, SPACING, 1.3); 2],
                vec![some_body(0, SPACING, 1.3), some_body(1, 0.7 * SPACING, 1.1)],
                vec![
                    some_body(0, SPACING, 1.3),
                    some_body(1, 0.8 * SPACING, 1.4),
                    some_body(1, 1.2 * SPACING, 1.2),
                ],
            ] {
                let mut case = case_of(dimension, bodies);
                case.bodies[0].lattice.kind = LatticeKind::Hexagonal;
                let particles = blobs(&case, seed);
                let mut world = World::new(case, &particles);
                give_offsets(&mut world, seed);
                check_gradient(&mut world);
                check_pairs(&mut world, ContactClass::Overlap);
            }
        }
    }
}

#[test]
fn potential_forces_are_the_gradient_of_the_energy() {
    for dimension in 1..=3 {
        for (exponent, range) in [
            (1, PotentialRange::Support),
            (2, PotentialRange::Support),
            (4, PotentialRange::Support),
            (4, PotentialRange::Spacing),
        ] {
            let bodies = vec![some_body(0, SPACING, 1.3), some_body(1, 0.8 * SPACING, 1.1)];
            let mut case = case_of(dimension, bodies);
            case.default_contact = ContactMode::Potential(Potential {
                stiffness: 0.7,
                exponent,
                range,
                ..Potential::default()
            });
            let particles = blobs(&case, 7);
            let mut world = World::new(case, &particles);
            check_gradient(&mut world);
            check_pairs(&mut world, ContactClass::Potential);
        }
    }
}

/// With the range "spacing" force and energy of a pair set in at zero at the mean spacing, and grow
/// as it comes nearer: round-off in the place of bodies in touch is nothing.
#[test]
fn a_potential_of_the_spacing_sets_in_without_a_jump() {
    for (dimension, exponent) in [(1, 2), (1, 4), (2, 3), (3, 2), (3, 4), (3, 9)] {
        let bodies = vec![some_body(0, SPACING, 1.3), some_body(1, 0.8 * SPACING, 1.1)];
        let mut case = case_of(dimension, bodies);
        case.default_contact = ContactMode::Potential(Potential {
            exponent,
            range: PotentialRange::Spacing,
            ..Potential::default()
        });
        let modulus = case.materials[0].p_wave_modulus();
        let side = 0.9 * SPACING;
        let area = Kernel::new(dimension).power(side) / side;
        // Over the force of a spacing's face under the modulus.
        let at = |spacings: f64| {
            let particles = [(0, [0.0; 3]), (1, [spacings * side, 0.0, 0.0])];
            let mut world = World::new(case.clone(), &particles);
            let lists = world.lists();
            let forces = world.forces(&lists).0;
            let [first, second] = [0, 1].map(|i| forces[i].force[0] / (modulus * area));
            assert!((first + second).abs() <= 1e-14 * second.abs());
            (second, world.energy() / (modulus * area * side))
        };
        assert_eq!(at(1.0 + 1e-12), (0.0, 0.0));
        let touch = at(1.0 - 1e-12);
        assert!(
            (0.0..1e-8).contains(&touch.0) && touch.1.abs() < 1e-12,
            "{touch:?}"
        );
        let mut before = touch;
        for n in 1..16 {
            let nearer = at(1.0 - 0.05 * f64::from(n));
            assert!(nearer.1 > before.1, "energy falls at {n}: {nearer:?}");
            // Beyond, the slope of the kernel falls off towards its middle.
            if n < 6 {
                assert!(nearer.0 > before.0, "force falls at {n}: {nearer:?}");
            }
            assert!(nearer.0 > 0.0, "attracts at {n}: {nearer:?}");
            before = nearer;
        }
    }
}

/// Overlap of two strengths, a potential and nothing, all in one neighbourhood.
#[test]
fn mixed_modes_are_the_gradient_of_one_energy() {
    let bodies = vec![
        some_body(0, SPACING, 1.3),
        some_body(1, 0.9 * SPACING, 1.3),
        some_body(0, SPACING, 1.2),
        some_body(1, SPACING, 1.3),
    ];
    let mut case = case_of(3, bodies);
    let pair = |a, b, mode| ContactPair {
        bodies: [a, b],
        mode,
        joint: None,
    };
    case.contacts = vec![
        pair(1, 0, ContactMode::Potential(Potential::default())),
        pair(1, 2, ContactMode::None),
        pair(
            3,
            2,
            ContactMode::Overlap(Overlap {
                stiffness: 9.0,
                core_stiffness: 0.5,
                core_radius: 0.4,
                ..Overlap::default()
            }),
        ),
    ];
    let particles = blobs(&case, 3);
    let mut world = World::new(case, &particles);
    give_offsets(&mut world, 4);
    check_gradient(&mut world);
}

/// Two like bodies only ever push each other.
#[test]
fn pair_forces_of_two_like_bodies_repel() {
    for mode in [
        ContactMode::Overlap(Overlap::default()),
        ContactMode::Potential(Potential::default()),
    ] {
        let class = match mode {
            ContactMode::Overlap(_) => ContactClass::Overlap,
            _ => ContactClass::Potential,
        };
        for seed in 10..14 {
            let mut case = case_of(3, vec![some_body(0, SPACING, 1.3); 2]);
            case.default_contact = mode.clone();
            let particles = blobs(&case, seed);
            let mut world = World::new(case, &particles);
            give_offsets(&mut world, seed);
            let lists = world.lists();
            world.fractions(&lists);
            let mut pushed = 0;
            for i in 0..world.len() {
                for j in world.neighbours(i, class) {
                    let f = world.pair_force(i, j as usize, class);
                    let (x, y) = (world.motion[i].position, world.motion[j as usize].position);
                    let along: f64 = (0..3).map(|a| f[a] * (x[a] - y[a])).sum();
                    assert!(along >= 0.0);
                    pushed += usize::from(along > 0.0);
                }
            }
            assert!(pushed > 100);
        }
    }
}

/// Bodies joined by `kernel` contact, be it through a third, see each other in the SPH sums and
/// nowhere else.
#[test]
fn members_of_a_group_have_no_contact_apart_from_the_sums() {
    let mut case = case_of(3, vec![some_body(0, SPACING, 1.3); 4]);
    for pair in [[0, 2], [2, 1]] {
        case.contacts.push(ContactPair {
            bodies: pair,
            mode: ContactMode::Kernel,
            joint: None,
        });
    }
    let table = ContactTable::new(&case);
    assert_eq!(table.groups.of_body, [0, 0, 0, 1]);
    let pairs = (0..4).flat_map(|a| (a..4).map(move |b| [a, b]));
    let active = pairs.filter(|&[a, b]| table.between(a, b).is_some());
    assert_eq!(active.collect::<Vec<_>>(), [[0, 3], [1, 3], [2, 3]]);
    assert_eq!(table.foreign.ranges.between(0, 0), 0.0);
    assert!(table.foreign.ranges.between(0, 1) > 0.0);
}

/// A flat interface of two cubic lattices whose faces stand `gap` spacings apart, three layers
/// each, `side` particles wide.
fn flat_interface(side: usize, gap: f64, h: f64) -> World {
    let case = case_of(3, vec![some_body(0, SPACING, h); 2]);
    let mut particles = Vec::new();
    for b in 0..2_usize {
        for layer in 0..3 {
            for x in 0..side {
                for y in 0..side {
                    #[allow(clippy::cast_precision_loss, reason = "few particles")]
                    let [x, y] = [x as f64, y as f64];
                    let z = f64::from(layer) + 0.5 * gap;
                    let z = if b == 0 { z } else { -z };
                    particles.push((b, [x, y, z].map(|x| x * SPACING)));
                }
            }
        }
    }
    World::new(case, &particles)
}

/// Largest eigenvalue (1/s²) of the mass-weighted Hessian of the contact energy, by power
/// iteration on differences of forces.
fn largest_square_frequency(world: &mut World, lists: &Lists) -> f64 {
    let mut random = Random::new(1);
    let mut direction: Vec<[f64; 3]> = (0..world.len()).map(|_| random.vector(3, 1.0)).collect();
    let home: Vec<[f64; 3]> = world.motion.iter().map(|r| r.position).collect();
    let mass = world.particles.mass[0];
    let step = 1e-5 * SPACING;
    let mut value = 0.0;
    for _ in 0..40 {
        let length = direction
            .as_flattened()
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt();
        direction.iter_mut().flatten().for_each(|x| *x /= length);
        let mut force = [1.0, -1.0].map(|sign| {
            for (i, record) in world.motion.iter_mut().enumerate() {
                record.position =
                    std::array::from_fn(|a| home[i][a] + sign * step * direction[i][a]);
            }
            let forces = world.forces(lists).0;
            forces.iter().map(|f| f.force).collect::<Vec<_>>()
        });
        let [up, down] = &mut force;
        value = 0.0;
        for (i, d) in direction.iter_mut().enumerate() {
            for a in 0..3 {
                let next = (down[i][a] - up[i][a]) / (2.0 * step * mass);
                value += d[a] * next;
                d[a] = next;
            }
        }
    }
    for (record, home) in world.motion.iter_mut().zip(home) {
        record.position = home;
    }
    value
}

/// The stiffness that votes on the time step bounds the true one of two flat faces, and gives away
/// no more than a factor that grows to 4.5 in deep compression. The true limit at κ = 4 is near
/// h/c for faces just in touch, .65–.92 h/c when pressed together by a tenth or a quarter of Δp,
/// and half of h/c when the layers stand .6 Δp apart, where the core begins.
#[test]
fn the_stiffness_bounds_the_largest_eigenvalue() {
    // Gap in Δp, and the limits of 2/ω in h/c over h = 1.0–1.5 Δp as measured.
    let measured = [
        (0.999, 0.90..1.02),
        (0.9, 0.78..0.90),
        (0.75, 0.66..0.86),
        (0.6, 0.47..0.53),
        (0.4, 0.37..0.51),
    ];
    for h in [1.0, 1.2, 1.3, 1.5] {
        for (gap, limits) in &measured {
            let mut world = flat_interface(7, *gap, h);
            let lists = world.lists();
            if *gap > 0.99 {
                // All of the face, its edges too, is just in contact.
                for (i, f) in world.fractions(&lists).iter().enumerate() {
                    world.particles.touch_relief[i] = f.fraction - f.touching - 1e-4;
                }
            }
            let forces = world.forces(&lists).0;
            let stiffest = forces.iter().map(|f| f.stiffness).fold(0.0, f64::max);
            let truth = largest_square_frequency(&mut world, &lists);
            let bound = stiffest / world.particles.mass[0];
            let material = &world.case.materials[0];
            let c = (material.p_wave_modulus() / material.reference_density).sqrt();
            let limit = 2.0 / truth.sqrt() * c / (h * SPACING);
            println!(
                "h {h} gap {gap}: bound/true {:.3}, limit {limit:.3} h/c",
                bound / truth
            );
            assert!(truth <= bound && bound < 4.6 * truth, "h {h}, gap {gap}");
            assert!(limits.contains(&limit), "h {h}, gap {gap}: {limit} h/c");
        }
    }
}
