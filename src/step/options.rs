//! What particles show to each other for the options of the SPH sums, and the drift of XSPH.

use rayon::prelude::*;

use super::normalised;
use super::search::GRAIN;
use super::simulation::Simulation;
use crate::contact::ContactTable;
use crate::domain::Mirrors;
use crate::model::{Case, SphForm, SphOptions, TroublePolicy};
use crate::particles::{FieldInfo, HaloPhase, Owner, Select, resize, rows};
use crate::sph::kernel::Kernel;
use crate::sph::normalised::NormalisedRecord;
use crate::sph::options::{
    ARTIFICIAL_STRESS, BALSARA, CONDUCTION, NORMALISED, OptionRecord, Options, XSPH, limiter,
    repulsion,
};

/// The options of a case, and what particles and images show for them.
pub struct OptionPhase {
    /// A set of the constants of [`crate::sph::options`].
    pub(super) set: u8,
    records: Vec<OptionRecord>,
    normalised: Vec<NormalisedRecord>,
    inverse_shape: f64,
    sph: SphOptions,
}

impl OptionPhase {
    pub(super) fn new(case: &Case, kernel: &Kernel) -> Self {
        let sph = case.sph;
        let mut set = 0;
        for (option, wanted) in [
            (ARTIFICIAL_STRESS, sph.artificial_stress > 0.0),
            (BALSARA, sph.balsara),
            (CONDUCTION, sph.conduction > 0.0),
            (XSPH, sph.xsph > 0.0),
            (NORMALISED, sph.form == SphForm::Normalised),
        ] {
            set |= if wanted { option } else { 0 };
        }
        // All bodies of a case have the same h/Δp.
        let body = case.bodies.first();
        let ratio = body.map_or(1.0, |b| b.lattice.spacing / b.smoothing_length);
        Self {
            set,
            records: Vec::new(),
            normalised: Vec::new(),
            inverse_shape: kernel.normalisation() / kernel.value(ratio, 1.0),
            sph,
        }
    }

    /// What the sums need.
    pub(super) fn of_sums(&self) -> Options<'_> {
        Options {
            records: &self.records,
            normalised: &self.normalised,
            inverse_shape: self.inverse_shape,
            conduction: self.sph.conduction,
            xsph: self.sph.xsph,
        }
    }

    pub(super) fn memory(&self) -> usize {
        self.records.capacity() * size_of::<OptionRecord>()
            + self.normalised.capacity() * size_of::<NormalisedRecord>()
    }
}

/// Options of the table of fields that a case does not have.
pub(super) fn unused_fields(case: &Case, contact: &ContactTable) -> Owner {
    let sph = &case.sph;
    let driven = !case.loads.velocities.is_empty() || case.bodies.iter().any(|b| b.rigid.is_some());
    [
        (Owner::CONTACT, contact.is_active()),
        (Owner::PENALTY, contact.has_penalty()),
        (Owner::LOADS, driven),
        (Owner::FRICTION, contact.has_friction()),
        (Owner::SELF_CONTACT, case.self_contact.is_some()),
        (
            Owner::FOLDS,
            case.self_contact.is_some_and(|s| s.folds.is_some()),
        ),
        (Owner::SURFACE_FRICTION, case.loads.has_friction()),
        (Owner::BALSARA, sph.balsara),
        (Owner::CONDUCTION, sph.conduction > 0.0),
        (Owner::XSPH, sph.xsph > 0.0),
        (Owner::NORMALISED, sph.form == SphForm::Normalised),
        (Owner::FREEZE, case.trouble.policy == TroublePolicy::Freeze),
        (Owner::STRESS_POINTS, sph.form == SphForm::StressPoints),
    ]
    .into_iter()
    .filter(|&(_, used)| !used)
    .fold(Owner::default(), |all, (option, _)| all | option)
}

