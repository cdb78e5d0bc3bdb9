//! Normalised SPH: the sweeps against plain scalar sums, linear fields, and what forces conserve.
#![allow(clippy::float_cmp, reason = "what is exact is held exactly")]
#![allow(
    clippy::needless_range_loop,
    reason = "components of vectors and tensors"
)]
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

use crate::cloud::{Cloud, Found, small as cloud};
use crate::common::outcome::{advance, start};
use crate::common::random::Random;
use crate::common::virtual_ranks::on_each;
use crate::common::{ball, body, case, make_elastic};
use crate::linear_field::free_block;
use comm::Comm;
use engine::step::Simulation;
use model::{Axis, ContactDirection, ContactMode, Overlap, Potential, Shape, SphForm, Vec3};
use nalgebra::Matrix3;
use numerics::dispatch::available;
use numerics::kernel::{ConstantScale, Kernel, MeanScale, PairScale};
use numerics::lanes::LANES;
use particles::Mirrors;
use particles::neighbours::Chunk;
use sums::momentum::{Forces, Momentum, Viscosity};
use sums::neighbourhood::Sources;
use sums::normalised::{
    Corrected, Correction, LARGEST_CORRECTION, NormalisedGradient, NormalisedRecord, stress_power,
};
use sums::terms::PairTerms;

/// A cloud with all that the sums read.
struct World {
    cloud: Cloud,
    found: Found,
    kernel: Kernel,
    /// By place.
    stress: Vec<([f64; 6], f64, f64)>,
}

impl World {
    fn new(mut cloud: Cloud, seed: u64) -> Self {
        cloud.owned = cloud.id.len();
        let mut found = cloud.find();
        let mut random = Random::new(seed);
        let own: Vec<([f64; 6], [f64; 3])> = (0..cloud.id.len())
            .map(|_| {
                let stress = std::array::from_fn(|_| random.within(-1.0, 1.0));
                (stress, std::array::from_fn(|_| random.within(0.5, 2.0)))
            })
            .collect();
        let mut stress = Vec::new();
        for (image, motion) in found.sequence.images().iter().zip(&mut found.motion) {
            let (tensor, [mass, density, sound_speed]) = own[image.slot()];
            (motion.mass, motion.volume) = (mass, mass / density);
            let tensor = Mirrors::reflect_symmetric(&tensor, image.mirror_mask());
            stress.push((tensor, density, sound_speed));
        }
        Self {
            kernel: Kernel::new(cloud.dimension),
            cloud,
            found,
            stress,
        }
    }

    fn distance(&self, i: usize, j: usize) -> (Vec3, f64, f64) {
        let at = |k: usize| Vec3::from(self.found.motion[k].position);
        let lengths = self.found.sequence.smoothing_lengths();
        let r = at(i) - at(j);
        (r, r.norm(), 0.5 * (lengths[i] + lengths[j]))
    }

    /// The neighbours of a place with `V W` and `V ∇W`.
    fn near(&self, i: usize) -> Vec<(usize, f64, Vec3)> {
        let group = self.cloud.group(self.found.sequence.images()[i].slot());
        let mut near = Vec::new();
        for j in self.found.sequence.group(group) {
            let (r, distance, h) = self.distance(i, j);
            if distance >= 2.0 * h {
                continue;
            }
            let volume = self.found.motion[j].volume;
            let slope = if i == j {
                Vec3::zeros()
            } else {
                r * (self.kernel.slope(distance, h) / distance)
            };
            near.push((j, volume * self.kernel.value(distance, h), slope * volume));
        }
        near
    }

