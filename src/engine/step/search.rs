//! Who is whose neighbour, and who sleeps.

use super::candidate::{Criteria, criteria_fields};
use super::simulation::Simulation;
use super::timers::Phase;
use crate::contact::Connectivity;
use crate::domain::Decomposition;
use crate::sph::with_formulation;
use comm::Comm;
use particles::Image;

impl Simulation {
    /// Who is whose neighbour at the current positions, over ranks and symmetry planes. Collective.
    pub(super) fn search(&mut self, comm: &Comm) {
        let Self {
            particles,
            state,
            timers,
            lists,
            partition,
            halo,
            sph,
            contact,
            labels,
            dormant,
            ..
        } = self;
        dormant.follow(particles);
        let links = contact.connectivity.is_active();
        let (asleep, all_listed) = dormant.leave_out(state.step, particles.owned(), links);
        let all = (&mut *particles, asleep);
        halo.exchange_motion(comm, partition.reaches(), all, |particles, i| {
            sph.smoothing.reach(particles, i)
        });
        timers.lap(Phase::HaloMotion);
        let images = particles.owned() + halo.others().len();
        let meetings = contact.table.has_pairs().then_some(&contact.table.foreign);
        let (scratch, resting) = sph.before_rates(images);
        let connectivity = &mut contact.connectivity;
        connectivity.sample(particles, |i| resting.holds(particles, i));
        let rests = |image: Image| {
            // At the start nobody has been asked for anything yet.
            state.step > 0
                && connectivity.lets_rest(particles, image)
                && resting.holds(particles, image.base())
        };
        let is_due = connectivity.is_due(state.step);
        let rests = (rests, !(is_due || all_listed));
        lists.build((particles, asleep), halo.images(), meetings, rests, scratch);
        let mirrors = halo.mirrors();
        connectivity.separate(particles, lists, mirrors);
        if let Some(table) = meetings {
            lists.build_foreign(particles, table);
        }
        lists.join();
        timers.lap(Phase::Neighbours);
        if is_due {
            labels.begin(particles.part.len());
            Connectivity::link(lists, labels.sets());
            dormant.join(labels.sets());
            labels.settle(comm, Some(halo), &particles.id, particles.owned());
            Connectivity::tell(labels.members(), particles);
            timers.lap(Phase::Neighbours);
        }
    }

    /// Lets sleep what rests far from what does not, and wakes what that has come near to.
    pub(super) fn settle(&mut self, comm: &Comm) {
        if self.poison {
            return;
        }
        let (particles, range) = (&self.particles, self.contact.table.longest_range());
        let rules = (self.case.time_step, self.loads.gravity);
        let region = self.partition.slabs().region(comm.rank());
        let (sph, limits) = (&self.sph, &self.step_control.limits);
        let links = self.contact.connectivity.is_active();
        with_formulation!(self.case.sph.form, Form => {
            let fields = criteria_fields!(particles);
            let criteria = Criteria::<Form>::new(fields, sph, limits, rules);
            let near = (&self.lists, range);
            let within = (&region, links.then_some(&mut self.labels));
            self.dormant.settle(particles, near, within, &criteria);
        });
        self.dormant.count_work(&mut self.particles.work);
    }
}
