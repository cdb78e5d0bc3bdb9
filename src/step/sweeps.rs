//! The two pair sweeps over all clusters, with the material between them.

use rayon::prelude::*;

use super::material_update::MaterialUpdate;
use super::normalised::{CorrectionFields, NormalisedChunk, StressPower};
use super::search::GRAIN;
use super::simulation::Simulation;
use crate::domain::Mirrors;
use crate::model::{Case, SmoothingLength, SphForm};
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, Cluster};
use crate::numerics::dispatch::{Vectorised, instructions};
use crate::numerics::lanes::{F64x8, LANES, Lanes};
use crate::particles::{Image, ParticleStore, Scatter};
use crate::sph::gradient::VelocityGradient;
use crate::sph::kernel::{ConstantScale, Kernel, MeanScale, PairScale};
use crate::sph::momentum::{Forces, Momentum, StressRecord, Viscosity};
use crate::sph::neighbourhood::Sources;
use crate::sph::options::{ARTIFICIAL_STRESS, BALSARA, CONDUCTION, NORMALISED, Options, XSPH};

/// Records of the second sweep and what mirrors exert, kept from step to step.
pub struct Sweeps {
    pub(super) scale: Scale,
    pub(super) viscosity: Viscosity,
    pub(super) material_of_body: Vec<usize>,
    pub(super) stresses: Vec<StressRecord>,
    /// What mirror images exert, by chunk.
    pub(super) from_mirrors: Vec<FromMirrors>,
}

/// What the images behind symmetry planes exert on the particles of a chunk.
#[derive(Debug, Clone, Default)]
pub(super) struct FromMirrors {
    /// The images among the neighbours of one cluster.
    pub(super) places: Vec<u32>,
    /// Forces on single particles (N).
    pub(super) forces: Vec<[f64; 3]>,
}

impl FromMirrors {
    fn memory(&self) -> usize {
        4 * self.places.capacity() + size_of::<[f64; 3]>() * self.forces.capacity()
    }
}

/// The pair scale of a case, chosen once.
#[derive(Debug, Clone, Copy)]
pub(super) enum Scale {
    Constant(ConstantScale),
    One(MeanScale<1>),
    Two(MeanScale<2>),
    Three(MeanScale<3>),
}

/// Calls `$work` with the scale of a case as a concrete type.
macro_rules! with_scale {
    ($scale:expr, $name:ident => $work:expr) => {
        match $scale {
            $crate::step::sweeps::Scale::Constant($name) => $work,
            $crate::step::sweeps::Scale::One($name) => $work,
            $crate::step::sweeps::Scale::Two($name) => $work,
            $crate::step::sweeps::Scale::Three($name) => $work,
        }
    };
}
pub(super) use with_scale;

/// Calls `$work` with a set of options as a constant: no options, or those of solids (artificial
/// stress and XSPH), of shocks (the Balsara switch and conduction), or all, whichever has all that
/// are wanted. The others then have neutral data. The normalised form has none or all.
macro_rules! with_options {
    ($wanted:expr, $name:ident => $work:expr) => {
        match $wanted {
            0 => {
                const $name: u8 = 0;
                $work
            }
            set if set & !SOLIDS == 0 => {
                const $name: u8 = SOLIDS;
                $work
            }
            set if set & !SHOCKS == 0 => {
                const $name: u8 = SHOCKS;
                $work
            }
            set if set & NORMALISED == 0 => {
                const $name: u8 = SOLIDS | SHOCKS;
                $work
            }
            NORMALISED => {
                const $name: u8 = NORMALISED;
                $work
            }
            _ => {
                const $name: u8 = NORMALISED | SOLIDS | SHOCKS;
                $work
            }
        }
    };
}

const SOLIDS: u8 = ARTIFICIAL_STRESS | XSPH;
const SHOCKS: u8 = BALSARA | CONDUCTION;

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
            stresses: Vec::new(),
            from_mirrors: Vec::new(),
        }
    }

    pub(super) fn memory(&self) -> usize {
        let mirrors: usize = self.from_mirrors.iter().map(FromMirrors::memory).sum();
        self.stresses.capacity() * size_of::<StressRecord>() + mirrors
    }
}