    /// `B`, `γ`, and the norm, from the definitions: the gradient of `W/s` and its moments.
    fn correction(&self, i: usize) -> (Matrix3<f64>, Vec3, f64) {
        let near = self.near(i);
        let s: f64 = near.iter().map(|n| n.1).sum();
        let gamma: Vec3 = near.iter().map(|n| n.2).sum::<Vec3>() / s;
        let d = self.cloud.dimension;
        let mut moment = Matrix3::zeros();
        for (j, w, g) in &near {
            let normalised = (g - gamma * *w) / s;
            moment += -self.distance(i, *j).0 * normalised.transpose();
        }
        for a in d..3 {
            moment[(a, a)] = 1.0;
        }
        let inverse = moment.try_inverse().unwrap_or(Matrix3::zeros());
        #[allow(clippy::cast_precision_loss, reason = "at most 3")]
        let norm = inverse.view((0, 0), (d, d)).norm() / (d as f64).sqrt();
        if norm > 0.0 && norm <= LARGEST_CORRECTION && moment.determinant() > 0.0 {
            let mut matrix = inverse / s;
            for a in d..3 {
                matrix[(a, a)] = 1.0;
            }
            (matrix, gamma, norm)
        } else {
            (Matrix3::identity(), Vec3::zeros(), 0.0)
        }
    }

    fn run<S: PairScale>(&self, scale: S, mut check: impl FnMut(&[u32], &Corrected)) {
        let sets = available();
        let chunks = self.found.clusters.chunks();
        for (cluster, list, _) in chunks.iter().flat_map(Chunk::iter) {
            let all: Vec<Corrected> = sets
                .iter()
                .map(|set| {
                    set.run(NormalisedGradient {
                        around: Sources {
                            records: &self.found.motion,
                            lengths: self.found.sequence.smoothing_lengths(),
                            scale,
                        }
                        .around(cluster.receivers, list),
                        dimension: self.cloud.dimension,
                    })
                })
                .collect();
            for other in &all {
                assert_eq!(other.gradient, all[0].gradient);
                assert_eq!(other.corrections, all[0].corrections);
            }
            check(&cluster.receivers[..cluster.lanes], &all[0]);
        }
    }

    /// Corrections by place, from the fast sweep.
    fn corrections<S: PairScale>(&self, scale: S) -> Vec<Correction> {
        let images = self.found.sequence.images();
        let mut own = vec![Correction::NONE; self.cloud.id.len()];
        self.run(scale, |places, corrected| {
            for (k, &place) in places.iter().enumerate() {
                own[images[place as usize].slot()] = corrected.corrections[k];
            }
        });
        let reflected = |image: &particles::Image| {
            let c = &own[image.slot()];
            Correction {
                matrix: Mirrors::reflect_tensor(&c.matrix, image.mirror_mask()),
                shift: Mirrors::reflect_vector(&c.shift, image.mirror_mask()),
                norm: c.norm,
            }
        };
        images.iter().map(reflected).collect()
    }

    /// Forces of all clusters with these corrections, without viscosity, the same bits by all
    /// instruction sets.
    fn forces<S: PairScale>(
        &self,
        scale: S,
        corrections: &[Correction],
        mut visit: impl FnMut(&[u32], &Forces),
    ) {
        let stresses: Vec<_> = self
            .stress
            .iter()
            .zip(corrections)
            .map(|((tensor, density, c), correction)| {
                let Correction { matrix, shift, .. } = correction;
                NormalisedRecord::new((0.0, tensor), matrix, shift, [*density, *c])
            })
            .collect();
        let chunks = self.found.clusters.chunks();
        for (cluster, list, _) in chunks.iter().flat_map(Chunk::iter) {
            let sums = |set: numerics::dispatch::Instructions| {
                set.run(Momentum::<S, NormalisedRecord, false> {
                    around: Sources {
                        records: &self.found.motion,
                        lengths: self.found.sequence.smoothing_lengths(),
                        scale,
                    }
                    .around(cluster.receivers, list),
                    stresses: &stresses,
                    viscosity: Viscosity {
                        alpha: 0.0,
                        beta: 0.0,
                        negligible: 0.0,
                    },
                    terms: PairTerms::default(),
                })
            };
            let first = sums(available()[0]);
            for set in available() {
                assert_eq!(sums(set).acceleration, first.acceleration, "{}", set.name());
            }
            visit(&cluster.receivers[..cluster.lanes], &first);
        }
    }
}

