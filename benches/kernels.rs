//! `make bench-kernels`: the inner loops alone, on a block of slightly disordered particles with
//! some 75 neighbours each. Throughput counts particles; all on one thread.

use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use whipple::diagnose::exact_sum::ExactSum;
use whipple::input;
use whipple::material::PointBatch;
use whipple::neighbours::{Chunk, ClusterLists, ColumnGrid, Image, ImageFacts, Sequence};
use whipple::sph::dispatch::available;
use whipple::sph::gradient::{MotionRecord, VelocityGradient};
use whipple::sph::kernel::{ConstantScale, Kernel};
use whipple::sph::lanes::LANES;
use whipple::sph::momentum::{ForceRecord, Momentum, Viscosity};

/// Particles along an edge.
const EDGE: u32 = 48;
const COUNT: usize = (EDGE * EDGE * EDGE) as usize;
/// Particle spacing (m).
const SPACING: f64 = 2e-5;
/// Smoothing length (m).
const LENGTH: f64 = 1.3 * SPACING;
/// Density of aluminium 2024 (kg/m³).
const DENSITY: f64 = 2785.0;

/// Particles, sorted and listed.
struct Scene {
    positions: Vec<[f64; 3]>,
    images: Vec<Image>,
    sequence: Sequence,
    clusters: ClusterLists,
    motion: Vec<MotionRecord>,
    forces: Vec<ForceRecord>,
}

impl Scene {
    fn new() -> Self {
        let side = f64::from(EDGE) * SPACING;
        let mut scene = Self {
            positions: (0..EDGE * EDGE * EDGE).map(place).collect(),
            images: (0..COUNT).map(|i| Image::new(i, 0)).collect(),
            sequence: Sequence::new([ColumnGrid::new([0.0; 3], [side; 3], SPACING, 0)]),
            clusters: ClusterLists::default(),
            motion: Vec::new(),
            forces: Vec::new(),
        };
        scene.sort();
        scene.list();
        let sorted = scene.sequence.images().iter();
        let motions = sorted.map(|image| motion(&scene.positions[image.base()]));
        scene.motion = motions.collect();
        scene.forces = scene.motion.iter().map(force).collect();
        scene
    }

    fn sort(&mut self) {
        let positions = &self.positions;
        self.sequence.build(&self.images, |image| ImageFacts {
            position: positions[image.base()],
            id: image.base() as u64,
            group: 0,
            smoothing_length: LENGTH,
        });
    }

    fn list(&mut self) {
        self.clusters.build(&self.sequence, COUNT, &[LENGTH]);
    }

    /// Calls `work` with the receivers and the neighbours of each cluster.
    fn sweep(&self, mut work: impl FnMut([u32; LANES], &[u32])) {
        for (cluster, neighbours, _) in self.clusters.chunks().iter().flat_map(Chunk::iter) {
            work(cluster.receivers, neighbours);
        }
    }
}

/// A site of the lattice, off by up to a tenth of the spacing along each axis (m).
fn place(site: u32) -> [f64; 3] {
    let sites = [site % EDGE, site / EDGE % EDGE, site / EDGE / EDGE];
    let mut axis = 0;
    sites.map(|along| {
        axis += 1;
        (f64::from(along) + 0.5 + 0.1 * noise(3 * site + axis)) * SPACING
    })
}

/// A number of −1..1 that looks random.
fn noise(k: u32) -> f64 {
    f64::from(k.wrapping_mul(0x9e37_79b9) >> 8) / f64::from(1 << 23) - 1.0
}

fn motion(position: &[f64; 3]) -> MotionRecord {
    MotionRecord {
        position: *position,
        velocity: position.map(|x| -1e6 * x),
        volume: SPACING.powi(3),
        smoothing_length: LENGTH,
    }
}

fn force(motion: &MotionRecord) -> ForceRecord {
    ForceRecord {
        position: motion.position,
        velocity: motion.velocity,
        mass: DENSITY * motion.volume,
        smoothing_length: LENGTH,
        density: DENSITY,
        sound_speed: 5328.0,
        stress_over_density2: [-130.0, -120.0, -110.0, 10.0, 20.0, 30.0],
    }
}

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

fn velocity_gradient(criterion: &mut Criterion) {
    let scene = Scene::new();
    let scale = ConstantScale::new(&Kernel::new(3), LENGTH);
    let mut group = group(criterion, "velocity_gradient", COUNT);
    for set in available() {
        group.bench_function(set.name(), |bencher| {
            bencher.iter(|| {
                scene.sweep(|receivers, neighbours| {
                    black_box(set.run(VelocityGradient {
                        sources: &scene.motion,
                        receivers,
                        neighbours,
                        scale,
                    }));
                });
            });
        });
    }
}

fn momentum(criterion: &mut Criterion) {
    let scene = Scene::new();
    let scale = ConstantScale::new(&Kernel::new(3), LENGTH);
    let mirrored = vec![0.0; COUNT];
    let viscosity = Viscosity {
        alpha: 1.0,
        beta: 2.0,
    };
    let mut group = group(criterion, "momentum_and_energy", COUNT);
    for set in available() {
        group.bench_function(set.name(), |bencher| {
            bencher.iter(|| {
                scene.sweep(|receivers, neighbours| {
                    black_box(set.run(Momentum::<_, false> {
                        sources: &scene.forces,
                        mirrored: &mirrored,
                        receivers,
                        neighbours,
                        scale,
                        viscosity,
                    }));
                });
            });
        });
    }
}

fn search(criterion: &mut Criterion) {
    let mut scene = Scene::new();
    let mut group = group(criterion, "search", COUNT);
    group.bench_function("sort", |bencher| bencher.iter(|| scene.sort()));
    group.bench_function("lists", |bencher| bencher.iter(|| scene.list()));
}

const MATERIAL: &str = r#"
dimension = 3
spacing = "1 mm"

[run]
end_time = "1 s"

[material.aluminium]
library = "aluminium-2024"

[[body]]
name = "block"
material = "aluminium"
shape.box = { size = ["9 mm", "9 mm", "9 mm"] }
"#;

fn material(criterion: &mut Criterion) {
    let case = input::parse("bench", MATERIAL, &[]).unwrap_or_else(|error| panic!("{error}"));
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
        pressure: [0.0; LANES],
        sound_speed: [0.0; LANES],
    };
    // As many as stay in the cache: what is measured is arithmetic.
    let mut batches = vec![batch; 64];
    let mut group = group(criterion, "material", LANES * batches.len());
    group.bench_function("aluminium-2024", |bencher| {
        bencher.iter(|| {
            for batch in &mut batches {
                case.materials[0].update(black_box(batch), 1e-10);
            }
        });
    });
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
    targets = velocity_gradient, momentum, search, material, exact_sum
}
criterion_main!(kernels);