/// Bytes that the options of a case add beyond contact without friction: to an owned particle, and
/// to a halo particle with its messages.
#[must_use]
pub fn bytes_of_options(case: &Case) -> [usize; 2] {
    let contact = ContactTable::new(case);
    let unused = unused_fields(case, &contact) | Owner::CONTACT;
    let fields = || rows(FieldInfo::is_optional).filter(|field| field.is_held_without(unused));
    let owned: usize = fields().map(|field| field.kind.bytes()).sum();
    let halo = fields().filter(|field| HaloPhase::all().takes(field));
    let halo: usize = halo.map(|field| field.kind.bytes()).sum();
    let set = OptionPhase::new(case, &contact.kernel).set;
    let mut record = 0;
    if set & !NORMALISED != 0 {
        record += size_of::<OptionRecord>();
    }
    if set & NORMALISED != 0 {
        record += size_of::<NormalisedRecord>();
    }
    record += super::parts::bytes_of_image(case);
    // In the store, and in a message on its way out and in.
    [owned + record, 3 * halo + record]
}

impl Simulation {
    /// What this rank's particles show to others for the options, after the first sweep of a step
    /// `dt` (s).
    pub(super) fn prepare_options(&mut self, dt: f64) {
        let store = &mut self.store;
        let owned = store.owned();
        if self.options.set & BALSARA != 0 {
            store.viscosity_limiter[..owned]
                .par_iter_mut()
                .with_min_len(GRAIN)
                .zip(&store.velocity_gradient)
                .zip((&store.sound_speed, &store.smoothing_length))
                .for_each(|((factor, l), (&c, &h))| *factor = limiter(l, c, h));
        }
        if self.options.set & CONDUCTION != 0 {
            store.predicted_energy[..owned]
                .par_iter_mut()
                .with_min_len(GRAIN)
                .zip((&store.specific_energy, &store.d_specific_energy_dt))
                .for_each(|(predicted, (e, de))| *predicted = e + 0.5 * dt * de);
        }
    }

    /// Records of halo particles and their images, or of this rank's particles and theirs.
    pub(super) fn fill_options(&mut self, halo: bool) {
        let set = self.options.set;
        if set & NORMALISED != 0 {
            self.fill_normalised(halo);
        }
        // A compiled set may have more options than the case: then they show neutral data.
        if set & !NORMALISED == 0 {
            return;
        }
        let store = &self.store;
        let images = self.search.sequence.images();
        let epsilon = self.options.sph.artificial_stress;
        resize(&mut self.options.records, images.len());
        let records = self.options.records.par_iter_mut().zip(images);
        records.with_min_len(GRAIN).for_each(|(record, image)| {
            let (i, code) = (image.base(), image.code());
            if (i >= store.owned()) != halo {
                return;
            }
            *record = OptionRecord::NEUTRAL;
            if set & ARTIFICIAL_STRESS != 0 {
                let stress = &store.deviatoric_stress[i];
                let repulsion = repulsion(epsilon, store.pressure[i], stress, store.density[i]);
                record.repulsion = Mirrors::reflect_symmetric(&repulsion, code);
            }
            if set & BALSARA != 0 {
                record.half_limiter = 0.5 * store.viscosity_limiter[i];
            }
            if set & CONDUCTION != 0 {
                record.specific_energy = store.predicted_energy[i];
            }
        });
    }

    /// Stresses along corrected gradients, of the same.
    fn fill_normalised(&mut self, halo: bool) {
        let store = &self.store;
        let images = self.search.sequence.images();
        resize(&mut self.options.normalised, images.len());
        let records = self.options.normalised.par_iter_mut().zip(images);
        records.with_min_len(GRAIN).for_each(|(record, &image)| {
            if (image.base() >= store.owned()) == halo {
                *record = normalised::record(store, image);
            }
        });
    }

    /// XSPH: the rest of the drift of a step `dt` (s). The mean velocity of the neighbours is that
    /// of the last sums, taken with the velocities predicted for the beginning of this step.
    ///
    /// Particles that feel contact move with their own velocity: the energy of contact is a
    /// function of their positions, and its balance holds only where force times velocity is work.
    /// So do particles that a load drives, along the axes that it prescribes.
    pub(super) fn drift_with_neighbours(&mut self, dt: f64) {
        if self.options.set & XSPH == 0 {
            return;
        }
        let store = &mut self.store;
        let (contact, loads, bits) = (&store.contact_acceleration, &self.loads, &store.load);
        (&mut store.position, &store.velocity_correction)
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
}
