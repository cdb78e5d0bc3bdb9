//! `make bench-kernels`: the inner loops alone, on a block of slightly disordered particles with
//! some 75 neighbours each. Throughput counts particles; all on one thread.

mod scene;

use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use engine::contact::{ContactTable, TaskForces, overlap};
use material::{Material, PointBatch};
use model::ContactClass;
use numerics::dispatch::{Instructions, Vectorised, available};
use numerics::exact_sum::ExactSum;
use numerics::kernel::{ConstantScale, Kernel};
use numerics::lanes::{LANES, Lanes};
use particles::neighbours::ForeignLists;
use scene::{COUNT, DENSITY, LENGTH, Scene, case, noise};
use sums::corrected::{CorrectedGradient, CorrectedRecord};
use sums::gradient::VelocityGradient;
use sums::momentum::{Momentum, PairStress, StressRecord, Viscosity};
use sums::neighbourhood::{Neighbourhood, Sources};
use sums::terms::PairTerms;

/// A group whose throughput counts so many elements.
fn group<'a>(
    criterion: &'a mut Criterion,
    name: &str,
    count: usize,
) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Elements(count as u64));
    group.sample_size(10);
    group.warm_up_time(Duration::from_millis(500));
    group.measurement_time(Duration::from_secs(2));
    group
}

/// Times what `work` makes of each cluster of a block, for each instruction set.
fn sweep(
    criterion: &mut Criterion,
    name: &str,
    work: impl Fn(Instructions, Neighbourhood<ConstantScale>),
) {
    let scene = Scene::new(1);
    let sources = Sources {
        records: &scene.motion,
        lengths: scene.sequence.smoothing_lengths(),
        scale: ConstantScale::new(&Kernel::new(3), LENGTH),
    };
    let mut group = group(criterion, name, COUNT);
    for set in available() {
        group.bench_function(set.name(), |bencher| {
            bencher.iter(|| {
                scene.sweep(|receivers, neighbours| {
                    work(set, sources.around(receivers, neighbours));
                });
            });
        });
    }
}

/// The first sweep, in the corrected form and the conventional one.
fn velocity_gradient(criterion: &mut Criterion) {
    sweep(criterion, "corrected_gradient", |set, around| {
        black_box(set.run(CorrectedGradient {
            around,
            dimension: 3,
            plain: 0,
        }));
    });
    sweep(criterion, "velocity_gradient", |set, around| {
        black_box(set.run(VelocityGradient { around }));
    });
}

/// The second sweep, in the corrected form and the conventional one.
fn momentum(criterion: &mut Criterion) {
    let deviatoric = [1e8, 0.0, -1e8, 1e8, 2e8, 3e8];
    let stress = [1.1e9, 1e8, 2e8, 1e8, 1e9, 3e8, 2e8, 3e8, 0.9e9];
    let corrected = CorrectedRecord::new(&stress, &[1e-9; 3], 0.1, [DENSITY, 5328.0, 1.0, 1.0]);
    momentum_of(criterion, "corrected_momentum", corrected);
    let conventional = StressRecord::new(1e9, &deviatoric, DENSITY, 5328.0);
    momentum_of(criterion, "momentum_and_energy", conventional);
}

fn momentum_of<R: PairStress>(criterion: &mut Criterion, name: &str, record: R) {
    let stresses = vec![record; COUNT];
    let viscosity = Viscosity {
        alpha: 1.0,
        beta: 2.0,
        negligible: 0.0,
    };
    sweep(criterion, name, |set, around| {
        black_box(set.run(Momentum::<_, R, false> {
            around,
            stresses: &stresses,
            viscosity,
            terms: PairTerms::default(),
        }));
    });
}

fn search(criterion: &mut Criterion) {
    let mut scene = Scene::new(1);
    let mut group = group(criterion, "search", COUNT);
    group.bench_function("sort", |bencher| bencher.iter(|| scene.sort()));
    group.bench_function("lists", |bencher| bencher.iter(|| scene.list()));
    let scene = Scene::new(2);
    let (table, mut foreign) = (ContactTable::new(&case()), ForeignLists::default());
    group.bench_function("foreign", |bencher| {
        bencher.iter(|| scene.list_foreign(&table, &mut foreign));
    });
}

/// Throughput counts the particles within reach of the other half.
fn contact(criterion: &mut Criterion) {
    let mut scene = Scene::new(2);
    let (table, mut foreign) = (ContactTable::new(&case()), ForeignLists::default());
    scene.list_foreign(&table, &mut foreign);
    let pairs = || {
        foreign
            .chunks()
            .iter()
            .flat_map(|chunk| chunk.of(ContactClass::Overlap).iter())
    };
    let mut group = group(criterion, "contact", pairs().count());
    group.bench_function("fractions", |bencher| {
        let view = scene.contact(&table);
        bencher.iter(|| {
            for (index, neighbours) in pairs() {
                black_box(overlap::fraction(&view, index, neighbours, 0.0));
            }
        });
    });
    for (index, neighbours) in pairs() {
        let fraction = overlap::fraction(&scene.contact(&table), index, neighbours, 0.0);
        let i = scene.sequence.images()[index as usize].slot();
        scene.particles.foreign_fraction[i] = fraction.fraction;
        scene.particles.contact_excess[i] = fraction.excess;
        scene.particles.contact_modulus[i] = fraction.modulus;
        scene.particles.touching_value[i] = fraction.touching;
        scene.particles.contact_slope[i] = fraction.slope;
    }
    group.bench_function("forces", |bencher| {
        let (view, mut forces) = (scene.contact(&table), TaskForces::default());
        bencher.iter(|| {
            forces.clear();
            forces.add::<false>(&view, ContactClass::Overlap, pairs());
            black_box(&forces);
        });
    });
}

/// The material's update, as it stands inside the first sweep.
struct Update<'a>(&'a Material, &'a mut PointBatch);

impl Vectorised for Update<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        self.0.update(black_box(self.1), 1e-10);
    }
}

fn material(criterion: &mut Criterion) {
    let material = &case().materials[0];
    let mut k = 0;
    let mut lanes = |size: f64| {
        k += 1;
        [size * noise(k); LANES]
    };
    let batch = PointBatch {
        density: [1.02 * DENSITY; LANES],
        specific_energy: [1e4; LANES],
        velocity_gradient: [(); 9].map(|()| lanes(1e5)),
        deviatoric_stress: [(); 6].map(|()| lanes(1e8)),
        plastic_strain: [0.1; LANES],
        ..PointBatch::ZERO
    };
    // As many as stay in the cache: what is measured is arithmetic.
    let mut batches = vec![batch; 64];
    let mut group = group(criterion, "material", LANES * batches.len());
    for set in available() {
        group.bench_function(set.name(), |bencher| {
            bencher.iter(|| {
                for batch in &mut batches {
                    set.run(Update(material, batch));
                }
            });
        });
    }
}

fn exact_sum(criterion: &mut Criterion) {
    let terms: Vec<f64> = (0..10_000).map(noise).collect();
    let mut group = group(criterion, "exact_sum", terms.len());
    group.bench_function("add", |bencher| {
        bencher.iter(|| {
            let mut sum = ExactSum::default();
            for &term in &terms {
                sum.add(term);
            }
            sum.value()
        });
    });
}

/// All on one thread, so that figures are those of a core.
fn one_thread() -> Criterion {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global()
        .unwrap_or_else(|error| panic!("{error}"));
    Criterion::default()
}

criterion_group! {
    name = kernels;
    config = one_thread();
    targets = velocity_gradient, momentum, search, contact, material, exact_sum
}
criterion_main!(kernels);