fn check_sweeps<S: PairScale>(cloud: Cloud, scale: S) {
    let world = World::new(cloud, 91);
    let mut counts = [0; 2];
    world.run(scale, |places, corrected| {
        for (k, &place) in places.iter().enumerate() {
            let i = place as usize;
            let (b, gamma, norm) = world.correction(i);
            let found = &corrected.corrections[k];
            // Rounding of tens of terms of order one, enlarged by the inversion.
            let bound = 1e-13 * (1.0 + norm) * (1.0 + norm);
            counts[usize::from(norm > 0.0)] += 1;
            assert!((found.norm - norm).abs() <= bound * (1.0 + norm));
            let scale = b.norm();
            for a in 0..3 {
                assert!((found.shift[a] - gamma[a]).abs() <= bound * (1.0 + gamma.norm()));
                for c in 0..3 {
                    let error = (found.matrix[3 * a + c] - b[(a, c)]).abs();
                    assert!(error <= bound * scale, "{error:e} of {scale:e} at {norm}");
                }
            }
            let mut gradient = Matrix3::zeros();
            let mut size = 0.0;
            let own = Vec3::from(world.found.motion[i].velocity);
            for (j, w, g) in world.near(i) {
                let v = Vec3::from(world.found.motion[j].velocity) - own;
                let corrected = b.transpose() * (g - gamma * w);
                gradient += v * corrected.transpose();
                size += v.norm() * b.norm() * (g.norm() + gamma.norm() * w);
            }
            for a in 0..3 {
                for c in 0..world.cloud.dimension {
                    let error = corrected.gradient[3 * a + c].0[k] - gradient[(a, c)];
                    assert!(error.abs() <= bound * size, "{error:e} of {size:e}");
                }
            }
        }
    });
    assert!(counts.iter().all(|&n| n > 0), "{counts:?}");
    let corrections = world.corrections(scale);
    world.forces(scale, &corrections, |places, forces| {
        for (k, &place) in places.iter().enumerate() {
            let i = place as usize;
            let tensor = |j: usize| {
                let [xx, yy, zz, xy, xz, yz] = world.stress[j].0;
                Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
            };
            let pull = |j: usize, w: f64, g: Vec3| {
                let c = &corrections[j];
                let b = Matrix3::from_row_slice(&c.matrix);
                tensor(j) * (b.transpose() * (g - Vec3::from(c.shift) * w))
            };
            let (mut sum, mut size) = (Vec3::zeros(), 0.0);
            for (j, w, g) in world.near(i) {
                // `V_j` stands in w and g.
                let (mine, others) = (pull(i, w, g), pull(j, w, -g));
                sum += mine - others;
                size += mine.norm() + others.norm();
            }
            let specific = world.found.motion[i].volume / world.found.motion[i].mass;
            for a in 0..3 {
                let error = forces.acceleration[a].0[k] - sum[a] * specific;
                assert!(
                    error.abs() <= 1e-13 * size * specific,
                    "{error:e} of {size:e}"
                );
            }
            assert_eq!(forces.power.0[k], 0.0);
        }
    });
}

#[test]
fn sweeps_agree_with_plain_sums() {
    for dimension in 1..=3 {
        for planes in [0, dimension] {
            let cloud = cloud(dimension, 1.0, planes, 51);
            let scale = ConstantScale::new(&Kernel::new(dimension), cloud.smoothing_length[0]);
            check_sweeps(cloud, scale);
        }
    }
    check_sweeps(cloud(1, 1.8, 1, 52), MeanScale::new(&Kernel::new(1)));
    check_sweeps(cloud(2, 1.8, 1, 53), MeanScale::new(&Kernel::new(2)));
    check_sweeps(cloud(3, 1.8, 1, 54), MeanScale::new(&Kernel::new(3)));
}

