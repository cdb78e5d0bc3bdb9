//! The two pair sweeps over all clusters, with the material between them.

use rayon::prelude::*;

use super::search::GRAIN;
use super::simulation::Simulation;
use crate::domain::Mirrors;
use crate::material::{Material, PointBatch};
use crate::model::{Case, SmoothingLength};
use crate::neighbours::{Chunk, Cluster, Image};
use crate::particles::{ParticleStore, Scatter};
use crate::sph::dispatch::{Instructions, instructions};
use crate::sph::gradient::{MotionRecord, VelocityGradient};
use crate::sph::kernel::{ConstantScale, Kernel, MeanScale, PairScale};
use crate::sph::lanes::LANES;
use crate::sph::momentum::{ForceRecord, Forces, Momentum, Viscosity};

/// Records of the second sweep and what mirrors exert, kept from step to step.
pub struct Sweeps {
    scale: Scale,
    viscosity: Viscosity,
    material_of_body: Vec<usize>,
    forces: Vec<ForceRecord>,
    mirrored: Vec<f64>,
    /// Forces of mirror images on single particles (N), by chunk.
    pub(super) from_mirrors: Vec<Vec<[f64; 3]>>,
}

/// The pair scale of a case, chosen once.
#[derive(Debug, Clone, Copy)]
enum Scale {
    Constant(ConstantScale),
    One(MeanScale<1>),
    Two(MeanScale<2>),
    Three(MeanScale<3>),
}

/// Calls `$work` with the scale of a case as a concrete type.
macro_rules! with_scale {
    ($scale:expr, $name:ident => $work:expr) => {
        match $scale {
            Scale::Constant($name) => $work,
            Scale::One($name) => $work,
            Scale::Two($name) => $work,
            Scale::Three($name) => $work,
        }
    };
}

impl Sweeps {
    pub(super) fn new(case: &Case, kernel: &Kernel) -> Self {
        let h = case.bodies.first().map_or(1.0, |b| b.smoothing_length);
        let equal = case
            .bodies
            .iter()
            .all(|b| b.smoothing_length.to_bits() == h.to_bits());
        let constant = case.sph.smoothing_length == SmoothingLength::Constant && equal;
        let scale = match case.dimension {
            _ if constant => Scale::Constant(ConstantScale::new(kernel, h)),
            1 => Scale::One(MeanScale::new(kernel)),
            2 => Scale::Two(MeanScale::new(kernel)),
            _ => Scale::Three(MeanScale::new(kernel)),
        };
        Self {
            scale,
            viscosity: Viscosity {
                alpha: case.sph.alpha,
                beta: case.sph.beta,
            },
            material_of_body: case.bodies.iter().map(|b| b.material).collect(),
            forces: Vec::new(),
            mirrored: Vec::new(),
            from_mirrors: Vec::new(),
        }
    }

    pub(super) fn memory(&self) -> usize {
        self.forces.capacity() * size_of::<ForceRecord>() + self.mirrored.capacity() * 8
    }
}

impl Simulation {
    /// First sweep: velocity gradient at the end of the step, density and stress from its mean
    /// with the gradient at the start.
    pub(super) fn velocity_gradient_and_material(&mut self, dt: f64) {
        let set = instructions();
        let chunks = self.search.clusters.chunks();
        let target = MaterialTarget::new(
            &mut self.store,
            self.search.sequence.images(),
            &self.case.materials,
            &self.sweeps.material_of_body,
            dt,
        );
        let motion = &self.search.motion;
        with_scale!(self.sweeps.scale, scale => chunks
            .par_iter()
            .for_each(|chunk| gradient_chunk(set, chunk, motion, scale, &target)));
    }

    /// Second sweep: accelerations by stress and viscosity, and the power they put into heat, of
    /// the clusters that have halo particles among their neighbours or of those that have none,
    /// which need not wait for messages.
    pub(super) fn momentum_and_energy(&mut self, halo: bool) {
        self.fill_force_records(halo);
        let set = instructions();
        let chunks = self.search.clusters.chunks();
        let images = self.search.sequence.images();
        let Sweeps {
            scale,
            viscosity,
            forces,
            mirrored,
            from_mirrors,
            ..
        } = &mut self.sweeps;
        from_mirrors.resize(chunks.len(), Vec::new());
        let target = ForceTarget::new(&mut self.store, images);
        let sources = ForceSources {
            records: forces,
            mirrored,
            viscosity: *viscosity,
        };
        with_scale!(*scale, scale => chunks
        .par_iter()
        .zip(from_mirrors)
        .for_each(|(chunk, images)| {
            if !halo {
                images.clear();
            }
            momentum_chunk(set, chunk, halo, &sources, scale, &target, images);
        }));
    }

