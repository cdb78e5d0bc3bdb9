//! Contact forces against the numerical gradient of an energy that is written down again here,
//! and what contact promises about them.
#![allow(clippy::float_cmp, reason = "what is exact is held exactly")]
#![allow(
    clippy::needless_range_loop,
    reason = "components of vectors and tensors"
)]
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

mod common;

use common::random::Random;
use common::{body, case, sphere_on_plate};
use whipple::comm::Comm;
use whipple::contact::overlap::{self, RELIEF_LIMIT, relief};
use whipple::contact::{ContactTable, ContactView, Reaction, potential};
use whipple::material::library;
use whipple::model::{
    Axis, Body, Case, ContactMode, ContactPair, LatticeKind, Overlap, Potential, PotentialRange,
    Shape, Vec3,
};
use whipple::neighbours::{ContactClass, Image};
use whipple::particles::ParticleStore;
use whipple::populate;
use whipple::sph::gradient::MotionRecord;
use whipple::sph::kernel::Kernel;
use whipple::step::Simulation;

const SPACING: f64 = 1e-5;

/// Particles of the bodies of a case anywhere in space.
struct World {
    case: Case,
    table: ContactTable,
    /// Touching value of each ordered pair of bodies.
    touching: Vec<f64>,
    store: ParticleStore,
    images: Vec<Image>,
    motion: Vec<MotionRecord>,
}

/// The foreign neighbours of each particle, for `overlap` and for `potential`.
type Lists = [Vec<Vec<u32>>; 2];

/// A body whose shape does not matter.
fn some_body(material: usize, spacing: f64, h: f64) -> Body {
    let shape = Shape::Box {
        lower: Vec3::zeros(),
        upper: Vec3::repeat(10.0 * spacing),
    };
    Body {
        material,
        smoothing_length: h * spacing,
        ..body("body", shape, spacing, Vec3::zeros())
    }
}

/// Aluminium and copper.
fn case_of(dimension: usize, bodies: Vec<Body>) -> Case {
    let mut case = case(dimension, bodies, 1.0);
    case.materials.push(library::find("copper").unwrap());
    case
}

impl World {
    fn new(case: Case, particles: &[(usize, [f64; 3])]) -> Self {
        let mut store = ParticleStore::default();
        store.resize_owned(particles.len());
        let mut motion = Vec::new();
        for (i, &(b, position)) in particles.iter().enumerate() {
            let body = &case.bodies[b];
            let volume = populate::particle_volume(body, case.dimension);
            store.id[i] = i as u64;
            store.body[i] = u32::try_from(b).unwrap();
            store.mass[i] = volume * case.materials[body.material].reference_density;
            store.position[i] = position;
            motion.push(MotionRecord {
                position,
                velocity: [0.0; 3],
                volume,
                smoothing_length: body.smoothing_length,
            });
        }
        let touching = case
            .bodies
            .iter()
            .flat_map(|a| case.bodies.iter().map(move |b| (a, b)))
            .map(|(a, b)| populate::touching_value(a, b, case.dimension))
            .collect();
        Self {
            table: ContactTable::new(&case),
            touching,
            images: (0..particles.len()).map(|i| Image::new(i, 0)).collect(),
            case,
            store,
            motion,
        }
    }

    fn len(&self) -> usize {
        self.motion.len()
    }

