//! The pair sweeps against plain scalar sums, and the identities that the sums obey.
#![allow(clippy::float_cmp, reason = "what is exact is held exactly")]
#![allow(
    clippy::needless_range_loop,
    reason = "components of vectors and tensors"
)]
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

use crate::cloud::{Cloud, Found, small as cloud};
use crate::common::random::Random;
use numerics::dispatch::{Instructions, available};
use numerics::kernel::{ConstantScale, Kernel, MeanScale, PairScale};
use numerics::lanes::{F64x8, LANES};
use particles::neighbours::Chunk;
use particles::neighbours::MotionRecord;
use sums::gradient::VelocityGradient;
use sums::momentum::{Forces, Momentum, StressRecord, Viscosity};
use sums::neighbourhood::Sources;
use sums::terms::PairTerms;

const VISCOSITY: Viscosity = Viscosity {
    alpha: 1.3,
    beta: 2.1,
    negligible: 0.0,
};

/// The sums of one receiver, and the sums of the sizes of their terms.
#[derive(Default)]
struct Plain {
    gradient: [f64; 9],
    acceleration: [f64; 3],
    from_mirrors: [f64; 3],
    power: f64,
    approach: f64,
    gradient_size: f64,
    acceleration_size: f64,
    power_size: f64,
}

/// The formulas of the physics page, term by term, over every image of the receiver's group.
fn plain(cloud: &Cloud, found: &Found, records: &Records, kernel: &Kernel, i: u32) -> Plain {
    let mut sum = Plain::default();
    let here = &records.motion[i as usize];
    let state = &records.stress[i as usize];
    let images = found.sequence.images();
    let lengths = found.sequence.smoothing_lengths();
    let group = cloud.group(images[i as usize].slot());
    for j in found.sequence.group(group) {
        let there = &records.motion[j];
        let other = &records.stress[j];
        let r: [f64; 3] = std::array::from_fn(|a| here.position[a] - there.position[a]);
        let v: [f64; 3] = std::array::from_fn(|a| here.velocity[a] - there.velocity[a]);
        let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let distance = dot(&r, &r).sqrt();
        let h = 0.5 * (lengths[i as usize] + lengths[j]);
        if distance == 0.0 || distance >= 2.0 * h {
            continue;
        }
        let grad_w = r.map(|x| x / distance * kernel.slope(distance, h));
        let volume = there.volume;
        for a in 0..3 {
            for b in 0..3 {
                sum.gradient[3 * a + b] -= volume * v[a] * grad_w[b];
                sum.gradient_size += (volume * v[a] * grad_w[b]).abs();
            }
        }
        let mut pi = 0.0;
        if dot(&v, &r) < 0.0 {
            let mu = h * dot(&v, &r) / (distance * distance + 0.01 * h * h);
            let c = 0.5 * (state.viscous_speed + other.viscous_speed);
            let rho = 0.5 * (state.density + other.density);
            pi = (-VISCOSITY.alpha * c * mu + VISCOSITY.beta * mu * mu) / rho;
            sum.approach = sum.approach.max(-mu);
        }
        let s: [f64; 6] = std::array::from_fn(|c| {
            let both = state.stress_over_density2[c] + other.stress_over_density2[c];
            if c < 3 { both - pi } else { both }
        });
        let rows = [[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]];
        let force = rows.map(|row| there.mass * dot(&row, &grad_w));
        let size = rows.as_flattened().iter().map(|x| x.abs()).sum::<f64>()
            * there.mass
            * kernel.slope(distance, h).abs();
        for a in 0..3 {
            sum.acceleration[a] += force[a];
            if !images[j].mirror_mask().is_own() {
                sum.from_mirrors[a] += force[a];
            }
        }
        sum.power -= 0.5 * dot(&v, &force);
        sum.acceleration_size += size;
        sum.power_size += size * dot(&v, &v).sqrt();
    }
    sum
}

/// What the second sweep reads: the weights are masses.
struct Records {
    motion: Vec<MotionRecord>,
    lengths: Vec<f64>,
    stress: Vec<StressRecord>,
}

