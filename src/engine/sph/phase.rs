//! The SPH sums of a step.

use rayon::prelude::*;

use super::faces::Faces;
use super::formulation::{
    Conventional, Corrected, Formulation, Normalised, StressPoints, TotalBodies,
};
use super::neighbour_strain;
use super::rest::Resting;
use super::shared::Sums;
use super::signal::Signals;
use super::smoothing::Smoothing;
use super::term_records;
use crate::diagnose::Tear;
use crate::domain::{InitialLayout, Payload};
use crate::loads::Loads;
use comm::Comm;
use model::{Case, SphForm};
use numerics::kernel::Kernel;
use particles::MirrorForce;
use particles::neighbours::{Groups, Lists};
use particles::{Active, HaloImages, HaloPhase, ParticleStore};
use sums::corrected::CorrectedRecord;
use sums::momentum::StressRecord;
use sums::normalised::NormalisedRecord;
use sums::step::{Side, Step};

/// The SPH sums of a case, with what they keep from step to step.
pub struct Sph {
    /// Smoothing lengths.
    pub smoothing: Smoothing,
    form: Form,
    sums: Sums,
    /// Plastic strains of images, where materials ask for those of neighbours.
    strains: Vec<f64>,
    faces: Faces,
}

enum Form {
    Conventional(Conventional),
    Corrected(Corrected),
    Normalised(Normalised),
    StressPoints(StressPoints),
}

/// Calls `$work` with the formulation of a case as a concrete type.
macro_rules! with_form {
    ($form:expr, $name:ident => $work:expr) => {
        match $form {
            Form::Conventional($name) => $work,
            Form::Corrected($name) => $work,
            Form::Normalised($name) => $work,
            Form::StressPoints($name) => $work,
        }
    };
}

/// Calls `$work` with the formulation of a form ([`SphForm`]) as a type of this name.
macro_rules! with_formulation {
    ($form:expr, $name:ident => $work:expr) => {
        match $form {
            model::SphForm::Conventional => {
                type $name = $crate::sph::Conventional;
                $work
            }
            model::SphForm::Corrected => {
                type $name = $crate::sph::Corrected;
                $work
            }
            model::SphForm::Normalised => {
                type $name = $crate::sph::Normalised;
                $work
            }
            model::SphForm::StressPoints => {
                type $name = $crate::sph::StressPoints;
                $work
            }
        }
    };
}
pub(crate) use with_formulation;

/// Chunks whose forces of mirrors a task adds up.
const CHUNKS_OF_A_TASK: usize = 16;

impl Sph {
    /// Of a case on so many processes.
    #[must_use]
    pub fn new(case: &Case, processes: usize, groups: &Groups, layout: &InitialLayout) -> Self {
        Self {
            smoothing: Smoothing::new(case),
            form: match case.sph.form {
                SphForm::Conventional => Form::Conventional(Conventional::default()),
                SphForm::Corrected => {
                    Form::Corrected(Corrected::new(case, processes, groups, layout))
                }
                SphForm::Normalised => Form::Normalised(Normalised::default()),
                SphForm::StressPoints => Form::StressPoints(StressPoints::default()),
            },
            sums: Sums::new(case, &Kernel::new(case.extent())),
            strains: Vec::new(),
            faces: Faces::new(case, groups),
        }
    }

    /// Bytes of what each particle and image shows to others for pair terms and corrections.
    #[must_use]
    pub fn bytes_of_records(case: &Case) -> usize {
        // Beyond the records of stress, which all forms have.
        let corrected = match case.sph.form {
            SphForm::Normalised => size_of::<NormalisedRecord>() - size_of::<StressRecord>(),
            SphForm::Corrected => size_of::<CorrectedRecord>() - size_of::<StressRecord>(),
            SphForm::Conventional | SphForm::StressPoints => 0,
        };
        let faces = match case.loads.pressures[..] {
            [] => 0,
            [..] => size_of::<[f64; 6]>(),
        };
        term_records::bytes_of_records(&case.sph.terms) + corrected + faces
    }