    /// Records of halo particles and their images, or of this rank's.
    fn fill_force_records(&mut self, halo: bool) {
        let store = &self.store;
        let owned = store.owned();
        let images = self.search.sequence.images();
        let blank = ForceRecord {
            position: [0.0; 3],
            velocity: [0.0; 3],
            mass: 0.0,
            smoothing_length: 0.0,
            density: 0.0,
            sound_speed: 0.0,
            stress_over_density2: [0.0; 6],
        };
        self.sweeps.forces.resize(images.len(), blank);
        self.sweeps.mirrored.resize(images.len(), 0.0);
        (
            &mut self.sweeps.forces,
            &mut self.sweeps.mirrored,
            images,
            &self.search.motion,
        )
            .into_par_iter()
            .with_min_len(GRAIN)
            .for_each(|(record, mirrored, image, motion)| {
                let (base, code) = (image.base(), image.code());
                if (base >= owned) != halo {
                    return;
                }
                let density = store.density[base];
                let scale = 1.0 / (density * density);
                let pressure = store.pressure[base];
                let s = Mirrors::reflect_symmetric(&store.deviatoric_stress[base], code);
                *record = ForceRecord {
                    position: motion.position,
                    velocity: motion.velocity,
                    mass: store.mass[base],
                    smoothing_length: motion.smoothing_length,
                    density,
                    sound_speed: store.sound_speed[base],
                    stress_over_density2: [
                        (s[0] - pressure) * scale,
                        (s[1] - pressure) * scale,
                        (s[2] - pressure) * scale,
                        s[3] * scale,
                        s[4] * scale,
                        s[5] * scale,
                    ],
                };
                *mirrored = if code == 0 { 0.0 } else { 1.0 };
            });
    }
}

/// Where the first sweep writes: each owned particle stands in exactly one lane of one cluster.
struct MaterialTarget<'a> {
    images: &'a [Image],
    materials: &'a [Material],
    material_of_body: &'a [usize],
    dt: f64,
    body: &'a [u32],
    predicted_energy: &'a [f64],
    density: Scatter<'a, f64>,
    velocity_gradient: Scatter<'a, [f64; 9]>,
    deviatoric_stress: Scatter<'a, [f64; 6]>,
    plastic_strain: Scatter<'a, f64>,
    pressure: Scatter<'a, f64>,
    sound_speed: Scatter<'a, f64>,
    work: Scatter<'a, u32>,
}

impl<'a> MaterialTarget<'a> {
    fn new(
        store: &'a mut ParticleStore,
        images: &'a [Image],
        materials: &'a [Material],
        material_of_body: &'a [usize],
        dt: f64,
    ) -> Self {
        Self {
            images,
            materials,
            material_of_body,
            dt,
            body: &store.body,
            predicted_energy: &store.predicted_energy,
            density: Scatter::new(&mut store.density),
            velocity_gradient: Scatter::new(&mut store.velocity_gradient),
            deviatoric_stress: Scatter::new(&mut store.deviatoric_stress),
            plastic_strain: Scatter::new(&mut store.plastic_strain),
            pressure: Scatter::new(&mut store.pressure),
            sound_speed: Scatter::new(&mut store.sound_speed),
            work: Scatter::new(&mut store.work),
        }
    }

    /// Advances density, stress and strain of a cluster whose velocity gradient at the end of
    /// the step is `gradient`.
    fn update(
        &self,
        cluster: &Cluster,
        gradient: &[crate::sph::lanes::F64x8; 9],
        neighbours: usize,
    ) {
        let base: [usize; LANES] = cluster
            .receivers
            .map(|place| self.images[place as usize].base());
        let mut batch = PointBatch {
            density: [0.0; LANES],
            specific_energy: [0.0; LANES],
            velocity_gradient: [[0.0; LANES]; 9],
            deviatoric_stress: [[0.0; LANES]; 6],
            plastic_strain: [0.0; LANES],
            pressure: [0.0; LANES],
            sound_speed: [0.0; LANES],
        };
        for (k, &i) in base.iter().enumerate() {
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            let (rho, l, s, plastic) = unsafe {
                (
                    *self.density.slot(i),
                    *self.velocity_gradient.slot(i),
                    *self.deviatoric_stress.slot(i),
                    *self.plastic_strain.slot(i),
                )
            };
            for c in 0..9 {
                batch.velocity_gradient[c][k] = 0.5 * (l[c] + gradient[c].0[k]);
            }
            let mean = &batch.velocity_gradient;
            let strain = 0.5 * self.dt * (mean[0][k] + mean[4][k] + mean[8][k]);
            batch.density[k] = rho * ((1.0 - strain) / (1.0 + strain));
            batch.specific_energy[k] = self.predicted_energy[i];
            for c in 0..6 {
                batch.deviatoric_stress[c][k] = s[c];
            }
            batch.plastic_strain[k] = plastic;
        }
        let before = batch;
        let material = |k: usize| self.material_of_body[self.body[base[k]] as usize];
        for k in 0..cluster.lanes {
            let own = material(k);
            if (0..k).any(|earlier| material(earlier) == own) {
                continue;
            }
            let mut result = before;
            self.materials[own].update(&mut result, self.dt);
            for lane in k..cluster.lanes {
                if material(lane) == own {
                    self.store_lane(base[lane], lane, &result, gradient, neighbours);
                }
            }
        }
    }