/// Records with random numbers of order one at the places of the images.
fn force_records(cloud: &Cloud, found: &Found, seed: u64) -> Records {
    let mut random = Random::new(seed);
    let own: Vec<([f64; 6], [f64; 3])> = (0..cloud.id.len())
        .map(|_| {
            let stress = std::array::from_fn(|_| random.within(-1.0, 1.0));
            (stress, std::array::from_fn(|_| random.within(0.5, 2.0)))
        })
        .collect();
    let (motion, stress) = (found.sequence.images().iter().zip(&found.motion))
        .map(|(image, motion)| {
            let (stress, [mass, density, sound_speed]) = own[image.slot()];
            let motion = MotionRecord { mass, ..*motion };
            let stress = StressRecord {
                density,
                viscous_speed: sound_speed,
                stress_over_density2: particles::Mirrors::reflect_symmetric(
                    &stress,
                    image.mirror_mask(),
                ),
            };
            (motion, stress)
        })
        .unzip();
    let lengths = found.sequence.smoothing_lengths().to_vec();
    Records {
        motion,
        lengths,
        stress,
    }
}

/// The images behind planes among neighbours.
fn mirrored(found: &Found, neighbours: &[u32]) -> Vec<u32> {
    let is_image = |&&j: &&u32| !found.sequence.images()[j as usize].mirror_mask().is_own();
    neighbours.iter().filter(is_image).copied().collect()
}

fn bits(forces: &Forces) -> Vec<u64> {
    let lanes = forces.acceleration.iter();
    lanes
        .chain([&forces.power, &forces.approach])
        .flat_map(|lane| lane.0.map(f64::to_bits))
        .collect()
}

fn gradient<S: PairScale>(
    set: Instructions,
    (sources, lengths): (&[MotionRecord], &[f64]),
    receivers: [u32; LANES],
    neighbours: &[u32],
    scale: S,
) -> [F64x8; 9] {
    set.run(VelocityGradient {
        around: Sources {
            records: sources,
            lengths,
            scale,
        }
        .around(receivers, neighbours),
    })
}

fn momentum<S: PairScale>(
    set: Instructions,
    records: &Records,
    receivers: [u32; LANES],
    neighbours: &[u32],
    scale: S,
) -> Forces {
    set.run(Momentum::<S, StressRecord, false> {
        around: Sources {
            records: &records.motion,
            lengths: &records.lengths,
            scale,
        }
        .around(receivers, neighbours),
        stresses: &records.stress,
        viscosity: VISCOSITY,
        terms: PairTerms::default(),
    })
}

/// `value` differs from `reference` by no more than rounding of terms whose sizes add up to
/// `size`: some tens of operations each, of 1.1e-16, where the kernel's slope loses up to two
/// digits to cancellation near the centre.
fn assert_close(value: f64, reference: f64, size: f64) {
    let error = (value - reference).abs();
    assert!(
        error <= 3e-14 * size,
        "{value} is not {reference}: {error:e} of {size:e}"
    );
}