    /// Bodies of the total form, if the case has any.
    #[must_use]
    pub fn total(&self) -> Option<&TotalBodies> {
        match &self.form {
            Form::Corrected(form) => form.total.as_deref(),
            Form::Conventional(_) | Form::Normalised(_) | Form::StressPoints(_) => None,
        }
    }

    fn total_mut(&mut self) -> Option<&mut TotalBodies> {
        match &mut self.form {
            Form::Corrected(form) => form.total.as_deref_mut(),
            Form::Conventional(_) | Form::Normalised(_) | Form::StressPoints(_) => None,
        }
    }

    /// Tells the lists of all bodies which groups have their sums elsewhere, before they are made. `spared` lists name no
    /// neighbours of these.
    pub(crate) fn mark(&self, lists: &mut Lists, spared: bool) {
        if let Some(total) = self.total() {
            lists.set_elsewhere(total.groups(), spared);
        }
    }

    /// Lists the neighbours of the initial configuration, of bodies of the total form.
    pub(crate) fn list_initial(&mut self, active: Active, halo: HaloImages) {
        if let Some(total) = self.total_mut() {
            total.list(active, halo);
        }
    }

    /// Finds bodies of the total form that meet themselves, after the sums of a step.
    pub(crate) fn find_folds(&self, particles: &ParticleStore, lists: &Lists) {
        if let Some(total) = self.total() {
            total.find_folds(particles, lists);
        }
    }

    /// Gives bodies of the total form to the corrected form for good.
    pub fn release(&mut self, leaves: impl Fn(usize) -> bool) {
        if let Some(total) = self.total_mut() {
            total.release(leaves);
        }
    }

    /// Why a body has left the total form, as far as this process knows.
    #[must_use]
    pub fn tear(&self, body: usize) -> Option<Tear> {
        self.total().and_then(|total| total.tear(body))
    }

    /// True if a body has the total form.
    #[must_use]
    pub fn is_total(&self, body: usize) -> bool {
        self.total().is_some_and(|total| total.holds(body))
    }

    /// Takes up the forms of bodies, and the factor of their reach, of a saved state.
    pub fn restore(&mut self, total: &[bool], stretch: f64) {
        self.release(|body| !total.get(body).is_some_and(|&total| total));
        self.set_stretch(stretch.max(1.0));
    }

    /// Finishes the sums of a step: bodies leave the total form, and the others reach as far as their neighbours may be.
    /// Collective.
    pub fn finish(&mut self, comm: &Comm) -> Option<f64> {
        let total = self.total_mut()?;
        let factor = total.finish(comm);
        self.set_stretch(factor);
        Some(factor)
    }

    /// Sets how much farther particles of the total form reach than by their lengths.
    pub fn set_stretch(&mut self, factor: f64) {
        for body in 0..self.sums.material_of_body.len() {
            let factor = if self.is_total(body) { factor } else { 1.0 };
            self.smoothing.set_stretch(body, factor);
        }
    }

    /// Memory for so many images that is free until [`Self::rates`].
    pub fn scratch(&mut self, images: usize) -> &mut [u64] {
        with_form!(&mut self.form, form => form.scratch(images))
    }

    /// The same, what of the case can rest, and what has faces.
    pub(crate) fn before_rates(&mut self, images: usize) -> (&mut [u64], &Resting, &Faces) {
        let scratch = with_form!(&mut self.form, form => form.scratch(images));
        (scratch, &self.sums.resting, &self.faces)
    }

    /// The first sweep: velocity gradient at the end of the step, density and stress from its mean
    /// with the gradient at the start, of owned particles; and what they show for pair terms.
    pub fn rates(&mut self, particles: &mut ParticleStore, lists: &Lists, step: &Step) {
        let mut strains = std::mem::take(&mut self.strains);
        for lists in self
            .total()
            .map(TotalBodies::lists)
            .into_iter()
            .chain([lists])
        {
            neighbour_strain::find(&mut strains, &self.sums, particles, lists);
        }
        self.strains = strains;
        let sums = &mut self.sums;
        with_form!(&mut self.form, form => form.rates(sums, particles, lists, step));
        sums.terms.prepare(particles, step.dt);
        if self.faces.is_any() {
            self.faces.correct(&self.sums, particles, lists);
        }
    }

