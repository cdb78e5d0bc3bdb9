//! The pair terms of a case over the particles of a rank: what particles show for them, and what else they do.

use rayon::prelude::*;

use crate::loads::Loads;
use model::{Case, TermOptions};
use numerics::kernel::Kernel;
use particles::Mirrors;
use particles::neighbours::Lists;
use particles::{GRAIN, Image, Owner, ParticleStore, resize};
use sums::step::Side;
use sums::terms::artificial_stress::repulsion;
use sums::terms::balsara::limiter;
use sums::terms::{PairTerms, TermRecord};

/// The pair terms of a case, and what particles and images show for them.
pub(super) struct Terms {
    set: Owner,
    records: Vec<TermRecord>,
    inverse_shape: f64,
    options: TermOptions,
}

/// Bytes of what each particle and image shows for the pair terms of a case.
pub(super) fn bytes_of_records(options: &TermOptions) -> usize {
    if Owner::of_terms(options).is_empty() {
        0
    } else {
        size_of::<TermRecord>()
    }
}

/// True if terms read the state of halo particles.
pub(super) fn read_state(options: &TermOptions) -> bool {
    Owner::of_terms(options).contains(Owner::ARTIFICIAL_STRESS)
}

impl Terms {
    pub fn new(case: &Case, kernel: &Kernel) -> Self {
        // All bodies of a case have the same h/Δp.
        let body = case.bodies.first();
        let ratio = body.map_or(1.0, |b| b.lattice.spacing / b.smoothing_length);
        Self {
            set: Owner::of_terms(&case.sph.terms),
            records: Vec::new(),
            inverse_shape: kernel.normalisation() / kernel.value(ratio, 1.0),
            options: case.sph.terms,
        }
    }

    /// Terms for the sums.
    pub fn of_sums(&self) -> PairTerms<'_> {
        PairTerms {
            set: self.set,
            records: &self.records,
            inverse_shape: self.inverse_shape,
            options: self.options,
        }
    }

    pub fn memory(&self) -> usize {
        self.records.capacity() * size_of::<TermRecord>()
    }

    /// Prepares data of this rank's particles for others, after the first sweep of a step `dt` (s).
    pub fn prepare(&self, particles: &mut ParticleStore, dt: f64) {
        if self.set.contains(Owner::BALSARA) {
            limit_viscosity(particles);
        }
        if self.set.contains(Owner::CONDUCTION) {
            predict_energies(particles, dt);
        }
    }

    /// Records of halo particles and their images, or of this rank's particles and theirs.
    pub fn show(&mut self, particles: &ParticleStore, lists: &Lists, side: Side) {
        let set = self.set;
        if set.is_empty() {
            return;
        }
        let images = lists.images();
        let epsilon = self.options.artificial_stress;
        resize(&mut self.records, images.len());
        let records = self.records.par_iter_mut().zip(images);
        records.with_min_len(GRAIN).for_each(|(record, &image)| {
            let i = image.slot();
            if !side.takes(i >= particles.owned()) {
                return;
            }
            *record = TermRecord::NEUTRAL;
            if set.contains(Owner::ARTIFICIAL_STRESS) {
                record.repulsion = repulsion_shown(particles, image, epsilon);
            }
            if set.contains(Owner::BALSARA) {
                record.half_limiter = 0.5 * particles.viscosity_limiter[i];
            }
            if set.contains(Owner::CONDUCTION) {
                record.specific_energy = particles.predicted_energy[i];
            }
        });
    }

    /// The rest of the drift of a step `dt` (s).
    pub fn drift(&self, particles: &mut ParticleStore, loads: &Loads, dt: f64) {
        if self.set.contains(Owner::XSPH) {
            drift_along(particles, loads, dt);
        }
    }
}

/// Repulsion that an image shows for artificial stress with the factor ε.
fn repulsion_shown(particles: &ParticleStore, image: Image, epsilon: f64) -> [f64; 6] {
    let (i, mirror_mask) = (image.slot(), image.mirror_mask());
    let stress = &particles.deviatoric_stress[i];
    let own = repulsion(epsilon, particles.pressure[i], stress, particles.density[i]);
    Mirrors::reflect_symmetric(&own, mirror_mask)
}

/// The factors of the Balsara switch of owned particles, from the first sweep.
fn limit_viscosity(particles: &mut ParticleStore) {
    let owned = particles.owned();
    particles.viscosity_limiter[..owned]
        .par_iter_mut()
        .with_min_len(GRAIN)
        .zip(&particles.velocity_gradient)
        .zip((&particles.sound_speed, &particles.smoothing_length))
        .for_each(|((factor, l), (&c, &h))| *factor = limiter(l, c, h));
}

/// Specific energies of owned particles in the middle of a step `dt` (s).
fn predict_energies(particles: &mut ParticleStore, dt: f64) {
    let owned = particles.owned();
    particles.predicted_energy[..owned]
        .par_iter_mut()
        .with_min_len(GRAIN)
        .zip((&particles.specific_energy, &particles.d_specific_energy_dt))
        .for_each(|(predicted, (e, de))| *predicted = e + 0.5 * dt * de);
}

/// The rest of the drift of a step `dt` (s). The mean velocity of the neighbours is that of the
/// last sums, taken with the velocities predicted for the beginning of this step.
///
/// Particles that feel contact move with their own velocity: the energy of contact is a
/// function of their positions, and its balance holds only where force times velocity is work.
/// So do particles that a load drives, along the axes that it prescribes.
fn drift_along(particles: &mut ParticleStore, loads: &Loads, dt: f64) {
    let (contact, bits) = (&particles.contact_acceleration, &particles.load);
    (&mut particles.position, &particles.velocity_correction)
        .into_par_iter()
        .with_min_len(GRAIN)
        .enumerate()
        .for_each(|(i, (x, correction))| {
            if contact.get(i).is_some_and(|force| *force != [0.0; 3]) {
                return;
            }
            let mut drift = *correction;
            if let Some(&bits) = bits.get(i) {
                loads.clear_prescribed(bits, &mut drift);
            }
            for a in 0..3 {
                x[a] += dt * drift[a];
            }
        });
}