/// Both sweeps over all clusters of a cloud: equal to the plain sums, equal bits for all
/// instruction sets, and no bit changed by neighbours outside every support.
fn check_sweeps<S: PairScale>(cloud: &Cloud, scale: S) {
    let kernel = Kernel::new(cloud.dimension);
    let found = cloud.find();
    let records = force_records(cloud, &found, 77);
    let motion = (&found.motion[..], found.sequence.smoothing_lengths());
    let sets = available();
    for (cluster, list, _) in found.clusters.chunks().iter().flat_map(Chunk::iter) {
        let receivers = cluster.receivers;
        let slow: Vec<Plain> = receivers[..cluster.lanes]
            .iter()
            .map(|&i| plain(cloud, &found, &records, &kernel, i))
            .collect();
        let first = gradient(sets[0], motion, receivers, list, scale);
        let forces = momentum(sets[0], &records, receivers, list, scale);
        let images = mirrored(&found, list);
        let from_mirrors = momentum(sets[0], &records, receivers, &images, scale).acceleration;
        for (k, slow) in slow.iter().enumerate() {
            for c in 0..9 {
                assert_close(first[c].0[k], slow.gradient[c], slow.gradient_size);
            }
            for a in 0..3 {
                let size = slow.acceleration_size;
                assert_close(forces.acceleration[a].0[k], slow.acceleration[a], size);
                assert_close(from_mirrors[a].0[k], slow.from_mirrors[a], size);
            }
            assert_close(forces.power.0[k], slow.power, slow.power_size);
            assert_close(forces.approach.0[k], slow.approach, slow.approach);
        }
        let everyone: Vec<u32> = found
            .sequence
            .group(cluster.group)
            .map(|place| u32::try_from(place).unwrap())
            .collect();
        for &set in &sets {
            for list in [list, &everyone] {
                let other = gradient(set, motion, receivers, list, scale);
                assert_eq!(
                    other.map(|l| l.0.map(f64::to_bits)),
                    first.map(|l| l.0.map(f64::to_bits))
                );
                let other = momentum(set, &records, receivers, list, scale);
                assert_eq!(bits(&other), bits(&forces), "{}", set.name());
            }
        }
    }
}

#[test]
fn sweeps_with_constant_h_agree_with_plain_sums() {
    for dimension in 1..=3 {
        for planes in [0, dimension] {
            let cloud = cloud(dimension, 1.0, planes, 41);
            let scale = ConstantScale::new(&Kernel::new(dimension), cloud.smoothing_length[0]);
            check_sweeps(&cloud, scale);
        }
    }
}

#[test]
fn sweeps_with_variable_h_agree_with_plain_sums() {
    for planes in [0, 1] {
        check_sweeps(&cloud(1, 1.8, planes, 42), MeanScale::new(&Kernel::new(1)));
        check_sweeps(&cloud(2, 1.8, planes, 43), MeanScale::new(&Kernel::new(2)));
        check_sweeps(&cloud(3, 1.8, planes, 44), MeanScale::new(&Kernel::new(3)));
    }
}

/// `Σ m a = 0` and `Σ m (de + v·a) = 0` to rounding: momentum and energy are conserved pair by
/// pair, viscosity included.
#[test]
fn momentum_and_energy_balance() {
    for spread in [1.0, 1.7] {
        let mut cloud = cloud(3, spread, 0, 45);
        cloud.owned = cloud.id.len();
        let found = cloud.find();
        let records = force_records(&cloud, &found, 78);
        let (mut force, mut power, mut size, mut power_size) = ([0.0; 3], 0.0, 0.0, 0.0);
        for (cluster, list, _) in found.clusters.chunks().iter().flat_map(Chunk::iter) {
            let scale = MeanScale::new(&Kernel::new(3));
            let sums = momentum(available()[0], &records, cluster.receivers, list, scale);
            for k in 0..cluster.lanes {
                let record = &records.motion[cluster.receivers[k] as usize];
                power += record.mass * sums.power.0[k];
                for a in 0..3 {
                    let f = record.mass * sums.acceleration[a].0[k];
                    force[a] += f;
                    power += record.velocity[a] * f;
                    size += f.abs();
                    power_size += (record.velocity[a] * f).abs();
                }
            }
        }
        // 260 particles with some 50 neighbours: errors add like a random walk.
        assert!(
            force.iter().all(|f| f.abs() < 1e-14 * size),
            "{force:?} of {size}"
        );
        assert!(
            power.abs() < 1e-14 * power_size,
            "{power:e} of {power_size}"
        );
    }
}