    fn view(&self) -> ContactView<'_> {
        ContactView {
            images: &self.images,
            motion: &self.motion,
            store: &self.store,
            table: &self.table,
        }
    }

    fn bodies(&self, i: usize, j: usize) -> (usize, usize) {
        (self.store.body[i] as usize, self.store.body[j] as usize)
    }

    fn distance(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (self.motion[i].position, self.motion[j].position);
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    }

    /// Foreign neighbours of a receiver in one algorithm, by brute force.
    fn neighbours(&self, i: usize, class: ContactClass) -> Vec<u32> {
        (0..self.len())
            .filter(|&j| {
                let (a, b) = self.bodies(i, j);
                let pair = a * self.case.bodies.len() + b;
                self.table.foreign.class[pair] == class
                    && self.distance(i, j).powi(2) < self.table.foreign.reach2[pair]
            })
            .map(|j| u32::try_from(j).unwrap())
            .collect()
    }

    fn lists(&self) -> Lists {
        [ContactClass::Overlap, ContactClass::Potential]
            .map(|class| (0..self.len()).map(|i| self.neighbours(i, class)).collect())
    }

    /// Fractions of all particles into the store, as the step does.
    fn fractions(&mut self, [overlap, _]: &Lists) -> Vec<overlap::Fraction> {
        let all: Vec<_> = (0_u32..)
            .zip(overlap)
            .map(|(place, list)| {
                let relief = self.store.touch_relief[place as usize];
                overlap::fraction(&self.view(), place, list, relief)
            })
            .collect();
        for (i, fraction) in all.iter().enumerate() {
            self.store.foreign_fraction[i] = fraction.fraction;
            self.store.contact_excess[i] = fraction.excess;
            self.store.contact_modulus[i] = fraction.modulus;
            self.store.touching_value[i] = fraction.touching;
            self.store.contact_slope[i] = fraction.slope;
        }
        all
    }

    fn react(&self, i: usize, overlap: &[u32], potential: &[u32]) -> Reaction {
        let mut reaction = Reaction::default();
        reaction.clear();
        let place = u32::try_from(i).unwrap();
        overlap::react(&self.view(), place, overlap, &mut reaction);
        potential::react(&self.view(), place, potential, &mut reaction);
        reaction
    }

    /// Reactions of all particles at their positions.
    fn reactions(&mut self, lists: &Lists) -> Vec<Reaction> {
        self.fractions(lists);
        (0..self.len())
            .map(|i| self.react(i, &lists[0][i], &lists[1][i]))
            .collect()
    }

    /// What particle j alone does to particle i, after [`Self::fractions`].
    fn pair_force(&self, i: usize, j: usize, class: ContactClass) -> [f64; 3] {
        let j = [u32::try_from(j).unwrap()];
        match class {
            ContactClass::Overlap => self.react(i, &j, &[]).force,
            _ => self.react(i, &[], &j).force,
        }
    }

    fn volume(&self, i: usize) -> f64 {
        populate::particle_volume(
            &self.case.bodies[self.store.body[i] as usize],
            self.case.dimension,
        )
    }

    /// The contact energy by the formulas of the physics page, section 5, from the case alone.
    fn energy(&self) -> f64 {
        let kernel = Kernel::new(self.case.dimension);
        let mut energy = 0.0;
        for i in 0..self.len() {
            let (mut s, mut sm, mut sc) = (0.0, 0.0, 0.0);
            for j in (0..self.len()).filter(|&j| self.bodies(i, j).0 != self.bodies(i, j).1) {
                let (a, b) = self.bodies(i, j);
                let touching = self.touching[a * self.case.bodies.len() + b];
                let mode = self.case.contact_between(a, b);
                let (a, b) = (&self.case.bodies[a], &self.case.bodies[b]);
                let modulus = [a, b]
                    .map(|body| self.case.materials[body.material].p_wave_modulus())
                    .into_iter()
                    .fold(f64::INFINITY, f64::min);
                let h = 0.5 * (a.smoothing_length + b.smoothing_length);
                let spacing = 0.5 * (a.lattice.spacing + b.lattice.spacing);
                let r = self.distance(i, j);
                let weight = self.volume(j) * kernel.value(r, h);
                match mode {
                    ContactMode::Overlap(overlap) => {
                        s += weight;
                        sm += weight * overlap.stiffness * modulus;
                        sc += weight * touching;
                        let depth = (1.0 - r / (overlap.core_radius * spacing)).max(0.0);
                        let mean = 0.5 * (self.volume(i) + self.volume(j));
                        // Each pair is met twice.
                        energy += 0.25 * overlap.core_stiffness * modulus * mean * depth * depth;
                    }
                    ContactMode::Potential(potential) => {
                        let dimension = i32::try_from(self.case.dimension).unwrap();
                        let k = potential.stiffness * modulus / spacing.powi(dimension);
                        let n = i32::try_from(potential.exponent).unwrap();
                        let ratio = kernel.value(r, h) / kernel.value(spacing, h);
                        let (range, floor) = match potential.range {
                            PotentialRange::Support => (2.0 * h, 0.0),
                            PotentialRange::Spacing => (spacing, 1.0),
                        };
                        if r < range {
                            energy +=
                                0.5 * self.volume(i) * self.volume(j) * k * (ratio.powi(n) - floor);
                        }
                    }
                    ContactMode::None | ContactMode::Kernel => {}
                }
            }
            if s > 0.0 {
                let excess = (s - sc / s - self.store.touch_relief[i]).max(0.0);
                energy += 0.5 * (sm / s) * self.volume(i) * excess * excess;
            }
        }
        energy
    }

    fn shift(&mut self, i: usize, axis: usize, by: f64) {
        self.store.position[i][axis] += by;
        self.motion[i].position[axis] += by;
    }
}

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
    let reactions = world.reactions(&lists);
    let energy = world.energy();
    let ledger: f64 = reactions.iter().map(|r| r.energy).sum();
    assert!(energy > 0.0);
    assert!(
        (ledger - energy).abs() < 1e-13 * energy,
        "{ledger} is not {energy}"
    );
    let by_body: f64 = reactions
        .iter()
        .flat_map(|r| &r.by_body)
        .map(|b| b.energy)
        .sum();
    assert!((by_body - energy).abs() < 1e-13 * energy);

    let largest = reactions
        .iter()
        .flat_map(|r| r.force)
        .fold(0.0, |most: f64, f| most.max(f.abs()));
    let step = 1e-6 * SPACING;
    for (i, reaction) in reactions.iter().enumerate() {
        for axis in 0..world.case.dimension {
            world.shift(i, axis, step);
            let up = world.energy();
            world.shift(i, axis, -2.0 * step);
            let down = world.energy();
            world.shift(i, axis, step);
            let slope = (up - down) / (2.0 * step);
            // Rounding of the energy by 1e-15 over the step, and the step squared.
            let bound = 1e-9 * energy / SPACING + 1e-7 * largest;
            let error = (slope + reaction.force[axis]).abs();
            assert!(
                error < bound,
                "{slope} against {}: {error:e}",
                reaction.force[axis]
            );
        }
        for axis in world.case.dimension..3 {
            assert_eq!(reaction.force[axis], 0.0);
        }
    }
    let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
    for (reaction, record) in reactions.iter().zip(&world.motion) {
        let (f, x) = (reaction.force, record.position);
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

/// Random relief for the particles of a world, small enough to leave some excess.
fn give_relief(world: &mut World, seed: u64) {
    let mut random = Random::new(seed);
    for relief in &mut world.store.touch_relief {
        *relief = random.within(-0.1, 0.1).max(0.0);
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
                give_relief(&mut world, seed);
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
            });
            let particles = blobs(&case, 7);
            let mut world = World::new(case, &particles);
            check_gradient(&mut world);
            check_pairs(&mut world, ContactClass::Potential);
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
            }),
        ),
    ];
    let particles = blobs(&case, 3);
    let mut world = World::new(case, &particles);
    give_relief(&mut world, 4);
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
            give_relief(&mut world, seed);
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
        });
    }
    let table = ContactTable::new(&case);
    assert_eq!(table.groups, [0, 0, 0, 1]);
    assert_eq!(table.active_pairs(), [[0, 3], [1, 3], [2, 3]]);
    assert_eq!(table.foreign.group_range[0], 0.0);
    assert!(table.foreign.group_range[1] > 0.0);
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
    let mass = world.store.mass[0];
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
            world
                .reactions(lists)
                .iter()
                .map(|r| r.force)
                .collect::<Vec<_>>()
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
        (0.6, 0.49..0.53),
        (0.4, 0.38..0.51),
    ];
    for h in [1.0, 1.2, 1.3, 1.5] {
        for (gap, limits) in &measured {
            let mut world = flat_interface(7, *gap, h);
            let lists = world.lists();
            if *gap > 0.99 {
                // All of the face, its edges too, is just in contact.
                for (i, f) in world.fractions(&lists).iter().enumerate() {
                    world.store.touch_relief[i] = f.fraction - f.touching - 1e-4;
                }
            }
            let stiffest = world
                .reactions(&lists)
                .iter()
                .map(|r| r.stiffness)
                .fold(0.0, f64::max);
            let truth = largest_square_frequency(&mut world, &lists);
            let bound = stiffest / world.store.mass[0];
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

fn start(case: Case) -> Simulation {
    Simulation::start(case, &Comm::solo()).unwrap()
}

fn check_at_rest(name: &str, simulation: &Simulation) {
    assert_eq!(simulation.state.capped_reliefs, 0, "{name}");
    let store = &simulation.store;
    assert!(store.foreign_fraction.iter().any(|&f| f > 0.1), "{name}");
    assert!(
        store.contact_acceleration.iter().all(|a| *a == [0.0; 3]),
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
            .store
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
    match &mut case.bodies[0].shape {
        Shape::Box { lower, upper } => {
            lower[axis.index()] += way;
            upper[axis.index()] += way;
        }
        Shape::Sphere { centre, .. } | Shape::Cylinder { centre, .. } => {
            centre[axis.index()] += way;
        }
    }
}

/// A body laid into another is not forgiven beyond the limit; the particles are counted.
#[test]
fn relief_is_capped_and_counted() {
    let fraction = |s: f64| overlap::Fraction {
        fraction: s,
        touching: 0.23,
        ..Default::default()
    };
    assert_eq!(relief(&fraction(0.2)), (0.0, false));
    assert_eq!(relief(&fraction(0.3)), (0.3 - 0.23, false));
    assert_eq!(relief(&fraction(0.5)), (RELIEF_LIMIT - 0.23, true));

    let slab = block([0.0, 0.0, -6.0], [10.0, 10.0, 0.0], 1.0);
    let sunk = block([2.0, 2.0, -3.5], [8.0, 8.0, 4.5], 1.0);
    let simulation = start(case(3, vec![slab, sunk], 1.0));
    let store = &simulation.store;
    let mut capped = 0;
    for i in 0..store.owned() {
        let level = store.touching_value[i] + store.touch_relief[i];
        assert!(level <= RELIEF_LIMIT + 1e-15);
        let beyond = store.foreign_fraction[i] > RELIEF_LIMIT;
        capped += i64::from(beyond);
        assert_eq!(store.contact_excess[i] > 0.0, beyond);
    }
    assert!(capped > 20);
    assert_eq!(simulation.state.capped_reliefs, capped);
    assert!(simulation.state.contact_energy > 0.0);
}