impl Simulation {
    /// First sweep: velocity gradient at the end of the step, density and stress from its mean
    /// with the gradient at the start.
    pub(super) fn velocity_gradient_and_material(&mut self, dt: f64) {
        if self.case.sph.form == SphForm::StressPoints {
            return self.strain_stress_points(dt);
        }
        let set = instructions();
        let normalised = self.options.set & NORMALISED != 0;
        let fields = normalised.then(|| CorrectionFields::take(&mut self.store));
        let chunks = self.search.clusters.chunks();
        let update = &MaterialUpdate::new(
            &mut self.store,
            &mut self.sweeps.stresses,
            self.search.sequence.images(),
            &self.case.materials,
            &self.sweeps.material_of_body,
            &self.contact.rigid,
            dt,
        );
        let search = &self.search;
        let chunks = chunks.par_iter().with_max_len(CHUNKS_AT_ONCE);
        let Some(mut fields) = fields else {
            with_scale!(self.sweeps.scale, scale => chunks.for_each(|chunk| {
                set.run(GradientChunk { chunk, motion: search.sources(scale), update });
            }));
            return;
        };
        let corrections = &fields.target();
        let images = self.search.sequence.images();
        let dimension = self.case.dimension;
        with_scale!(self.sweeps.scale, scale => chunks.for_each(|chunk| {
            let motion = search.sources(scale);
            set.run(NormalisedChunk {
                chunk, motion, dimension, images, update, corrections,
            });
        }));
        fields.give_back(&mut self.store);
        self.count_uncorrected();
    }

    /// Second sweep: accelerations by stress and viscosity, and the power they put into heat, of
    /// the clusters that have halo particles among their neighbours or of those that have none,
    /// which need not wait for messages.
    pub(super) fn momentum_and_energy(&mut self, halo: bool) {
        if halo && self.store.halo() == 0 {
            return;
        }
        if self.case.sph.form == SphForm::StressPoints {
            return self.pull_by_stress_points(halo);
        }
        self.fill_records(halo);
        self.fill_options(halo);
        let set = instructions();
        let search = &self.search;
        let chunks = search.clusters.chunks();
        let images = search.sequence.images();
        let Sweeps {
            scale,
            viscosity,
            stresses,
            from_mirrors,
            ..
        } = &mut self.sweeps;
        from_mirrors.resize_with(chunks.len(), FromMirrors::default);
        let target = &ForceTarget::new(&mut self.store, images);
        let sources = ForceSources {
            stresses,
            mirrored: search.sequence.mirrored(),
            viscosity: *viscosity,
            options: self.options.of_sums(),
        };
        let options = self.options.set;
        with_scale!(*scale, scale => chunks
        .par_iter()
        .zip(from_mirrors)
        .with_max_len(CHUNKS_AT_ONCE)
        .for_each(|(chunk, from_mirrors)| {
            if !halo {
                from_mirrors.forces.clear();
            }
            with_options!(options, OPTIONS => set.run(MomentumChunk::<_, OPTIONS> {
                chunk, halo, motion: search.sources(scale), sources, target, from_mirrors,
            }));
        }));
    }

    /// Stresses of halo particles and their images, or of the images of this rank's particles,
    /// whose own stresses the first sweep has written.
    fn fill_records(&mut self, halo: bool) {
        let store = &self.store;
        let owned = store.owned();
        if self.halo.others().is_empty() {
            return;
        }
        let sequence = &self.search.sequence;
        let stresses = self.sweeps.stresses.par_chunks_mut(LANES);
        let images = sequence.images().par_chunks(LANES).enumerate();
        let others = stresses.zip(images).with_min_len(GRAIN);
        others
            .filter(|(_, (eight, _))| sequence.any_images(LANES * eight))
            .flat_map_iter(|(records, (_, images))| records.iter_mut().zip(images))
            .for_each(|(record, image)| {
                let (base, code) = (image.base(), image.code());
                let of_halo = base >= owned;
                if of_halo != halo || (!of_halo && code == 0) {
                    return;
                }
                let stress = Mirrors::reflect_symmetric(&store.deviatoric_stress[base], code);
                *record = StressRecord::new(
                    store.pressure[base],
                    &stress,
                    store.density[base],
                    store.sound_speed[base],
                );
            });
    }
}

/// The first sweep over one task's clusters.
struct GradientChunk<'a, S> {
    chunk: &'a Chunk,
    motion: Sources<'a, S>,
    update: &'a MaterialUpdate<'a>,
}

impl<S: PairScale> Vectorised for GradientChunk<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (cluster, neighbours, among) in self.chunk.iter() {
            if !among.moving {
                // No relative velocity: the sum would be this, to the bit.
                let none = [F64x8([0.0; LANES]); 9];
                self.update.apply(cluster, &none, neighbours.len());
                continue;
            }
            let gradient = VelocityGradient {
                around: self.motion.around(cluster.receivers, neighbours),
            };
            self.update
                .apply(cluster, &gradient.run::<V>(), neighbours.len());
        }
    }
}

