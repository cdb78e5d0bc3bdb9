//! The simulation: everything a rank holds, and one step of it.

use super::candidate::{Candidate, Criteria, StepControl};
use super::dormant::Dormant;
use super::error::{self, StepError};
use super::flight::Sky;
use super::integrate;
use super::removal::Frozen;
use super::timers::{Phase, Timers};
use crate::contact::Contact;
use crate::diagnose::{
    Booked, KeptTotals, NumericalFailure, PostMortem, Reason, RunState, StepSums, Totals, fastest,
    is_explained,
};
use crate::domain::{Decomposition, Halo, Partition};
use crate::fragments::Labels;
use crate::loads::Loads;
use crate::measure::Measures;
use crate::sph::{Side, Sph, Step, with_formulation};
use comm::Comm;
use model::{Case, SphForm};
use numerics::collector::Collector;
use particles::neighbours::Lists;
use particles::{HaloPhase, ParticleStore};

/// One rank's part of a running case.
pub struct Simulation {
    /// The case.
    pub case: Case,
    /// This rank's particles.
    pub particles: ParticleStore,
    pub(super) frozen: Frozen,
    /// Particles that are about to be taken out.
    pub(super) leaving: Vec<u32>,
    pub(super) collector: Collector,
    /// The scalar state, equal on all ranks.
    pub state: RunState,
    /// Seconds by phase, and what was done in them.
    pub timers: Timers,
    /// Fill everything that is not state with NaN between steps: for tests.
    pub poison: bool,
    /// The choice of time steps, and requests to stop.
    pub step_control: StepControl,
    /// Sorted images and neighbours.
    pub lists: Lists,
    pub(super) partition: Partition,
    pub(super) halo: Halo,
    pub(super) sph: Sph,
    pub(super) contact: Contact,
    /// What rests far from what does not.
    pub(super) dormant: Dormant,
    /// Who hangs together with whom.
    pub(super) labels: Labels,
    pub(super) loads: Loads,
    pub(super) sums: StepSums,
    pub(super) kept_totals: KeptTotals,
    pub(super) measures: Measures,
}

/// What the sums are told of a step `dt` (s) from a state.
fn step(state: &RunState, loads: &Loads, dt: f64) -> Step {
    Step {
        dt,
        last_dt: state.last_dt,
        time: state.time + dt,
        gravity: loads.gravity,
    }
}