    fn store_lane(
        &self,
        i: usize,
        k: usize,
        batch: &PointBatch,
        gradient: &[crate::sph::lanes::F64x8; 9],
        neighbours: usize,
    ) {
        // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
        unsafe {
            *self.density.slot(i) = batch.density[k];
            *self.velocity_gradient.slot(i) = std::array::from_fn(|c| gradient[c].0[k]);
            *self.deviatoric_stress.slot(i) =
                std::array::from_fn(|c| batch.deviatoric_stress[c][k]);
            *self.plastic_strain.slot(i) = batch.plastic_strain[k];
            *self.pressure.slot(i) = batch.pressure[k];
            *self.sound_speed.slot(i) = batch.sound_speed[k];
            *self.work.slot(i) = u32::try_from(neighbours).unwrap_or(u32::MAX);
        }
    }
}

fn gradient_chunk<S: PairScale>(
    set: Instructions,
    chunk: &Chunk,
    sources: &[MotionRecord],
    scale: S,
    target: &MaterialTarget,
) {
    for (cluster, neighbours, _) in chunk.iter() {
        let gradient = set.run(VelocityGradient {
            sources,
            receivers: cluster.receivers,
            neighbours,
            scale,
        });
        target.update(cluster, &gradient, neighbours.len());
    }
}

/// What the second sweep reads.
struct ForceSources<'a> {
    records: &'a [ForceRecord],
    mirrored: &'a [f64],
    viscosity: Viscosity,
}

/// Where the second sweep writes.
struct ForceTarget<'a> {
    images: &'a [Image],
    mass: &'a [f64],
    acceleration: Scatter<'a, [f64; 3]>,
    power: Scatter<'a, f64>,
    approach: Scatter<'a, f64>,
}

impl<'a> ForceTarget<'a> {
    fn new(store: &'a mut ParticleStore, images: &'a [Image]) -> Self {
        Self {
            images,
            mass: &store.mass,
            acceleration: Scatter::new(&mut store.acceleration),
            power: Scatter::new(&mut store.d_specific_energy_dt),
            approach: Scatter::new(&mut store.approach_speed),
        }
    }

    fn store(&self, cluster: &Cluster, forces: &Forces) {
        for k in 0..cluster.lanes {
            let i = self.images[cluster.receivers[k] as usize].base();
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            unsafe {
                *self.acceleration.slot(i) = std::array::from_fn(|a| forces.acceleration[a].0[k]);
                *self.power.slot(i) = forces.power.0[k];
                *self.approach.slot(i) = forces.approach.0[k];
            }
        }
    }
}

fn momentum_chunk<S: PairScale>(
    set: Instructions,
    chunk: &Chunk,
    halo: bool,
    sources: &ForceSources,
    scale: S,
    target: &ForceTarget,
    from_mirrors: &mut Vec<[f64; 3]>,
) {
    for (cluster, neighbours, among) in chunk.iter().filter(|(_, _, among)| among.halo == halo) {
        if among.mirrors {
            let forces = run_momentum::<S, true>(set, cluster, neighbours, sources, scale);
            target.store(cluster, &forces);
            for k in 0..cluster.lanes {
                let mass = target.mass[target.images[cluster.receivers[k] as usize].base()];
                from_mirrors.push(forces.from_mirrors.map(|lanes| mass * lanes.0[k]));
            }
        } else {
            let forces = run_momentum::<S, false>(set, cluster, neighbours, sources, scale);
            target.store(cluster, &forces);
        }
    }
}

fn run_momentum<S: PairScale, const MIRRORED: bool>(
    set: Instructions,
    cluster: &Cluster,
    neighbours: &[u32],
    sources: &ForceSources,
    scale: S,
) -> Forces {
    set.run(Momentum::<S, MIRRORED> {
        sources: sources.records,
        mirrored: sources.mirrored,
        receivers: cluster.receivers,
        neighbours,
        scale,
        viscosity: sources.viscosity,
    })
}
