//! The search for neighbours, and for the particles that need none.

use super::activity::{Activity, Surroundings};
use super::candidate::{Criteria, CriteriaInputs, criteria_fields};
use crate::contact::{Connectivity, Contact, ContactTable};
use crate::domain::{Halo, InitialLayout};
use crate::fragments::Labels;
use crate::sph::{Sph, with_formulation};
use comm::Comm;
use model::{Case, SphForm};
use particles::neighbours::Lists;
use particles::{Active, ActiveMut, Image, ParticleStore};
use populate::Brick;

/// The neighbours of particles, those that rest far from all moving ones, and the pieces of bodies.
pub struct Search {
    /// Sorted images and their neighbours.
    pub lists: Lists,
    pub(super) activity: Activity,
    pub(super) labels: Labels,
}

/// Inputs of the neighbour lists, after the exchange of motion.
pub(super) struct ListInputs<'a> {
    pub particles: &'a ParticleStore,
    pub halo: &'a Halo,
    pub sph: &'a mut Sph,
    pub contact: &'a mut Contact,
    /// Steps done.
    pub step: u64,
}

/// Inputs of the choice of inactive particles, after a step.
pub(super) struct ActivityInputs<'a> {
    pub particles: &'a mut ParticleStore,
    pub contact: &'a Contact,
    /// This rank's part of space.
    pub region: &'a Brick,
    pub form: SphForm,
    pub criteria: CriteriaInputs<'a>,
}

/// Steps between two looks for bodies of the total form that meet themselves.
const FOLDS_EVERY: u64 = 10;

/// True if bodies of the total form that meet themselves are looked for at a step.
pub(super) fn finds_folds(step: u64) -> bool {
    step.is_multiple_of(FOLDS_EVERY)
}

impl Search {
    pub(super) fn new(case: &Case, table: &ContactTable, layout: &InitialLayout) -> Self {
        Self {
            lists: Lists::new(case, table.groups.clone(), &layout.boxes, layout.longest),
            activity: Activity::new(case),
            labels: Labels::default(),
        }
    }

    /// Owned particles, of which the inactive ones are left out.
    pub(super) fn active<'a>(&'a self, particles: &'a ParticleStore) -> Active<'a> {
        Active {
            particles,
            inactive: &self.activity.inactive,
        }
    }

    /// As [`Self::active`], for those who write.
    pub(super) fn active_mut<'a>(&'a self, particles: &'a mut ParticleStore) -> ActiveMut<'a> {
        ActiveMut {
            particles,
            inactive: &self.activity.inactive,
        }
    }

    /// Chooses the particles that the search of a step is among, and returns them.
    pub(super) fn begin<'a>(
        &'a mut self,
        particles: &'a mut ParticleStore,
        contact: &Contact,
        step: u64,
    ) -> ActiveMut<'a> {
        self.activity.reactivate_moved(particles);
        let links = contact.connectivity.is_active();
        self.activity.begin_search(step, particles.owned(), links);
        ActiveMut {
            particles,
            inactive: self.activity.unlisted(),
        }
    }

    /// Lists the neighbours of particles at the current positions, over ranks and symmetry planes.
    pub(super) fn list_neighbours(&mut self, inputs: ListInputs) {
        let ListInputs {
            particles,
            halo,
            sph,
            contact,
            step,
        } = inputs;
        let (lists, activity) = (&mut self.lists, &self.activity);
        let active = Active {
            particles,
            inactive: activity.unlisted(),
        };
        let images = particles.owned() + halo.others().len();
        let foreign = contact.table.has_pairs().then_some(&contact.table.foreign);
        // The bodies' own lists serve contact, and the search for folds.
        let links = foreign.is_some() || contact.connectivity.is_active();
        sph.mark(lists, !(links || finds_folds(step)));
        let (scratch, resting, faces) = sph.before_rates(images);
        let connectivity = &mut contact.connectivity;
        connectivity.sample(particles, |i| resting.holds(particles, i));
        let rests = |image: Image| {
            // At the start there are no rates yet.
            step > 0
                && !faces.has(particles.body[image.slot()])
                && connectivity.lets_rest(particles, image)
                && resting.holds(particles, image.slot())
        };
        let spared = !(connectivity.is_due(step) || activity.lists_all());
        lists.build(active, halo.images(), foreign, rests, spared, scratch);
        connectivity.separate(particles, lists, halo.mirrors());
        if let Some(table) = foreign {
            lists.build_foreign(particles, table);
        }
        lists.join();
        sph.list_initial(active, halo.images());
    }

    /// Labels the pieces of bodies that no chain of neighbours connects. Collective.
    pub(super) fn label_pieces(
        &mut self,
        comm: &Comm,
        particles: &mut ParticleStore,
        halo: &mut Halo,
    ) {
        let labels = &mut self.labels;
        labels.begin(particles.part.len());
        Connectivity::link(&self.lists, labels.sets());
        self.activity.join_links(labels.sets());
        labels.finish(comm, Some(halo), &particles.id, particles.owned());
        Connectivity::set_labels(labels.members(), particles);
    }

    /// Puts active particles in memory into the order of the last search. Returns whether there was one among these
    /// particles.
    pub(super) fn restore_order(&mut self, particles: &mut ParticleStore, sph: &mut Sph) -> bool {
        let owned = particles.owned();
        let active = ActiveMut {
            particles,
            inactive: self.activity.fixed(owned),
        };
        self.lists.restore_order(active, sph.scratch(owned))
    }

    /// Deactivates particles that rest far from all moving ones, and reactivates those that such come near to.
    pub(super) fn update_activity(&mut self, inputs: ActivityInputs) {
        let ActivityInputs {
            particles,
            contact,
            region,
            form,
            criteria,
        } = inputs;
        let links = contact.connectivity.is_active();
        let surroundings = Surroundings {
            lists: &self.lists,
            contact_range: contact.table.longest_range(),
            region,
            labels: links.then_some(&mut self.labels),
        };
        with_formulation!(form, Form => {
            let criteria = Criteria::<Form>::new(criteria_fields!(particles), criteria);
            self.activity.update(particles, surroundings, &criteria);
        });
        self.activity.count_work(&mut particles.work);
    }
}
