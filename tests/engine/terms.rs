//! The options of the pair sums against plain scalar sums, and what they conserve.
#![allow(clippy::needless_range_loop, reason = "components of vectors")]

use crate::cloud::{Cloud, Found, small as cloud};
use crate::common::random::Random;
use model::TermOptions;
use numerics::dispatch::{Instructions, available};
use numerics::kernel::{ConstantScale, Kernel, MeanScale, PairScale};
use numerics::lanes::LANES;
use particles::neighbours::Chunk;
use particles::neighbours::MotionRecord;
use particles::{Mirrors, Owner};
use sums::momentum::{Forces, Momentum, StressRecord, Viscosity};
use sums::neighbourhood::Sources;
use sums::terms::artificial_stress::repulsion;
use sums::terms::balsara::limiter;
use sums::terms::{PairTerms, TermRecord};

const VISCOSITY: Viscosity = Viscosity {
    alpha: 1.3,
    beta: 2.1,
    negligible: 0.0,
};
/// Particle spacing over smoothing length.
const RATIO: f64 = 0.8;
const CONDUCTIVITY: f64 = 0.7;
const EPSILON: f64 = 0.4;
/// The terms of which particles show something.
const RECORDED: Owner = Owner::ARTIFICIAL_STRESS
    .union(Owner::BALSARA)
    .union(Owner::CONDUCTION);
const ALL: Owner = RECORDED.union(Owner::XSPH);

/// What the sums read: numbers of order one, the same for all images of a particle.
struct Records {
    motion: Vec<MotionRecord>,
    lengths: Vec<f64>,
    stress: Vec<StressRecord>,
    options: Vec<TermRecord>,
    inverse_shape: f64,
}

impl Records {
    fn new(cloud: &Cloud, found: &Found, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut six = || -> [f64; 6] { std::array::from_fn(|_| random.within(-1.0, 1.0)) };
        let tensors: Vec<_> = cloud.id.iter().map(|_| (six(), six())).collect();
        let numbers: Vec<[f64; 5]> = (cloud.id.iter())
            .map(|_| std::array::from_fn(|_| random.within(0.5, 2.0)))
            .collect();
        let kernel = Kernel::new(cloud.dimension);
        let mut records = Self {
            motion: Vec::new(),
            lengths: found.sequence.smoothing_lengths().to_vec(),
            stress: Vec::new(),
            options: Vec::new(),
            inverse_shape: kernel.normalisation() / kernel.value(RATIO, 1.0),
        };
        for (image, motion) in found.sequence.images().iter().zip(&found.motion) {
            let (stress, repulsion) = tensors[image.slot()];
            let [mass, density, sound_speed, limiter, energy] = numbers[image.slot()];
            records.motion.push(MotionRecord { mass, ..*motion });
            records.stress.push(StressRecord {
                density,
                viscous_speed: sound_speed,
                stress_over_density2: Mirrors::reflect_symmetric(&stress, image.mirror_mask()),
            });
            records.options.push(TermRecord {
                repulsion: Mirrors::reflect_symmetric(&repulsion, image.mirror_mask()),
                half_limiter: 0.25 * limiter,
                specific_energy: energy,
            });
        }
        records
    }

    fn sums<S: PairScale, const TERMS: bool>(
        &self,
        terms: Owner,
        set: Instructions,
        receivers: [u32; LANES],
        neighbours: &[u32],
        scale: S,
    ) -> Forces {
        set.run(Momentum::<S, StressRecord, TERMS> {
            around: Sources {
                records: &self.motion,
                lengths: &self.lengths,
                scale,
            }
            .around(receivers, neighbours),
            stresses: &self.stress,
            viscosity: VISCOSITY,
            terms: PairTerms {
                set: terms,
                records: &self.options,
                inverse_shape: self.inverse_shape,
                options: TermOptions {
                    conduction: CONDUCTIVITY,
                    xsph: EPSILON,
                    ..TermOptions::default()
                },
            },
        })
    }
}

