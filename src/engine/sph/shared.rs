//! Common parts of the formulations: records of stress, and their inputs.

use rayon::prelude::*;

use super::rest::Resting;
use super::term_records::Terms;
use material::{Material, NEGLIGIBLE};
use model::{Body, Case, SmoothingLength};
use numerics::kernel::{Kernel, RingScale};
use numerics::lanes::LANES;
use particles::neighbours::Lists;
use particles::{GRAIN, MirrorMask, Scatter, resize};
use sums::from_mirrors::FromMirrors;
use sums::momentum::Viscosity;
use sums::neighbourhood::Sources;
use sums::scale::Scale;
use sums::step::Side;

/// Data of a formulation beside particles and lists, kept from step to step.
pub(super) struct Sums {
    pub dimension: usize,
    pub scale: Scale,
    /// By body: mass (kg) of a particle of which a ring has many; empty where there are none.
    pub grain_masses: Vec<f64>,
    pub viscosity: Viscosity,
    pub terms: Terms,
    pub materials: Vec<Material>,
    pub resting: Resting,
    pub material_of_body: Vec<usize>,
    /// By body: sound speed (m/s) by which particles without stress choose a step, that of the material of rigid bodies
    /// that forces move.
    pub free_sound: Vec<f64>,
    /// True if one of these asks for what only some laws must know.
    pub needs_particle: bool,
    /// Pressure (Pa) that counts as arrived, by material.
    pub arrival: Vec<f64>,
    /// Forces of mirror images, by chunk.
    pub from_mirrors: Vec<FromMirrors>,
    /// Particles of this rank whose gradient has no correction.
    pub uncorrected: i64,
}

impl Sums {
    pub fn new(case: &Case, kernel: &Kernel) -> Self {
        let h = case.bodies.first().map_or(1.0, |b| b.smoothing_length);
        let equal = case
            .bodies
            .iter()
            .all(|b| b.smoothing_length.to_bits() == h.to_bits() && b.lattice.sizes.is_none());
        let constant = case.sph.smoothing_length == SmoothingLength::Constant && equal;
        let scale = if case.axisymmetric {
            Scale::Ring(RingScale::new(kernel))
        } else {
            Scale::new(kernel, constant.then_some(h))
        };
        let grain = |body: &Body| {
            let area = body.lattice.particle_volume(case.dimension);
            case.initial_density(body) * area * area.sqrt()
        };
        let rings = case.bodies.iter().filter(|_| case.axisymmetric);
        Self {
            dimension: case.extent(),
            scale,
            grain_masses: rings.map(grain).collect(),
            viscosity: Viscosity {
                alpha: case.sph.alpha,
                beta: case.sph.beta,
                negligible: NEGLIGIBLE * case.fastest_sound(),
            },
            terms: Terms::new(case, kernel),
            materials: case.materials.clone(),
            resting: Resting::new(case),
            arrival: (case.materials.iter())
                .map(|material| case.measure.arrival_of(material))
                .collect(),
            material_of_body: case.bodies.iter().map(|b| b.material).collect(),
            free_sound: (case.bodies.iter())
                .map(|body| {
                    let material = body.is_free().then(|| &case.materials[body.material]);
                    material.map_or(0.0, Material::longitudinal_speed)
                })
                .collect(),
            needs_particle: case.any_material(Material::needs_particle),
            from_mirrors: Vec::new(),
            uncorrected: 0,
        }
    }

    pub fn memory(&self) -> usize {
        let mirrors: usize = self.from_mirrors.iter().map(FromMirrors::memory).sum();
        mirrors + self.terms.memory()
    }
}

/// Makes records of halo particles and their images, or of the images of this rank's particles,
/// whose own records the first sweep has written: `show` makes one of a particle's index and an
/// image's mirror mask, and may read the own records.
pub(super) fn show_images<R: Send>(
    records: &mut [R],
    owned: usize,
    lists: &Lists,
    side: Side,
    show: impl Fn(&Scatter<R>, usize, MirrorMask) -> R + Sync,
) {
    let sequence = lists.sequence();
    if sequence.is_alone() {
        return;
    }
    let records = Scatter::new(records);
    let images = sequence.images().par_chunks(LANES).enumerate();
    images
        .with_min_len(GRAIN)
        .filter(|(eight, _)| sequence.any_images(LANES * eight))
        .for_each(|(eight, images)| {
            for (k, image) in images.iter().enumerate() {
                let (slot, mirror_mask) = (image.slot(), image.mirror_mask());
                let of_halo = slot >= owned;
                if side.takes(of_halo) && (of_halo || !mirror_mask.is_own()) {
                    let shown = show(&records, slot, mirror_mask);
                    // SAFETY: each place is visited once, and those of own particles are not.
                    unsafe { *records.slot(LANES * eight + k) = shown };
                }
            }
        });
}

/// Memory for so many images that nobody needs before the next first sweep, in words.
pub(super) fn scratch_of<R: bytemuck::Pod + Send + Sync>(
    records: &mut Vec<R>,
    images: usize,
) -> &mut [u64] {
    if records.len() < images {
        resize(records, images);
    }
    bytemuck::cast_slice_mut(records)
}

/// Facts of all particles and images that a sweep over pairs reads.
pub(super) fn sources<S>(lists: &Lists, scale: S) -> Sources<'_, S> {
    Sources {
        records: lists.motion(),
        lengths: lists.sequence().smoothing_lengths(),
        scale,
    }
}
