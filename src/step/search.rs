//! Who is whose neighbour.

use super::simulation::Simulation;
use super::timers::Phase;
use crate::comm::Comm;
use crate::contact::{Connectivity, EVERY};
use crate::domain::Halo;
use crate::fragments::Labels;
use crate::neighbours::Lists;
use crate::particles::{Image, ParticleStore};

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
        if state.step.is_multiple_of(EVERY) {
            dormant.wake();
        }
        dormant.follow(particles);
        let asleep = &dormant.asleep;
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
        let rests = (rests, !connectivity.is_due(state.step));
        lists.build((particles, asleep), halo, meetings, rests, scratch);
        let mirrors = halo.mirrors();
        connectivity.separate(particles, lists, mirrors);
        if let Some(table) = meetings {
            lists.build_foreign(particles, table);
        }
        lists.join();
        timers.lap(Phase::Neighbours);
        if connectivity.is_due(state.step) {
            tell_parts(comm, (lists, halo), particles, labels);
            timers.lap(Phase::Neighbours);
        }
    }
}

/// Finds anew who is of which part of a body. Collective.
fn tell_parts(
    comm: &Comm,
    (lists, halo): (&Lists, &mut Halo),
    particles: &mut ParticleStore,
    labels: &mut Labels,
) {
    labels.begin(particles.part.len());
    Connectivity::link(lists, labels.sets());
    labels.settle(comm, Some(halo), &particles.id, particles.owned());
    Connectivity::tell(labels.members(), particles);
}