/// Inside a cubic lattice `−Σ V_j r_ij ⊗ ∇W_ij` is the unit tensor times a number near one, so a
/// linear velocity field gives its gradient times that number, and a rotation gives no strain.
#[test]
fn a_linear_velocity_field_gives_its_gradient() {
    let field = [0.3, -1.0, 0.2, 0.7, 0.1, -0.4, 0.5, -0.6, -0.2];
    // What the sum is on cubic lattices of spacing 1 at h = 1.3, in 1, 2 and 3 dimensions, from
    // the kernel's definition by another program.
    let factors = [
        1.022_373_166_205_665,
        1.010_542_957_253_393,
        0.993_483_699_944_107,
    ];
    for (dimension, factor) in (1..).zip(factors) {
        let kernel = Kernel::new(dimension);
        let mut sources = Vec::new();
        let reach = |a: usize| if a < dimension { -3..=3 } else { 0..=0 };
        for i in reach(0) {
            for j in reach(1) {
                for k in reach(2) {
                    let x = [i, j, k].map(f64::from);
                    sources.push(MotionRecord {
                        position: x,
                        velocity: std::array::from_fn(|a| {
                            (0..3).map(|b| field[3 * a + b] * x[b]).sum()
                        }),
                        volume: 1.0,
                        mass: 1.0,
                    });
                }
            }
        }
        let count = u32::try_from(sources.len()).unwrap();
        let neighbours: Vec<u32> = (0..count).collect();
        let scale = ConstantScale::new(&kernel, 1.3);
        let centre = [count / 2; LANES];
        let found = gradient(available()[0], (&sources, &[]), centre, &neighbours, scale);
        for c in 0..9 {
            let wanted = if c % 3 < dimension {
                field[c] * factor
            } else {
                0.0
            };
            assert!((found[c].0[0] - wanted).abs() < 2e-15, "{dimension}-D, {c}");
        }
    }
}

/// Two particles with stress.
fn pair(here: [f64; 3], there: [f64; 3]) -> Records {
    let velocities = [[1.0, 2.0, 3.0], [-7e3, 5.0, 0.0]];
    let motion = [here, there].into_iter().zip(velocities);
    let stress = StressRecord {
        density: 2700.0,
        viscous_speed: 6000.0,
        stress_over_density2: [1e3, -2e3, 1e3, 5e2, 4e2, 3e2],
    };
    Records {
        motion: motion
            .map(|(position, velocity)| MotionRecord {
                position,
                velocity,
                volume: 1e-15,
                mass: 2.7e-12,
            })
            .collect(),
        lengths: vec![1.3e-5; 2],
        stress: vec![stress; 2],
    }
}

/// Particles that meet only themselves, or another at the same point, feel nothing, and nothing
/// turns into NaN; particles almost at the same point feel something finite.
#[test]
fn lone_and_coincident_particles_are_harmless() {
    let here = [1e-3, 2e-3, -3e-3];
    for gap in [0.0, 5e-324, 1e-200, 1e-40, 1e-20] {
        let there = [here[0] + gap, here[1], here[2]];
        let force = pair(here, there);
        for set in available() {
            for neighbours in [&[0_u32][..], &[0, 1]] {
                let kernel = Kernel::new(3);
                let scale = MeanScale::new(&kernel);
                let receivers = [0, 1, 1, 1, 1, 1, 1, 1];
                let gradient = gradient(
                    set,
                    (&force.motion, &force.lengths),
                    receivers,
                    neighbours,
                    scale,
                );
                assert!(
                    gradient
                        .iter()
                        .all(|lanes| lanes.0.iter().all(|&x| x == 0.0))
                );
                let sums = momentum(set, &force, receivers, neighbours, scale);
                let all = sums.acceleration.iter();
                let all = all.chain([&sums.power, &sums.approach]);
                assert!(all.flat_map(|lanes| &lanes.0).all(|&x| x == 0.0));
            }
        }
    }
    // A tenth of a billionth of a spacing apart, at closing speed 7 km/s.
    let force = pair([0.0; 3], [1e-15, 0.0, 0.0]);
    let scale = MeanScale::new(&Kernel::new(3));
    let gradient = gradient(
        available()[0],
        (&force.motion, &force.lengths),
        [0; LANES],
        &[0, 1],
        scale,
    );
    assert!(gradient.iter().all(|lanes| lanes.0[0].is_finite()));
    let sums = momentum(available()[0], &force, [0; LANES], &[0, 1], scale);
    assert!(sums.acceleration.iter().all(|lanes| lanes.0[0].is_finite()));
    assert!(sums.power.0[0].is_finite() && sums.approach.0[0].is_finite());
}