impl Simulation {
    /// Whether the case has reached its end.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        let run = &self.case.run;
        self.state.time >= run.end_time || run.max_steps.is_some_and(|n| self.state.step >= n)
    }

    /// One step of kick–drift–kick. Collective.
    ///
    /// # Errors
    /// The same on all ranks if any particle's state is NaN or out of range.
    pub fn advance(&mut self, comm: &Comm) -> Result<(), StepError> {
        let (dt, reason) = self.state.next_step(self.case.run.end_time);
        if self.poison {
            self.particles.poison();
        }
        let end = match reason {
            Reason::End => self.case.run.end_time,
            _ => self.state.time + dt,
        };
        self.timers.skip();
        self.kick_and_drift(dt, end);
        self.timers.lap(Phase::Integrate);
        self.balance(comm);
        self.timers.lap(Phase::Balance);
        self.migrate(comm);
        self.timers.lap(Phase::Migrate);
        self.evaluate(comm, dt);
        let own = self.kick(dt);
        self.settle(comm);
        self.timers.lap(Phase::Integrate);
        self.state.step += 1;
        self.state.time = end;
        (self.state.last_dt, self.state.last_reason) = (dt, reason);
        let candidate = self.book_step(comm, dt, own);
        self.timers.updates += self.particles.owned() as u64;
        self.watch_witnesses();
        self.choose_step(comm, candidate)?;
        self.timers.lap(Phase::TimeStep);
        self.remove_departed(comm)
    }

    /// First half kick and drift of a step `dt` (s) that ends at time `end` (s).
    fn kick_and_drift(&mut self, dt: f64, end: f64) {
        let Self {
            case,
            particles,
            state,
            halo,
            sph,
            loads,
            sums,
            dormant,
            ..
        } = self;
        loads.prepare(case, state.time, end);
        loads.book(particles, dt, true);
        loads.book_drag(particles);
        state.book_first_half(loads, dt);
        particles.resize_halo(0);
        dormant.follow(particles);
        let moved = (&mut *particles, &dormant.asleep);
        let work = integrate::kick_and_drift(moved, loads, &sph.smoothing, dt);
        sums.contact_work.merge(&work);
        sph.drift(particles, loads, dt);
        sums.cross_planes(particles, halo.mirrors(), loads);
    }

    /// Gives each rank its share of the work where it pays, and every few steps particles in memory the
    /// order of the last search.
    fn balance(&mut self, comm: &Comm) {
        let Self {
            particles,
            state,
            timers,
            lists,
            sph,
            partition,
            dormant,
            ..
        } = self;
        if lists.is_order_due {
            let scratch = sph.scratch(particles.owned());
            let fixed = dormant.fixed(particles.owned());
            let all = (&mut *particles, fixed);
            lists.is_order_due = !lists.restore_order(all, scratch);
        }
        // After the next search, when those that change ranks now have found their place.
        lists.is_order_due |= partition.is_regular(state.step);
        if partition.is_due(state.step) {
            let all = (&*particles, state.step);
            partition.balance(comm, all, timers.busy(), |particles, i| {
                sph.smoothing.reach(particles, i)
            });
            let region = partition.slabs().region(comm.rank());
            dormant.withdraw(particles.owned(), &region);
        }
    }

    /// Sends particles to the ranks that own where they are. Collective.
    pub(super) fn migrate(&mut self, comm: &Comm) {
        let Self {
            particles,
            halo,
            sph,
            partition,
            ..
        } = self;
        partition.migrate(comm, particles, halo, |particles, i| {
            sph.smoothing.reach(particles, i)
        });
    }

    /// Stress, accelerations and rates at the current positions, from the predicted velocities,
    /// densities and energies. Collective.
    pub(super) fn evaluate(&mut self, comm: &Comm, dt: f64) {
        self.search(comm);
        self.sum(comm, dt);
    }

    /// The sums over the neighbours of the last search, after a step `dt` (s). Collective.
    pub(super) fn sum(&mut self, comm: &Comm, dt: f64) {
        let Self {
            particles,
            state,
            timers,
            lists,
            halo,
            sph,
            contact,
            loads,
            ..
        } = self;
        let step = step(state, loads, dt);
        sph.rates(particles, lists, &step);
        timers.lap(Phase::Material);
        contact.measure(particles, lists, dt);
        timers.lap(Phase::ContactFractions);
        let phase = contact.halo_of_forces();
        halo.post(comm, particles, phase, sph.shown().map(|shown| &*shown));
        timers.lap(Phase::HaloStress);
        sph.forces(particles, lists, Side::Inner);
        timers.lap(Phase::Momentum);
        halo.finish(particles, phase, sph.shown());
        timers.lap(Phase::HaloStress);
        sph.forces(particles, lists, Side::Outer);
        timers.lap(Phase::Momentum);
        if contact.table.has_friction() {
            contact.resist(particles, lists, dt);
            timers.lap(Phase::ContactForces);
            halo.exchange(comm, particles, HaloPhase::FRICTION);
            timers.lap(Phase::HaloStress);
        }
        contact.forces(particles, lists, loads, dt);
        let planes = sph.forces_of_mirrors();
        contact.sums.add_plane_forces(planes, &particles.position);
        timers.lap(Phase::ContactForces);
    }

    /// Second half kick of a step `dt` (s), zero at the start of a case. Gives this rank's
    /// candidate on the next one.
    pub(super) fn kick(&mut self, dt: f64) -> Candidate {
        let Self {
            case,
            particles,
            step_control,
            sph,
            loads,
            sums,
            dormant,
            ..
        } = self;
        loads.book_drag(particles);
        let rules = (case.time_step, loads.gravity);
        let kicked = with_formulation!(case.sph.form, Form => {
            let criteria = |fields| Criteria::<Form>::new(fields, sph, &step_control.limits, rules);
            integrate::kick((particles, &dormant.asleep), loads, criteria, dt)
        });
        sums.contact_work.merge(&kicked.work);
        let (candidate, span) = &dormant.told;
        sums.span = kicked.span;
        sums.span.join(span);
        loads.book(particles, dt, false);
        loads.relax(particles);
        kicked.candidate.min(*candidate)
    }

    /// Joins the sums of all ranks into the state, after the second half of a step `dt` (s), and this rank's
    /// candidate on the next step with those of others: gives the first. Collective.
    pub(super) fn book_step(&mut self, comm: &Comm, dt: f64, own: Candidate) -> Candidate {
        let corrects = self.case.sph.form != SphForm::Conventional;
        let outside = !self.halo.mirrors().is_empty() || self.loads.act();
        let sums_any = self.contact.table.is_active() || outside || corrects;
        let mut booked = Booked {
            uncorrected: self.sph.uncorrected(),
            contact: &mut self.contact,
            loads: &mut self.loads,
        };
        let (mut first, mut requests) = (own, self.step_control.requests);
        let mut work = self.partition.count(comm, &self.particles);
        let joined = sums_any.then_some(&mut booked);
        self.sums
            .join(comm, joined, (&mut first, &mut requests), &mut work);
        self.partition.hear(comm, work);
        self.step_control.agreed_requests = requests;
        self.sums.book(&mut self.state, &mut booked, dt);
        first
    }

    /// Chooses the next Δt, given the first candidate of all ranks. Collective.
    pub(super) fn choose_step(&mut self, comm: &Comm, first: Candidate) -> Result<(), StepError> {
        let sky = Sky {
            case: &self.case,
            particles: &self.particles,
            table: &self.contact.table,
            loads: &self.loads,
            mirrors: self.halo.mirrors(),
            time: self.state.time,
        };
        let chosen = self.step_control.choose(comm, first, &sky, &self.sums.span);
        let (dt, reason) = chosen.map_err(|(kind, id)| self.failure(comm, kind, id))?;
        (self.state.dt, self.state.dt_reason) = (dt, reason);
        self.step_control.keep(&self.state);
        let limited = reason == Reason::Contact;
        self.state.worst.contact_limited_steps += u64::from(limited);
        Ok(())
    }

    /// Describes the particle `id`, wherever it is; the same text on all ranks. Collective.
    fn failure(&self, comm: &Comm, kind: NumericalFailure, id: u64) -> StepError {
        let what = (self.state.step, kind, id);
        error::failure(comm, &self.case, &self.particles, what)
    }

    /// Sums over all particles, into the state, with the errors that follow from them, and the
    /// extremes since the last row. Collective.
    pub fn diagnose(&mut self, comm: &Comm) {
        self.join_extremes(comm);
        let totals = self.totals(comm);
        self.state.book_totals(totals, self.loads.gravity);
    }

    pub(super) fn totals(&mut self, comm: &Comm) -> Totals {
        let (particles, loads) = (&self.particles, &self.loads);
        let (kept, asleep) = (&mut self.kept_totals, &self.dormant.asleep);
        let contact_energy = self.state.contact_energy;
        let mut totals = Totals::of(particles, (kept, asleep), loads, contact_energy, comm);
        if self.case.may_fail() {
            totals.add_failure(particles, (kept, asleep), loads, comm);
        }
        totals.add_yielded(particles, loads, comm);
        totals
    }

    /// Joins the extremes of all ranks into the state: before rows and checkpoints. Collective.
    pub fn join_extremes(&mut self, comm: &Comm) {
        self.sums.join_extremes(comm, &mut self.state);
    }

    /// Whether the kinetic energy, as of the last [`Simulation::diagnose`], can have come from
    /// anywhere. Collective.
    ///
    /// # Errors
    /// The same on all ranks: [`StepError::Failure`] of the fastest particle if it cannot.
    pub fn check_gain(&self, comm: &Comm) -> Result<(), StepError> {
        let hidden = self.step_control.limits.hidden_energy;
        if is_explained(&self.state, hidden, self.case.numerical_limits.gain_max) {
            return Ok(());
        }
        let id = fastest(comm, &self.particles, &self.loads);
        Err(self.failure(comm, NumericalFailure::Gain, id))
    }

    /// What is about the particle `id`, on the rank `rank` that owns it; nothing on others.
    #[must_use]
    pub fn post_mortem(&self, id: u64, rank: usize) -> Option<PostMortem> {
        let reach = 4.0 * self.sph.smoothing.longest();
        let past = self.step_control.past();
        PostMortem::of((id, rank), &self.particles, reach, &self.state, past)
    }

    /// Does something, such as writing files, while the store holds this rank's frozen particles
    /// too, in place of the halo.
    pub fn with_frozen<T>(&mut self, task: impl FnOnce(&Self) -> T) -> T {
        self.frozen.append_to(&mut self.particles);
        let result = task(self);
        self.frozen.take_from(&mut self.particles);
        result
    }
}