/// `Σ m a`, `Σ m (σ:L/ρ + v·a)` and, where every gradient is corrected, `Σ x × m a` are zero to
/// rounding, whatever the stresses.
#[test]
fn forces_conserve_momentum_energy_and_angular_momentum() {
    let mut recipe = cloud(3, 1.0, 0, 55);
    // One body in order enough that all its gradients are corrected.
    let mut random = Random::new(56);
    let edge = 6;
    recipe.id = (0..edge * edge * edge).collect();
    let n = recipe.id.len();
    recipe.body = vec![0; n];
    recipe.smoothing_length = vec![1.3; n];
    recipe.velocity = (0..n).map(|_| random.vector(3, 1.0)).collect();
    #[allow(clippy::cast_precision_loss, reason = "few")]
    let site = |k: u64| [k % edge, k / edge % edge, k / edge / edge].map(|x| x as f64);
    recipe.position = recipe
        .id
        .iter()
        .map(|&k| site(k).map(|x| x + random.within(-0.25, 0.25)))
        .collect();
    let world = World::new(recipe, 57);
    let scale = ConstantScale::new(&world.kernel, 1.3);
    let corrections = world.corrections(scale);
    assert!(corrections.iter().all(|c| c.norm > 0.0));
    let mut gradients = vec![[0.0; 9]; n];
    world.run(scale, |places, corrected| {
        for (k, &place) in places.iter().enumerate() {
            gradients[place as usize] = corrected.gradient.map(|lanes| lanes.0[k]);
        }
    });
    let (mut sums, mut sizes) = ([0.0; 7], [0.0; 7]);
    world.forces(scale, &corrections, |places, forces| {
        for (k, &place) in places.iter().enumerate() {
            let i = place as usize;
            let motion = &world.found.motion[i];
            let force = Vec3::from(forces.acceleration.map(|lanes| lanes.0[k])) * motion.mass;
            let turn = Vec3::from(motion.position).cross(&force);
            let (tensor, density, _) = &world.stress[i];
            let heat = stress_power(0.0, tensor, &gradients[i], *density) * motion.mass;
            let work = Vec3::from(motion.velocity).dot(&force);
            let terms = [
                force[0],
                force[1],
                force[2],
                turn[0],
                turn[1],
                turn[2],
                heat + work,
            ];
            for (n, term) in terms.into_iter().enumerate() {
                sums[n] += term;
                sizes[n] += term.abs();
            }
        }
    });
    for (sum, size) in sums.into_iter().zip(sizes) {
        assert!(sum.abs() < 1e-13 * size, "{sums:?} of {sizes:?}");
    }
}

/// Moves the particles off their lattice, each by its id, and gives them the field's velocities.
fn stir(simulation: &mut Simulation, field: &Matrix3<f64>) {
    let particles = &mut simulation.particles;
    for i in 0..particles.owned() {
        let mut random = Random::new(particles.id[i] + 1);
        let jitter = random.vector(simulation.case.dimension, 0.3e-4);
        for a in 0..3 {
            particles.position[i][a] += jitter[a];
        }
        particles.velocity[i] = (field * Vec3::from(particles.position[i])).into();
    }
}

/// The gradient of what moves as a linear field stays exact to 1e-12 while a block turns and
/// stretches: with free surfaces, behind mirrors, in each dimension, on one rank and on two.
#[test]
fn linear_fields_are_exact_at_free_surfaces() {
    on_each(&[1, 2], |comm| {
        for (dimension, mirrors) in [
            (1, &[][..]),
            (2, &[]),
            (3, &[]),
            (2, &[Axis::X]),
            (3, &[Axis::X, Axis::Y]),
        ] {
            check_linear(comm, dimension, mirrors);
        }
    });
}

fn check_linear(comm: &Comm, dimension: usize, mirrors: &[Axis]) {
    let (case, field) = free_block(dimension, mirrors, SphForm::Normalised);
    let mut simulation = Simulation::start(case, comm).unwrap();
    assert_eq!(simulation.state.uncorrected, 0);
    stir(&mut simulation, &field);
    let mut largest = 0.0_f64;
    for _ in 0..12 {
        simulation.advance(comm).unwrap();
        let motion = Matrix3::identity() + field * simulation.state.time;
        let wanted = field * motion.try_inverse().unwrap();
        let particles = &simulation.particles;
        for i in 0..particles.owned() {
            for c in 0..9 {
                let error = particles.velocity_gradient[i][c] - wanted[(c / 3, c % 3)];
                largest = largest.max(error.abs() / field.norm());
            }
        }
    }
    assert_eq!(simulation.state.worst.uncorrected, 0);
    assert!(
        largest <= 1e-12,
        "{dimension}-D {mirrors:?}: {largest:e} of the field"
    );
    println!("{dimension}-D {mirrors:?}: {largest:e}");
}

