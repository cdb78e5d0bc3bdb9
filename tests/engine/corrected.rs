//! Corrected SPH: the sweeps against plain sums, and what any fade of the correction conserves.
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

use crate::cloud::{Cloud, small as cloud};
use crate::common::make_elastic;
use crate::common::random::Random;
use crate::common::virtual_ranks::on_each;
use crate::corrected_world::{Matrix, World};
use crate::linear_field::free_block;
use engine::diagnose::Worst;
use engine::step::Simulation;
use engine::step::measurements;
use model::{Axis, SphForm, Vec3};
use numerics::kernel::{ConstantScale, Kernel, MeanScale, PairScale};
use particles::Mirrors;

fn lane(values: &[numerics::lanes::F64x8; 6], k: usize) -> Matrix {
    let [xx, yy, zz, xy, xz, yz] = values.map(|v| v.0[k]);
    Matrix::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// `A` and `B` by their definition, of moments and of the one-sidedness of the neighbours.
fn fade(m: &Matrix, one_sided: f64) -> (Matrix, Matrix) {
    let share = f64::min(1.0, one_sided / 0.1);
    let e4 = share * 0.28_f64.powi(4) + (1.0 - share) * 0.15_f64.powi(4);
    let inverse = (m.pow(4) + Matrix::identity() * e4).try_inverse().unwrap() * (1.0 + e4);
    (inverse * m.pow(4), inverse * m.pow(3))
}

/// The spin W with `W M + M W` twice the antisymmetric part of `left`.
fn spin(m: &Matrix, left: &Matrix) -> Matrix {
    let axial = Vec3::new(
        left[(2, 1)] - left[(1, 2)],
        left[(0, 2)] - left[(2, 0)],
        left[(1, 0)] - left[(0, 1)],
    );
    let inertia = Matrix::identity() * m.trace() - m;
    let e4 = 0.05_f64.powi(4);
    let least = (inertia.pow(4) + Matrix::identity() * e4)
        .try_inverse()
        .unwrap();
    let inverse = least * inertia.pow(3) * (1.0 + e4);
    let mut turn = inverse * axial;
    for _ in 0..2 {
        turn += inverse * (axial - inertia * turn);
    }
    turn.cross_matrix()
}

fn check_sweeps<S: PairScale>(cloud: Cloud, scale: S) {
    let world = World::new(cloud, 91);
    world.rates(scale, 0, |places, corrected| {
        for (k, &place) in places.iter().enumerate() {
            let i = place as usize;
            let (a, b) = fade(&world.moment(i), world.one_sided(i));
            let found = [&corrected.correction.outer, &corrected.correction.inner];
            for (found, wanted) in found.into_iter().zip([a, b]) {
                // The condition of M⁴ + e⁴ I is 1/e⁴ at most.
                let error = (lane(found, k) - wanted).norm();
                assert!(error <= 1e-12 * (1.0 + wanted.norm()), "{error:e}");
            }
            let largest = b.symmetric_eigenvalues().amax();
            assert!(largest <= 0.57 / 0.15 * (1.0 + 0.15_f64.powi(4)));
            let (plain, size) = world.plain_gradient(i, |j| world.velocity(j));
            let strain = a * plain * b;
            let strain = 0.5 * (strain + strain.transpose());
            let m = world.moment(i);
            let spin = spin(&m, &(plain - strain * m));
            let wanted = strain + spin;
            // The spin of a neighbourhood in a row has a condition of 1/e.
            let bound = 1e-12 * (1.0 + size);
            for row in 0..3 {
                for column in 0..3 {
                    let error = corrected.gradient[3 * row + column].0[k] - wanted[(row, column)];
                    assert!(error.abs() <= 20.0 * bound, "{error:e} of {size:e}");
                }
            }
            let expected = spin + (plain - spin * m) * b;
            let wanted = world.rest(i, &expected);
            for axis in 0..3 {
                let error = corrected.rest[axis].0[k] - wanted[axis];
                assert!(error.abs() <= 60.0 * bound, "{error:e} of {size:e}");
            }
        }
    });
    world.rates(scale, 0xff, |places, corrected| {
        for (k, &place) in places.iter().enumerate() {
            let (plain, size) = world.plain_gradient(place as usize, |j| world.velocity(j));
            let error = corrected.gradient[0].0[k] - plain[(0, 0)];
            assert!(error.abs() <= 1e-13 * (1.0 + size), "{error:e} of {size:e}");
        }
    });
    let mut random = Random::new(7);
    let own: Vec<[f64; 9]> = (0..world.cloud.id.len())
        .map(|_| std::array::from_fn(|_| random.within(-1.0, 1.0)))
        .collect();
    let stress: Vec<Matrix> = (world.found.sequence.images().iter())
        .map(|image| {
            Matrix::from_row_slice(&Mirrors::reflect_tensor(
                &own[image.slot()],
                image.mirror_mask(),
            ))
        })
        .collect();
    world.forces(
        scale,
        &stress,
        &world.straight(),
        [0.0, 1.0],
        |k, i, forces| {
            let (mut sum, mut size) = (Vec3::zeros(), 0.0);
            for (j, _, g) in world.near(i) {
                let force = (stress[i] + stress[j]) * g * world.found.motion[j].volume;
                sum += force;
                size += force.norm();
            }
            for a in 0..3 {
                let error = forces.acceleration[a].0[k] - sum[a] / world.density[i];
                assert!(error.abs() <= 1e-13 * size / world.density[i], "{error:e}");
            }
            assert!(forces.power.0[k] == 0.0);
        },
    );
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

/// A symmetric matrix with the eigenvectors of M and random eigenvalues.
fn random_fade(m: &Matrix, random: &mut Random) -> Matrix {
    let eigen = m.symmetric_eigen();
    let values = Vec3::from(std::array::from_fn(|_| random.within(-0.5, 2.0)));
    eigen.eigenvectors * Matrix::from_diagonal(&values) * eigen.eigenvectors.transpose()
}

/// With any B that has M's eigenvectors, on clouds with lone particles and torn bodies: a rotation
/// strains nothing, and momentum, angular momentum and energy balance.
#[test]
fn any_fade_conserves() {
    for dimension in [2, 3] {
        let world = World::new(cloud(dimension, 1.0, 0, 61), 62);
        let scale = ConstantScale::new(&world.kernel, world.cloud.smoothing_length[0]);
        let mut random = Random::new(63);
        let n = world.found.motion.len();
        let corrections: Vec<[Matrix; 2]> = (0..n)
            .map(|i| {
                let m = world.moment(i);
                let b = random_fade(&m, &mut random);
                [m * b, b]
            })
            .collect();
        let spin = Vec3::new(0.0, 0.0, 1.0) + Vec3::from(random.vector(3, 0.5));
        let spin = if dimension == 2 { Vec3::z() } else { spin };
        let mut pair_stress = Vec::new();
        let mut power = Vec::new();
        for (i, [a, b]) in corrections.iter().enumerate() {
            let (rotation, size) = world.plain_gradient(i, |j| {
                spin.cross(&Vec3::from(world.found.motion[j].position))
            });
            let strain = a * rotation * b;
            let strain = (strain + strain.transpose()).norm();
            assert!(
                strain <= 1e-13 * (1.0 + size * a.norm() * b.norm()),
                "{strain:e}"
            );
            let (plain, _) = world.plain_gradient(i, |j| world.velocity(j));
            let volume = world.found.motion[i].volume;
            power.push(volume * world.sigma[i].dot(&(a * plain * b)));
            pair_stress.push(a * world.sigma[i] * b);
        }
        let (mut sums, mut sizes) = ([0.0; 7], [0.0; 7]);
        world.forces(
            scale,
            &pair_stress,
            &world.straight(),
            [0.0, 1.0],
            |k, i, forces| {
                let motion = &world.found.motion[i];
                let force = Vec3::from(forces.acceleration.map(|lanes| lanes.0[k])) * motion.mass;
                let turn = Vec3::from(motion.position).cross(&force);
                let work = Vec3::from(motion.velocity).dot(&force) + power[i];
                let mut terms: Vec<f64> = force.iter().chain(turn.iter()).copied().collect();
                terms.push(work);
                // What each pair does, of which most cancels.
                let (mut pull, mut rate) = (0.0, power[i].abs());
                for (j, _, g) in world.near(i) {
                    let volumes = motion.volume * world.found.motion[j].volume;
                    let of_pair = volumes * ((pair_stress[i] + pair_stress[j]) * g).norm();
                    pull += of_pair;
                    rate += of_pair * motion.velocity.iter().map(|v| v.abs()).sum::<f64>();
                }
                let arm = Vec3::from(motion.position).norm();
                for (n, term) in terms.into_iter().enumerate() {
                    sums[n] += term;
                    sizes[n] += [pull, pull * arm, rate][n / 3];
                }
            },
        );
        for (sum, size) in sums.into_iter().zip(sizes) {
            assert!(f64::abs(sum) <= 1e-13 * size, "{sums:?} of {sizes:?}");
        }
    }
}

/// Any hourglass displacements pull along pairs: momentum, angular momentum and energy balance.
#[test]
fn hourglass_control_balances() {
    for dimension in [2, 3] {
        let world = World::new(cloud(dimension, 1.0, 0, 81), 82);
        let scale = ConstantScale::new(&world.kernel, world.cloud.smoothing_length[0]);
        let none = vec![Matrix::zeros(); world.found.motion.len()];
        let mut random = Random::new(83);
        let bent: Vec<Vec3> = (none.iter())
            .map(|_| Vec3::from(random.vector(dimension, 1.0)))
            .collect();
        let (mut sums, mut sizes) = ([0.0; 7], [0.0; 7]);
        world.forces(scale, &none, &bent, [0.0, 1.0], |k, i, forces| {
            let motion = &world.found.motion[i];
            let force = Vec3::from(forces.acceleration.map(|lanes| lanes.0[k])) * motion.mass;
            let turn = Vec3::from(motion.position).cross(&force);
            let heat = forces.power.0[k] * motion.mass;
            let work = Vec3::from(motion.velocity).dot(&force) + heat;
            let (mut wanted, mut pull, mut rate) = (Vec3::zeros(), 0.0, heat.abs());
            for (j, r, g) in world.near(i) {
                let other = &world.found.motion[j];
                let stress = (bent[j] - bent[i]).dot(&r) / r.norm_squared();
                let of_pair = g * (stress * motion.volume * other.volume);
                wanted += of_pair;
                pull += of_pair.norm();
                rate += of_pair.norm() * (world.velocity(i).norm() + world.velocity(j).norm());
            }
            assert!((force - wanted).norm() <= 1e-13 * pull);
            let arm = Vec3::from(motion.position).norm();
            let terms = force.iter().chain(turn.iter()).copied().chain([work]);
            for (n, term) in terms.enumerate() {
                sums[n] += term;
                sizes[n] += [pull, pull * arm, rate][n / 3];
            }
        });
        for (sum, size) in sums.into_iter().zip(sizes) {
            assert!(f64::abs(sum) <= 1e-13 * size, "{sums:?} of {sizes:?}");
        }
    }
}

/// A torn cloud that turns as a whole: it strains nothing, it is seen to turn by the share
/// `I − (I − S)³` with `S = (1 + e⁴) (J⁴ + e⁴ I)⁻¹ J⁴` of the inertia J of the neighbours, 2e-16 from one
/// inside, and what that leaves is all that neighbours move beyond what is expected.
#[test]
fn a_turn_is_seen_whole() {
    for dimension in [2, 3] {
        let mut cloud = cloud(dimension, 1.0, 0, 85);
        let omega = Vec3::new(0.4, -0.7, 1.1);
        let omega = if dimension == 2 { Vec3::z() } else { omega };
        for (velocity, position) in cloud.velocity.iter_mut().zip(&cloud.position) {
            // What has flown away has no neighbour.
            let near = position.iter().all(|x| x.abs() < 20.0);
            let turned = omega.cross(&Vec3::from(*position));
            *velocity = if near { turned.into() } else { [0.0; 3] };
        }
        let world = World::new(cloud, 86);
        let scale = ConstantScale::new(&world.kernel, world.cloud.smoothing_length[0]);
        let (mut seen, mut farthest) = (0, 0.0_f64);
        world.rates(scale, 0, |places, corrected| {
            for (k, &place) in places.iter().enumerate() {
                let m = world.moment(place as usize);
                let inertia = Matrix::identity() * m.trace() - m;
                let found = Matrix::from_row_slice(&corrected.gradient.map(|lanes| lanes.0[k]));
                let bound = 1e-12 * (1.0 + m.norm());
                assert!((found + found.transpose()).norm() <= bound);
                let least = inertia.symmetric_eigenvalues().min();
                if world.near(place as usize).len() < 3 || least < 0.2 {
                    continue;
                }
                seen += 1;
                let e4 = 0.05_f64.powi(4);
                let fourth = inertia.pow(4);
                let share = (fourth + Matrix::identity() * e4).try_inverse().unwrap();
                let left = Matrix::identity() - share * fourth * (1.0 + e4);
                let turn = omega - left * left * left * omega;
                assert!((found - turn.cross_matrix()).norm() <= bound);
                let off = (turn - omega).norm();
                farthest = farthest.max(off);
                let most = e4 * least.powi(-4).max(1.0);
                assert!(off <= omega.norm() * (most.powi(3) + 1e-15));
                for axis in 0..3 {
                    let rest = corrected.rest[axis].0[k].abs();
                    let reach = 2.0 * world.cloud.smoothing_length[0];
                    assert!(rest <= bound + 2.0 * off * reach, "{rest:e} {off:e}");
                }
            }
        });
        println!("{dimension}-D: {seen} particles, farthest from the turn {farthest:e}");
        assert!(seen > 50);
    }
}

/// Artificial viscosity keeps momentum and angular momentum, and what it takes from the motion
/// becomes heat.
#[test]
fn viscosity_balances() {
    let world = World::new(cloud(3, 1.0, 0, 71), 72);
    let scale = ConstantScale::new(&world.kernel, world.cloud.smoothing_length[0]);
    let none = vec![Matrix::zeros(); world.found.motion.len()];
    let (mut sums, mut sizes) = ([0.0; 7], [0.0; 7]);
    world.forces(
        scale,
        &none,
        &world.straight(),
        [1.0, 1.0],
        |k, i, forces| {
            let motion = &world.found.motion[i];
            let force = Vec3::from(forces.acceleration.map(|lanes| lanes.0[k])) * motion.mass;
            let turn = Vec3::from(motion.position).cross(&force);
            let heat = forces.power.0[k] * motion.mass;
            assert!(heat >= 0.0);
            let work = Vec3::from(motion.velocity).dot(&force) + heat;
            let terms = force.iter().chain(turn.iter()).copied().chain([work]);
            for (n, term) in terms.enumerate() {
                sums[n] += term;
                sizes[n] += term.abs();
            }
        },
    );
    for (sum, size) in sums.into_iter().zip(sizes) {
        assert!(f64::abs(sum) <= 1e-12 * size, "{sums:?} of {sizes:?}");
    }
}

/// Pairs without a speed of the artificial viscosity and without stress exert nothing, however fast they approach.
#[test]
fn dust_passes_dust() {
    let world = World::new(cloud(3, 1.0, 0, 71), 72);
    let scale = ConstantScale::new(&world.kernel, world.cloud.smoothing_length[0]);
    let none = vec![Matrix::zeros(); world.found.motion.len()];
    world.forces(
        scale,
        &none,
        &world.straight(),
        [1.0, 0.0],
        |k, _, forces| {
            assert_eq!(forces.acceleration.map(|lanes| lanes.0[k]), [0.0; 3]);
            assert_eq!(forces.power.0[k], 0.0);
        },
    );
}

/// A block that turns, flies and hits: with gravity, a load, a symmetry plane and a rigid plane, whatever
/// there is of angular momentum is explained by what acts from outside.
#[test]
fn angular_momentum_is_explained() {
    on_each(&[1, 2], |comm| {
        for (dimension, mirrors, loads) in [
            (2, &[][..], false),
            (3, &[][..], false),
            (2, &[Axis::X][..], true),
            (3, &[Axis::X, Axis::Y][..], true),
            (2, &[Axis::X][..], false),
            (3, &[Axis::X, Axis::Y][..], false),
        ] {
            let (mut case, field) = free_block(dimension, mirrors, SphForm::Corrected);
            make_elastic(&mut case);
            if loads {
                case.loads.gravity = [0.0, -1e7, 0.0];
            }
            let mut simulation = Simulation::start(case, comm).unwrap();
            let particles = &mut simulation.particles;
            for i in 0..particles.owned() {
                let turned = field * Vec3::from(particles.position[i]);
                // Shaken too, so that the planes have something to do.
                let mut random = Random::new(particles.id[i] + 1);
                let shaken = random.vector(dimension, 1e-4 * field.norm());
                particles.velocity[i] = (turned + Vec3::from(shaken)).into();
            }
            let before = simulation.state.angular_impulse;
            measurements::diagnose(&mut simulation, comm);
            simulation.state.initial = simulation.state.totals;
            simulation.state.angular_momentum_scale = Some(1e-300);
            simulation.state.worst = Worst::default();
            assert_eq!(before, [0.0; 3]);
            for _ in 0..50 {
                simulation.advance(comm).unwrap();
            }
            measurements::diagnose(&mut simulation, comm);
            let state = &simulation.state;
            let scale = (state.totals.angular_momentum.iter())
                .chain(&state.angular_impulse)
                .fold(0.0_f64, |most, x| most.max(x.abs()));
            let off = state.worst.angular_momentum_deviation;
            println!("{dimension}-D {mirrors:?} {loads}: {off:?} of {scale:e}");
            assert!(scale > 0.0);
            assert!(
                off.iter().all(|&x| x <= 1e-12 * scale),
                "{off:?} of {scale:e}"
            );
        }
    });
}