/// The sums of one receiver, and the sums of the sizes of their terms.
#[derive(Default)]
struct Plain {
    acceleration: [f64; 3],
    power: f64,
    correction: [f64; 3],
    sizes: [f64; 3],
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The formulas of the theory page, term by term, over every image of the receiver's group.
fn plain(
    records: &Records,
    group: std::ops::Range<usize>,
    kernel: &Kernel,
    i: usize,
    options: Owner,
) -> Plain {
    let on = |option| f64::from(u8::from(options.contains(option)));
    let (here, state, own) = (&records.motion[i], &records.stress[i], &records.options[i]);
    let mut sum = Plain::default();
    for j in group {
        let (there, other, its) = (&records.motion[j], &records.stress[j], &records.options[j]);
        let r: [f64; 3] = std::array::from_fn(|a| here.position[a] - there.position[a]);
        let v: [f64; 3] = std::array::from_fn(|a| here.velocity[a] - there.velocity[a]);
        let distance = dot(&r, &r).sqrt();
        let h = 0.5 * (records.lengths[i] + records.lengths[j]);
        if distance == 0.0 || distance >= 2.0 * h {
            continue;
        }
        let slope = kernel.slope(distance, h);
        let grad_w = r.map(|x| x / distance * slope);
        let density = 0.5 * (state.density + other.density);
        let (mut pi, mut speed) = (0.0, 0.0);
        if dot(&v, &r) < 0.0 {
            let mu = h * dot(&v, &r) / (distance * distance + 0.01 * h * h);
            let c = 0.5 * (state.viscous_speed + other.viscous_speed);
            let limit = if options.contains(Owner::BALSARA) {
                own.half_limiter + its.half_limiter
            } else {
                1.0
            };
            speed = limit * (VISCOSITY.alpha * c - VISCOSITY.beta * mu);
            pi = -mu * speed / density;
        }
        // W(r)/W(Δp), with the spacing of a lattice of this smoothing length.
        let f = kernel.value(distance, h) / kernel.value(RATIO * h, h);
        let s: [f64; 6] = std::array::from_fn(|c| {
            let stress = state.stress_over_density2[c] + other.stress_over_density2[c];
            let extra =
                on(Owner::ARTIFICIAL_STRESS) * (own.repulsion[c] + its.repulsion[c]) * f.powi(4);
            stress + extra - if c < 3 { pi } else { 0.0 }
        });
        let rows = [[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]];
        let force = rows.map(|row| there.mass * dot(&row, &grad_w));
        let heat = on(Owner::CONDUCTION) * CONDUCTIVITY * there.mass * speed / density
            * slope
            * (own.specific_energy - its.specific_energy);
        sum.power += heat - 0.5 * dot(&v, &force);
        let share = on(Owner::XSPH) * EPSILON * there.mass / density * kernel.value(distance, h);
        let size =
            rows.as_flattened().iter().map(|x| x.abs()).sum::<f64>() * there.mass * slope.abs();
        for a in 0..3 {
            sum.acceleration[a] += force[a];
            sum.correction[a] -= share * v[a];
        }
        sum.sizes[0] += size;
        sum.sizes[1] += size * dot(&v, &v).sqrt() + heat.abs();
        sum.sizes[2] += share * dot(&v, &v).sqrt();
    }
    sum
}

fn bits(forces: &Forces) -> Vec<u64> {
    let vectors = [forces.acceleration, forces.correction];
    let lanes = vectors.as_flattened().iter();
    lanes
        .chain([&forces.power, &forces.approach])
        .flat_map(|lane| lane.0.map(f64::to_bits))
        .collect()
}

/// The sums of a set of options over all clusters of a cloud: equal to the plain sums, and equal
/// bits for all instruction sets.
fn check<S: PairScale>(terms: Owner, cloud: &Cloud, scale: S) {
    let kernel = Kernel::new(cloud.dimension);
    let found = cloud.find();
    let records = Records::new(cloud, &found, 77);
    let sets = available();
    for (cluster, list, _) in found.clusters.chunks().iter().flat_map(Chunk::iter) {
        let sums = records.sums::<S, true>(terms, sets[0], cluster.receivers, list, scale);
        for k in 0..cluster.lanes {
            let group = found.sequence.group(cluster.group);
            let slow = plain(
                &records,
                group,
                &kernel,
                cluster.receivers[k] as usize,
                terms,
            );
            // As in `engine_sph`: some tens of roundings a term.
            let close = |value: f64, reference: f64, size: f64| {
                let error = (value - reference).abs();
                assert!(
                    error <= 3e-14 * size,
                    "{terms:?}: {value} is not {reference}"
                );
            };
            for a in 0..3 {
                close(
                    sums.acceleration[a].0[k],
                    slow.acceleration[a],
                    slow.sizes[0],
                );
                close(sums.correction[a].0[k], slow.correction[a], slow.sizes[2]);
            }
            close(sums.power.0[k], slow.power, slow.sizes[1]);
        }
        for &set in &sets {
            let other = records.sums::<S, true>(terms, set, cluster.receivers, list, scale);
            assert_eq!(bits(&other), bits(&sums), "{}", set.name());
        }
    }
}

#[test]
fn options_agree_with_plain_sums() {
    for planes in [0, 1] {
        let constant = cloud(3, 1.0, planes, 41);
        let scale = ConstantScale::new(&Kernel::new(3), constant.smoothing_length[0]);
        check(Owner::ARTIFICIAL_STRESS, &constant, scale);
        check(Owner::BALSARA, &constant, scale);
        check(Owner::CONDUCTION, &constant, scale);
        check(Owner::XSPH, &constant, scale);
        check(ALL, &constant, scale);
        check(
            ALL,
            &cloud(1, 1.8, planes, 42),
            MeanScale::new(&Kernel::new(1)),
        );
        check(
            ALL,
            &cloud(2, 1.8, planes, 43),
            MeanScale::new(&Kernel::new(2)),
        );
        check(
            ALL,
            &cloud(3, 1.8, planes, 44),
            MeanScale::new(&Kernel::new(3)),
        );
    }
}

/// Pair terms that are off change no bit of plain sums, whatever particles show; those that are on with neutral data
/// change none either.
#[test]
fn terms_that_are_off_or_neutral_change_no_bit() {
    let cloud = cloud(3, 1.0, 1, 46);
    let found = cloud.find();
    let mut records = Records::new(&cloud, &found, 79);
    let scale = ConstantScale::new(&Kernel::new(3), cloud.smoothing_length[0]);
    let all = |records: &Records,
               sums: fn(&Records, [u32; LANES], &[u32], ConstantScale) -> Forces| {
        let clusters = found.clusters.chunks().iter().flat_map(Chunk::iter);
        clusters
            .flat_map(|(cluster, list, _)| bits(&sums(records, cluster.receivers, list, scale)))
            .collect::<Vec<_>>()
    };
    let plain = all(&records, |records, receivers, list, scale| {
        records.sums::<_, false>(Owner::empty(), available()[0], receivers, list, scale)
    });
    let off = all(&records, |records, receivers, list, scale| {
        records.sums::<_, true>(Owner::empty(), available()[0], receivers, list, scale)
    });
    assert_eq!(off, plain);
    records.options.fill(TermRecord::NEUTRAL);
    let neutral = all(&records, |records, receivers, list, scale| {
        records.sums::<_, true>(RECORDED, available()[0], receivers, list, scale)
    });
    assert_eq!(neutral, plain);
}

#[test]
fn a_number_of_dimensions_means_the_same_known_early_or_late() {
    let cloud = cloud(3, 1.7, 1, 47);
    let found = cloud.find();
    let records = Records::new(&cloud, &found, 80);
    let kernel = Kernel::new(3);
    let (early, late) = (MeanScale::new(&kernel), MeanScale::new(&kernel));
    for (cluster, list, _) in found.clusters.chunks().iter().flat_map(Chunk::iter) {
        for set in available() {
            let early = records.sums::<_, true>(ALL, set, cluster.receivers, list, early);
            let late = records.sums::<_, true>(ALL, set, cluster.receivers, list, late);
            assert_eq!(bits(&early), bits(&late));
        }
    }
}

/// With all options `Σ m a`, `Σ m (de + v·a)`, and of the drift of XSPH `Σ m δ` and
/// `Σ m δ × v`, are zero to rounding.
#[test]
fn pairs_conserve_momentum_and_energy() {
    let mut cloud = cloud(3, 1.7, 0, 45);
    cloud.owned = cloud.id.len();
    let found = cloud.find();
    let records = Records::new(&cloud, &found, 78);
    let scale = MeanScale::new(&Kernel::new(3));
    // Force, drift, turn of the drift, power; and their sizes.
    let (mut sums, mut sizes) = ([0.0; 10], [0.0; 10]);
    for (cluster, list, _) in found.clusters.chunks().iter().flat_map(Chunk::iter) {
        let all = records.sums::<_, true>(ALL, available()[0], cluster.receivers, list, scale);
        for k in 0..cluster.lanes {
            let MotionRecord {
                mass, velocity: v, ..
            } = records.motion[cluster.receivers[k] as usize];
            let a = all.acceleration.map(|lanes| lanes.0[k]);
            let d = all.correction.map(|lanes| lanes.0[k]);
            let turn = [
                d[1] * v[2] - d[2] * v[1],
                d[2] * v[0] - d[0] * v[2],
                d[0] * v[1] - d[1] * v[0],
            ];
            let power = all.power.0[k] + dot(&v, &a);
            let terms = [a, d, turn].into_iter().flatten().chain([power]);
            for (n, term) in terms.enumerate() {
                sums[n] += mass * term;
                sizes[n] += (mass * term).abs();
            }
        }
    }
    for (sum, size) in sums.into_iter().zip(sizes) {
        assert!(sum.abs() < 1e-14 * size, "{sum:e} of {size}");
    }
}

#[test]
fn artificial_stress_pushes_along_tension_alone() {
    let deviatoric = [3e8, -1e8, -2e8, 0.0, 0.0, 0.0];
    // Stresses 4, 0 and −1 times 1e8.
    let pushed = repulsion(0.3, -1e8, &deviatoric, 1000.0);
    assert_eq!(pushed, [-0.3 * 4e8 / 1e6, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(repulsion(0.3, 4e8, &deviatoric, 1000.0), [0.0; 6]);
}

#[test]
fn the_balsara_switch_knows_compression_from_shear() {
    let (c, h) = (5000.0, 1e-3);
    let compression = [-1e6, 0.0, 0.0, 0.0, -1e6, 0.0, 0.0, 0.0, -1e6];
    let shear = [0.0, 1e6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert!((limiter(&compression, c, h) - 1.0).abs() < 2e-4);
    assert_eq!(limiter(&shear, c, h), 0.0);
    assert_eq!(limiter(&[0.0; 9], c, h), 0.0);
}