/// A sheet one layer thick in three dimensions has no gradient across itself: the gradient of all
/// its particles is left as conventional sums give it, and so many are counted.
#[test]
fn flat_clouds_keep_the_plain_gradient() {
    let shape = Shape::Box {
        lower: Vec3::new(0.0, 0.0, 0.0),
        upper: Vec3::new(10e-4, 10e-4, 1e-4),
    };
    let mut sheet = case(3, vec![body("sheet", shape, 1e-4, Vec3::zeros())], 1.0);
    make_elastic(&mut sheet);
    sheet.sph.form = SphForm::Conventional;
    let mut plain = start(sheet.clone());
    sheet.sph.form = SphForm::Normalised;
    let mut corrected = start(sheet);
    for simulation in [&mut plain, &mut corrected] {
        let particles = &mut simulation.particles;
        for i in 0..particles.owned() {
            let [x, y, _] = particles.position[i];
            particles.velocity[i] = [1e5 * x * x, 3e4 * y, 5e4 * x];
        }
        simulation.advance(&Comm::solo()).unwrap();
    }
    let count = i64::try_from(corrected.particles.owned()).unwrap();
    assert_eq!((count, corrected.state.uncorrected), (100, 100));
    assert_eq!(plain.state.uncorrected, 0);
    for (a, b) in plain
        .particles
        .velocity_gradient
        .iter()
        .zip(&corrected.particles.velocity_gradient)
    {
        for c in 0..9 {
            assert!((a[c] - b[c]).abs() < 1e-9, "{} {}", a[c], b[c]);
        }
    }
}

/// Lanes of a cluster beyond its particles change nothing.
#[test]
fn receivers_without_neighbours_have_no_gradient() {
    let sources = [World::new(cloud(3, 1.0, 0, 58), 59).found.motion[0]];
    let none = available()[0].run(NormalisedGradient {
        around: Sources {
            records: &sources,
            lengths: &[],
            scale: ConstantScale::new(&Kernel::new(3), 1.0),
        }
        .around([0; LANES], &[]),
        dimension: 3,
    });
    assert_eq!(none.gradient, Corrected::NONE.gradient);
}

/// Contact along normals keeps momentum, and pushes; an energy it has only along pairs.
#[test]
fn contact_along_normals_keeps_momentum() {
    let overlap = |direction| {
        ContactMode::Overlap(Overlap {
            direction,
            ..Overlap::default()
        })
    };
    let potential = |direction| {
        ContactMode::Potential(Potential {
            direction,
            ..Potential::default()
        })
    };
    let modes: [(&str, &dyn Fn(ContactDirection) -> ContactMode); 2] =
        [("overlap", &overlap), ("potential", &potential)];
    for (name, mode) in modes {
        let [pair, normal] = [ContactDirection::Pair, ContactDirection::Normal].map(|direction| {
            let bodies = vec![
                ball("lower", -4.0, 4.0, 200.0),
                ball("upper", 4.0, 4.0, -200.0),
            ];
            let mut case = case(3, bodies, 1.0);
            make_elastic(&mut case);
            case.sph.form = SphForm::Normalised;
            case.default_contact = mode(direction);
            let mut simulation = start(case);
            advance(&mut simulation, 150);
            simulation.state
        });
        for state in [&pair, &normal] {
            let error = state.worst.momentum_error;
            assert!(error.iter().all(|&e| e < 1e-13), "{error:?}");
            // They have met and come apart.
            assert!(state.pairs[0].impulse[2] < 0.0);
        }
        println!(
            "{name}: contact defect {:.2e} along pairs, {:.2e} along normals; energy error {:.2e}, \
             {:.2e}; impulse {:e}, {:e}",
            pair.worst.contact_defect,
            normal.worst.contact_defect,
            pair.worst.energy_error,
            normal.worst.energy_error,
            pair.pairs[0].impulse[2],
            normal.pairs[0].impulse[2],
        );
    }
}