    /// Finds the free faces that pressures act on, after the second sweep.
    pub fn faces(&mut self, particles: &mut ParticleStore, lists: &Lists) {
        if self.faces.is_any() {
            self.faces.find(&self.sums, particles, lists);
        }
    }

    /// Data of halo particles beside fields that the second sweep needs, if any.
    pub fn payload(&mut self) -> Option<&mut dyn Payload> {
        with_form!(&mut self.form, form => form.payload())
    }

    /// Records of images of the last second sweep of the corrected form, in the order of the lists.
    pub(super) fn corrected(&self) -> &[CorrectedRecord] {
        match &self.form {
            Form::Corrected(form) => form.records(),
            Form::Conventional(_) | Form::Normalised(_) | Form::StressPoints(_) => &[],
        }
    }

    /// Fields that halo particles need before the forces of stress: records of the corrected form have the state of a
    /// particle with them.
    #[must_use]
    pub fn halo_of_forces(case: &Case) -> HaloPhase {
        let records = case.sph.form == SphForm::Corrected;
        if records && !term_records::read_state(&case.sph.terms) {
            HaloPhase::STRESS
        } else {
            HaloPhase::STRESS | HaloPhase::STATE
        }
    }

    /// Bytes of it for a particle.
    #[must_use]
    pub fn bytes_shown(case: &Case) -> usize {
        match case.sph.form {
            SphForm::Corrected => size_of::<CorrectedRecord>(),
            SphForm::Conventional | SphForm::Normalised | SphForm::StressPoints => 0,
        }
    }

    /// The second sweep: accelerations by stress and viscosity, and the power they put into heat,
    /// of the receivers of a side.
    pub fn forces(&mut self, particles: &mut ParticleStore, lists: &Lists, side: Side) {
        if side == Side::Outer && particles.halo() == 0 {
            return;
        }
        let sums = &mut self.sums;
        with_form!(&mut self.form, form => form.forces(sums, particles, lists, side));
    }

    /// The drift of a step `dt` (s) beyond that by velocities.
    pub fn drift(&self, particles: &mut ParticleStore, loads: &Loads, dt: f64) {
        self.sums.terms.drift(particles, loads, dt);
        with_form!(&self.form, form => form.drift(particles, dt, &loads.gravity));
    }

    /// Forces of images behind symmetry planes in the last second sweep.
    #[must_use]
    pub fn forces_of_mirrors(
        &self,
    ) -> impl ParallelIterator<Item = impl Iterator<Item = &MirrorForce>> {
        let of_total = self.total().map_or(&[][..], TotalBodies::mirror_forces);
        let tasks = self.sums.from_mirrors.par_chunks(CHUNKS_OF_A_TASK);
        let tasks = tasks.chain(of_total.par_chunks(CHUNKS_OF_A_TASK));
        tasks.map(|chunks| chunks.iter().flat_map(|chunk| &chunk.forces))
    }

    /// Particles of this rank whose gradient had no correction in the last first sweep.
    #[must_use]
    pub fn uncorrected(&self) -> i64 {
        self.sums.uncorrected
    }

    /// Inputs of signal speeds.
    #[must_use]
    pub fn signals<'a>(
        &self,
        [sound_speed, approach_speed]: [&'a [f64]; 2],
        [correction_norm, fit_norm]: [&'a [f64]; 2],
    ) -> Signals<'a> {
        Signals {
            viscosity: self.sums.viscosity,
            dimension: self.sums.dimension,
            sound_speed,
            approach_speed,
            correction_norm,
            fit_norm,
        }
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let strains = size_of::<f64>() * self.strains.capacity();
        self.sums.memory()
            + self.faces.memory()
            + strains
            + with_form!(&self.form, form => form.memory())
    }
}