/// What the second sweep reads.
#[derive(Clone, Copy)]
struct ForceSources<'a> {
    stresses: &'a [StressRecord],
    mirrored: &'a [u8],
    viscosity: Viscosity,
    options: Options<'a>,
}

/// Where the second sweep writes.
struct ForceTarget<'a> {
    images: &'a [Image],
    mass: &'a [f64],
    acceleration: Scatter<'a, [f64; 3]>,
    power: Scatter<'a, f64>,
    approach: Scatter<'a, f64>,
    correction: Option<Scatter<'a, [f64; 3]>>,
    stress_power: StressPower<'a>,
}

impl<'a> ForceTarget<'a> {
    fn new(store: &'a mut ParticleStore, images: &'a [Image]) -> Self {
        let correction = &mut store.velocity_correction;
        Self {
            images,
            mass: &store.mass,
            acceleration: Scatter::new(&mut store.acceleration),
            power: Scatter::new(&mut store.d_specific_energy_dt),
            approach: Scatter::new(&mut store.approach_speed),
            correction: (!correction.is_empty()).then(|| Scatter::new(correction)),
            stress_power: StressPower::new(
                &store.pressure,
                &store.deviatoric_stress,
                &store.velocity_gradient,
                &store.predicted_density,
            ),
        }
    }

    #[inline(always)]
    fn store<const OPTIONS: u8>(&self, cluster: &Cluster, forces: &Forces) {
        for k in 0..cluster.lanes {
            let i = self.images[cluster.receivers[k] as usize].base();
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            unsafe {
                *self.acceleration.slot(i) = std::array::from_fn(|a| forces.acceleration[a].0[k]);
                *self.power.slot(i) = forces.power.0[k];
                *self.approach.slot(i) = forces.approach.0[k];
                if OPTIONS & NORMALISED != 0 {
                    *self.power.slot(i) += self.stress_power.of(i);
                }
                if OPTIONS & XSPH != 0
                    && let Some(correction) = &self.correction
                {
                    *correction.slot(i) = std::array::from_fn(|a| forces.correction[a].0[k]);
                }
            }
        }
    }
}

/// The second sweep over one task's clusters, with a set of options.
struct MomentumChunk<'a, S, const OPTIONS: u8> {
    chunk: &'a Chunk,
    /// Only clusters with halo particles among their neighbours, or only those without.
    halo: bool,
    motion: Sources<'a, S>,
    sources: ForceSources<'a>,
    target: &'a ForceTarget<'a>,
    from_mirrors: &'a mut FromMirrors,
}

impl<S: PairScale, const OPTIONS: u8> Vectorised for MomentumChunk<'_, S, OPTIONS> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let target = self.target;
        let halo = self.halo;
        let all = self.chunk.iter();
        for (cluster, neighbours, among) in all.filter(|(_, _, among)| among.halo == halo) {
            let free = |&j: &u32| self.sources.stresses[j as usize].is_free();
            if !among.moving && neighbours.iter().all(free) {
                target.store::<OPTIONS>(cluster, &Forces::NONE);
                continue;
            }
            target.store::<OPTIONS>(
                cluster,
                &Self::sum::<V>(self.motion, &self.sources, cluster, neighbours),
            );
            if !among.mirrors {
                continue;
            }
            let FromMirrors { places, forces } = &mut *self.from_mirrors;
            let is_image = |&j: &u32| self.sources.mirrored[j as usize] & 1 == 1;
            places.clear();
            places.extend(neighbours.iter().copied().filter(is_image));
            let part = Self::sum::<V>(self.motion, &self.sources, cluster, places).acceleration;
            for k in 0..cluster.lanes {
                let mass = target.mass[target.images[cluster.receivers[k] as usize].base()];
                forces.push([
                    mass * part[0].0[k],
                    mass * part[1].0[k],
                    mass * part[2].0[k],
                ]);
            }
        }
    }
}

impl<S: PairScale, const OPTIONS: u8> MomentumChunk<'_, S, OPTIONS> {
    #[inline(always)]
    fn sum<V: Lanes>(
        motion: Sources<S>,
        sources: &ForceSources,
        cluster: &Cluster,
        neighbours: &[u32],
    ) -> Forces {
        let sums = Momentum::<S, OPTIONS> {
            around: motion.around(cluster.receivers, neighbours),
            stresses: sources.stresses,
            viscosity: sources.viscosity,
            options: sources.options,
        };
        sums.run::<V>()
    }
}
