//! The simulation: the phases of a rank's part of a running case, and the step that goes through them.

use super::accounts::{Accounts, MeasureInputs, TotalsInputs};
use super::candidate::{Candidate, StepControl};
use super::contact_stress;
use super::error::{self, SetupError, StepError};
use super::fields::{store_of, unused_fields};
use super::flight::FlightInputs;
use super::integrate;
use super::removal::{Removal, RemovalInputs};
use super::restored::{Beginning, require_own};
use super::search::{ActivityInputs, ListInputs, Search, finds_folds};
use super::setup;
use super::space::Space;
use super::timers::{Phase, Timers};
use crate::contact::{Contact, ContactTable};
use crate::diagnose::{
    Booked, Leave, LoadState, NumericalFailure, Passed, Reason, Removed, RunState, Votes, Worst,
};
use crate::domain::{Halo, InitialLayout, NestedSlabs, Partition};
use crate::gravity::SelfGravity;
use crate::loads::Loads;
use crate::measure::Gauges;
use crate::sph::{Side, Sph, Step, with_formulation};
use comm::Comm;
use model::{Axis, Case, SphForm};
use particles::{HaloPhase, Mirrors, ParticleStore};

/// One rank's part of a running case.
pub struct Simulation {
    /// The case.
    pub case: Case,
    /// This rank's particles.
    pub particles: ParticleStore,
    /// The scalar state, equal on all ranks.
    pub state: RunState,
    /// Seconds by phase, and the particle updates done in them.
    pub timers: Timers,
    /// The choice of time steps, requests to stop, and a switch for tests.
    pub step_control: StepControl,
    /// Partition of space among ranks, and halo.
    pub(super) space: Space,
    /// Neighbour lists, inactive particles, and pieces of bodies.
    pub search: Search,
    /// Sums of SPH.
    pub(super) sph: Sph,
    /// Contact between bodies.
    pub(super) contact: Contact,
    /// Prescribed velocities, absorbing zones, rigid surfaces and gravity.
    pub(super) loads: Loads,
    /// Attraction of all particles by each other, if there is any.
    pub(super) self_gravity: Option<SelfGravity>,
    /// Sums over particles, and measures.
    pub(super) accounts: Accounts,
    /// Particles that are taken out or frozen.
    pub(super) removal: Removal,
}

impl Simulation {
    /// Fills the bodies of a case, each rank its own brick, and evaluates the first forces.
    /// Collective.
    ///
    /// # Errors
    /// The same on all ranks if the case has no particles or too many, or blows up at once.
    pub fn start(case: Case, comm: &Comm) -> Result<Self, SetupError> {
        let layout = InitialLayout::new(&case).ok_or(SetupError::Empty)?;
        let partition = Partition::new(&case, comm, &layout);
        let mut simulation = Self::empty(case, comm, &layout, partition);
        let Self {
            case,
            particles,
            state,
            space,
            loads,
            ..
        } = &mut simulation;
        setup::populate(comm, case, loads, &mut space.partition, particles)?;
        loads.begin_free(comm, case, particles, &mut state.rigid);
        simulation.begin(comm)?;
        simulation.open_departures();
        Ok(simulation)
    }

    /// Takes up a run from its saved scalar state and any share of its saved particles.
    /// Collective.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn resume(
        case: Case,
        comm: &Comm,
        state: RunState,
        particles: ParticleStore,
    ) -> Result<Self, SetupError> {
        let layout = InitialLayout::new(&case).ok_or(SetupError::Empty)?;
        let partition = Partition::none(&case, comm, &layout);
        let mut simulation = Self::empty(case, comm, &layout, partition);
        let beginning = Beginning {
            case: &simulation.case,
            state: &simulation.state,
            loads: &simulation.loads,
            measures: &simulation.accounts.measures,
        };
        require_own(comm, &beginning, &state, &particles)?;
        (simulation.state, simulation.particles) = (state, particles);
        simulation.open_departures();
        let Self {
            case,
            particles,
            state,
            space,
            sph,
            contact,
            removal,
            ..
        } = &mut simulation;
        sph.restore(&state.total, state.stretch);
        removal.restore(comm, particles, unused_fields(case, &contact.table));
        space.partition.begin(comm, particles, |particles, i| {
            sph.smoothing.reach(particles, i)
        });
        setup::limit_count(comm, simulation.particles.owned() as u64)?;
        Ok(simulation)
    }

    /// A case without particles.
    fn empty(case: Case, comm: &Comm, layout: &InitialLayout, partition: Partition) -> Self {
        let contact = Contact::new(&case);
        let table = &contact.table;
        let loads = Loads::new(&case, comm.is_root());
        let accounts = Accounts::new(&case, table);
        let particles = store_of(&case);
        Self {
            removal: Removal::new(&particles),
            particles,
            state: RunState {
                loads: vec![LoadState::default(); case.load_names().count()],
                passed: vec![Passed::default(); accounts.measures.witnesses.ledgers()],
                total: case.bodies.iter().map(|body| body.total).collect(),
                rigid: loads.free_bodies(),
                ..RunState::default()
            },
            timers: Timers::default(),
            step_control: StepControl::new(&case, table, comm),
            space: Space {
                partition,
                halo: Halo::new(Mirrors::of(&case)),
            },
            search: Search::new(&case, table, layout),
            sph: Sph::new(&case, comm.size(), &contact.table.groups, layout),
            loads,
            self_gravity: SelfGravity::new(&case),
            accounts,
            contact,
            case,
        }
    }

    /// Ledgers of particles that leave the box of interest, which a case may have from a restart on.
    fn open_departures(&mut self) {
        if self.case.domain.keep.is_some() {
            let bodies = self.case.bodies.len();
            self.state.departed.resize(bodies, Removed::default());
        }
    }

    /// First forces, sums and time step. Collective.
    fn begin(&mut self, comm: &Comm) -> Result<(), SetupError> {
        self.migrate(comm);
        // The first search finds the pieces of bodies, and the order of the store.
        self.find_neighbours(comm);
        self.search
            .restore_order(&mut self.particles, &mut self.sph);
        self.find_neighbours(comm);
        let mut capped = [(self.contact).begin(&mut self.particles, &self.search.lists)];
        comm.sum_i64(&mut capped);
        self.state.capped_reliefs = capped[0];
        self.sum(comm, 0.0);
        let candidate = self.kick(0.0);
        let candidate = self.book_step(comm, 0.0, candidate);
        let Self {
            case,
            particles,
            state,
            search,
            loads,
            accounts,
            ..
        } = self;
        let inputs = TotalsInputs {
            case,
            active: search.active(particles),
            loads,
        };
        state.initial = accounts.totals(comm, inputs, state);
        state.angular_momentum_scale = (!case.axisymmetric).then_some(0.0);
        state.worst = Worst::default();
        accounts.diagnose(comm, state, inputs);
        state.worst.nearest = None;
        self.choose_step(comm, candidate)?;
        let Self {
            case,
            particles,
            state,
            space,
            search,
            accounts,
            ..
        } = self;
        let inputs = MeasureInputs {
            case,
            particles,
            lists: &search.lists,
            mirrors: space.halo.mirrors(),
        };
        accounts.begin_measures(comm, state, inputs);
        Ok(())
    }

    /// One step of kick–drift–kick. Collective.
    ///
    /// # Errors
    /// The same on all ranks if any particle's state is NaN or out of range.
    pub fn advance(&mut self, comm: &Comm) -> Result<(), StepError> {
        let (dt, reason) = self.state.next_step(self.case.run.end_time);
        let end = match reason {
            Reason::End => self.case.run.end_time,
            _ => self.state.time + dt,
        };
        if self.step_control.poison {
            self.particles.poison();
        }
        self.timers.skip();
        self.kick_and_drift(dt, end);
        self.timers.lap(Phase::Integrate);
        self.balance(comm);
        self.timers.lap(Phase::Balance);
        self.migrate(comm);
        self.timers.lap(Phase::Migrate);
        self.find_neighbours(comm);
        self.sum(comm, dt);
        let candidate = self.kick(dt);
        self.update_activity(comm);
        self.timers.lap(Phase::Integrate);
        self.state.step += 1;
        self.state.time = end;
        (self.state.last_dt, self.state.last_reason) = (dt, reason);
        let candidate = self.book_step(comm, dt, candidate);
        self.timers.updates += self.particles.owned() as u64;
        let witnesses = &mut self.accounts.measures.witnesses;
        witnesses.watch(&mut self.particles, &self.state);
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
            space,
            search,
            sph,
            loads,
            accounts: Accounts { sums, .. },
            ..
        } = self;
        loads.prepare(case, state.time, end);
        loads.book(particles, dt, true);
        loads.book_drag(particles);
        loads.book_pressures(particles, dt, true);
        state.book_first_half(loads, dt);
        loads.advance_free(&mut state.rigid, dt);
        particles.resize_halo(0);
        search.activity.reactivate_moved(particles);
        let active = search.active_mut(particles);
        let work = integrate::kick_and_drift(active, loads, &sph.smoothing, dt);
        sums.contact_work.merge(&work);
        sph.drift(particles, loads, dt);
        loads.carry_free(particles, &state.rigid, dt);
        sums.cross_planes(particles, space.halo.mirrors(), loads);
    }

    /// Gives each rank its share of the work where it pays, and every few steps particles in memory the
    /// order of the last search. Collective.
    fn balance(&mut self, comm: &Comm) {
        let Self {
            particles,
            state,
            timers,
            space,
            search,
            sph,
            ..
        } = self;
        if search.lists.is_order_due {
            search.lists.is_order_due = !search.restore_order(particles, sph);
        }
        // After the next search, when those that change ranks now have found their place.
        search.lists.is_order_due |= space.partition.is_regular(state.step);
        if space.partition.is_due(state.step) {
            let (step, busy) = (state.step, timers.busy());
            space.balance(comm, particles, &sph.smoothing, step, busy);
            let region = space.region(comm);
            search.activity.reactivate_near(&region, particles.owned());
        }
    }

    /// Sends particles to the ranks that own where they are. Collective.
    fn migrate(&mut self, comm: &Comm) {
        let smoothing = &self.sph.smoothing;
        self.space.migrate(comm, &mut self.particles, smoothing);
    }

    /// Neighbours at the current positions, over ranks and symmetry planes. Collective.
    fn find_neighbours(&mut self, comm: &Comm) {
        let Self {
            particles,
            state,
            timers,
            space,
            search,
            sph,
            contact,
            ..
        } = self;
        let active = search.begin(particles, contact, state.step);
        space.exchange_motion(comm, active, &sph.smoothing);
        timers.lap(Phase::HaloMotion);
        search.list_neighbours(ListInputs {
            particles,
            halo: &space.halo,
            sph,
            contact,
            step: state.step,
        });
        timers.lap(Phase::Neighbours);
        if contact.connectivity.is_due(state.step) {
            search.label_pieces(comm, particles, &mut space.halo);
            timers.lap(Phase::Neighbours);
        }
    }

    /// Stress, accelerations and rates from the predicted velocities, densities and energies, over the
    /// neighbours of the last search, after a step `dt` (s). Collective.
    fn sum(&mut self, comm: &Comm, dt: f64) {
        let Self {
            case,
            particles,
            state,
            timers,
            space: Space { halo, .. },
            search: Search { lists, .. },
            sph,
            contact,
            loads,
            self_gravity,
            ..
        } = self;
        let step = Step {
            dt,
            last_dt: state.last_dt,
            time: state.time + dt,
            gravity: loads.gravity,
        };
        sph.rates(particles, lists, &step);
        timers.lap(Phase::Material);
        contact.measure(particles, lists, dt);
        timers.lap(Phase::ContactFractions);
        let stress = contact.halo_of_forces() | Sph::halo_of_forces(case);
        halo.post(
            comm,
            particles,
            stress,
            sph.payload().map(|payload| &*payload),
        );
        timers.lap(Phase::HaloStress);
        sph.forces(particles, lists, Side::Inner);
        timers.lap(Phase::Momentum);
        halo.finish(particles, stress, sph.payload());
        timers.lap(Phase::HaloStress);
        if contact.table.has_friction() {
            contact.resist(particles, lists, dt);
            timers.lap(Phase::ContactForces);
            halo.post(comm, particles, HaloPhase::FRICTION, None);
            timers.lap(Phase::HaloStress);
        }
        sph.forces(particles, lists, Side::Outer);
        sph.faces(particles, lists);
        timers.lap(Phase::Momentum);
        if contact.table.has_friction() {
            halo.finish(particles, HaloPhase::FRICTION, None);
            timers.lap(Phase::HaloStress);
        }
        contact.forces(particles, lists, loads, dt);
        let planes = sph.forces_of_mirrors();
        contact.sums.add_plane_forces(planes, &particles.position);
        timers.lap(Phase::ContactForces);
        if let Some(gravity) = self_gravity {
            gravity.act(comm, particles, halo.mirrors(), &mut contact.sums);
            timers.lap(Phase::SelfGravity);
        }
        loads.press_free(comm, particles, &mut state.rigid);
        if finds_folds(state.step) {
            sph.find_folds(particles, lists);
        }
        if let Some(stretch) = sph.finish(comm) {
            state.book_forms(step.time, stretch, |body| sph.tear(body));
        }
    }

    /// Second half kick of a step `dt` (s), zero at the start of a case. Returns this rank's
    /// candidate for the next one.
    fn kick(&mut self, dt: f64) -> Candidate {
        let Self {
            case,
            particles,
            state,
            step_control,
            search,
            sph,
            loads,
            accounts: Accounts { sums, .. },
            ..
        } = self;
        loads.book_drag(particles);
        loads.book_pressures(particles, dt, false);
        loads.kick_free(&mut state.rigid, dt);
        let criteria = step_control.criteria(sph, loads.gravity);
        let active = search.active_mut(particles);
        let kicked = with_formulation!(case.sph.form, Form => {
            integrate::kick::<Form>(active, loads, criteria, dt)
        });
        let kept = &search.activity.kept_candidate;
        sums.contact_work.merge(&kicked.work);
        sums.span = kicked.span;
        sums.span.join(&kept.span);
        loads.book(particles, dt, false);
        loads.relax(particles);
        kicked.candidate.min(kept.candidate)
    }

    /// Deactivates particles that rest far from all moving ones, and reactivates those that such come near to.
    fn update_activity(&mut self, comm: &Comm) {
        if self.step_control.poison {
            return;
        }
        let Self {
            case,
            particles,
            step_control,
            space,
            search,
            sph,
            contact,
            loads,
            ..
        } = self;
        search.update_activity(ActivityInputs {
            particles,
            contact,
            region: &space.region(comm),
            form: case.sph.form,
            criteria: step_control.criteria(sph, loads.gravity),
        });
    }

    /// Joins the sums of all ranks into the state, after the second half of a step `dt` (s), and this rank's
    /// candidate for the next step with those of others. Returns the first of all. Collective.
    fn book_step(&mut self, comm: &Comm, dt: f64, candidate: Candidate) -> Candidate {
        let Self {
            case,
            particles,
            state,
            step_control,
            space: Space { partition, halo },
            sph,
            contact,
            loads,
            self_gravity,
            accounts: Accounts { sums, .. },
            ..
        } = self;
        let corrects = case.sph.form != SphForm::Conventional;
        let outside = !halo.mirrors().is_empty() || loads.act() || self_gravity.is_some();
        let sums_any = contact.table.is_active() || outside || corrects;
        let mut booked = Booked {
            uncorrected: sph.uncorrected(),
            contact,
            loads,
            self_gravity: self_gravity.as_mut(),
            mirrors: halo.mirrors(),
        };
        let [work, load] = partition.count(comm, particles);
        let mut votes = Votes {
            candidate,
            requests: step_control.requests,
            work,
            load,
        };
        sums.join(comm, sums_any.then_some(&mut booked), &mut votes);
        partition.receive_work(comm, [votes.work, votes.load]);
        step_control.agreed_requests = votes.requests;
        sums.book(state, &mut booked, dt);
        votes.candidate
    }

    /// Chooses the next Δt, given the first candidate of all ranks. Collective.
    fn choose_step(&mut self, comm: &Comm, first: Candidate) -> Result<(), StepError> {
        let inputs = FlightInputs {
            case: &self.case,
            particles: &self.particles,
            table: &self.contact.table,
            loads: &self.loads,
            mirrors: self.space.halo.mirrors(),
            time: self.state.time,
        };
        let span = &self.accounts.sums.span;
        let chosen = self.step_control.choose(comm, first, &inputs, span);
        let (dt, reason) = chosen.map_err(|(kind, id)| self.failure(comm, kind, id))?;
        (self.state.dt, self.state.dt_reason) = (dt, reason);
        self.step_control.keep(&self.state);
        let limited = reason == Reason::Contact;
        self.state.worst.contact_limited_steps += u64::from(limited);
        Ok(())
    }

    /// Describes the particle `id`, wherever it is; the same text on all ranks. Collective.
    pub(super) fn failure(&self, comm: &Comm, kind: NumericalFailure, id: u64) -> StepError {
        let (case, particles) = (&self.case, &self.particles);
        error::failure(comm, case, particles, self.state.step, kind, id)
    }

    /// Every few steps takes out particles that have left the box of interest, if the case has one. After the
    /// choice of a step, which finds particles whose state is NaN. Collective.
    fn remove_departed(&mut self, comm: &Comm) -> Result<(), StepError> {
        let Self {
            case,
            particles,
            state,
            loads,
            removal,
            ..
        } = self;
        let Some(keep) = &case.domain.keep else {
            return Ok(());
        };
        if removal.choose_departed(comm, particles, loads, keep, state.step) {
            // The step is chosen once more.
            let limited = state.dt_reason == Reason::Contact;
            state.worst.contact_limited_steps -= u64::from(limited);
            self.take_out(comm, Leave::Departed)?;
        }
        Ok(())
    }

    /// Takes out the particles that have been chosen for it, and books them. Then sums the forces on the others anew where
    /// they stand, so that momentum and energy balance as before. Returns the number of particles taken out on all ranks.
    /// Collective.
    ///
    /// Velocities do not change by it, so nothing is kicked. Particles that leant on those taken out, or hung on
    /// them, are free of them from then on, as at a new surface.
    pub(super) fn take_out(&mut self, comm: &Comm, why: Leave) -> Result<u64, StepError> {
        let Self {
            case,
            particles,
            state,
            search,
            sph,
            loads,
            removal,
            ..
        } = self;
        let inactive = &search.activity.inactive;
        debug_assert!(!(removal.leaving().iter()).any(|&i| inactive.holds(i as usize)));
        let inputs = RemovalInputs {
            particles,
            state,
            loads,
            bodies: case.bodies.len(),
        };
        let count = removal.take_out(comm, why, inputs)?;
        // Sums over initial neighbours miss what has gone.
        let gone = |of: &[Removed], body: usize| of.get(body).is_some_and(|of| of.particles > 0);
        sph.release(|body| gone(&state.removed, body) || gone(&state.departed, body));
        if why == Leave::Failed {
            // Predictions of their neighbours may be spoilt.
            let owned = particles.owned();
            particles.predicted_velocity[..owned].copy_from_slice(&particles.velocity[..owned]);
            particles.predicted_density[..owned].copy_from_slice(&particles.density[..owned]);
        }
        loads.prepare(case, state.time, state.time);
        let energies = [state.contact_energy, state.self_gravity_energy];
        let worst = state.worst;
        self.find_neighbours(comm);
        self.sum(comm, 0.0);
        let candidate = self.kick(0.0);
        // The sums of a step of no length have no work in them. Its defect is taken with the energy that has
        // been lost, so the loss must be known first.
        let candidate = self.book_step(comm, 0.0, candidate);
        let left = [self.state.contact_energy, self.state.self_gravity_energy];
        for (k, gone) in self.state.leaving(why).1.into_iter().enumerate() {
            *gone += energies[k] - left[k];
        }
        self.state.worst = worst;
        self.state.book_defect();
        self.choose_step(comm, candidate)?;
        Ok(count)
    }

    /// True if the case has reached its end.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        let run = &self.case.run;
        self.state.time >= run.end_time || run.max_steps.is_some_and(|n| self.state.step >= n)
    }

    /// Completes the fields that snapshots show and no step needs. Right after a step, before the particles change.
    /// Collective.
    pub fn complete_shown(&mut self, comm: &Comm) {
        contact_stress::measure_in(self, comm);
        if let Some(total) = self.sph.total() {
            let gradients = total.gradients(&self.particles);
            self.particles.deformation_gradient[..gradients.len()].copy_from_slice(&gradients);
        }
    }

    /// Does a task, such as writing files, while the store holds this rank's frozen particles
    /// too, in place of the halo.
    pub fn with_frozen<T>(&mut self, task: impl FnOnce(&Self) -> T) -> T {
        self.removal.append_frozen(&mut self.particles);
        let result = task(self);
        self.removal.drop_frozen(&mut self.particles);
        result
    }

    /// Particles that this rank has frozen.
    #[must_use]
    pub fn frozen(&self) -> usize {
        self.removal.frozen()
    }

    /// Particles of this rank that steps leave out, as they rest far from all moving ones.
    #[must_use]
    pub fn inactive(&self) -> usize {
        self.particles.owned() - self.search.active(&self.particles).count()
    }

    /// Partition of space among ranks.
    #[must_use]
    pub fn slabs(&self) -> &NestedSlabs {
        self.space.partition.slabs()
    }

    /// The axes along which space is cut, by level.
    #[must_use]
    pub fn axes_of_slabs(&self) -> Vec<Axis> {
        let slabs = self.slabs();
        let levels = 0..slabs.levels();
        levels.map(|level| Axis::ALL[slabs.axis(level)]).collect()
    }

    /// Number of changes of levels or axes of the slabs since the start of this process.
    #[must_use]
    pub fn changes_of_slabs(&self) -> u64 {
        self.space.partition.changes()
    }

    /// Particles that this rank exchanges with others in each step.
    #[must_use]
    pub fn halo(&self) -> &Halo {
        &self.space.halo
    }

    /// Messages and bytes that this rank has sent.
    #[must_use]
    pub fn traffic(&self) -> (u64, u64) {
        let (messages, bytes) = self.space.traffic();
        let gravity = self.self_gravity.as_ref().map(SelfGravity::traffic);
        let gravity = gravity.unwrap_or_default();
        (messages + gravity.messages, bytes + gravity.bytes)
    }

    /// The contact table.
    #[must_use]
    pub fn contact(&self) -> &ContactTable {
        &self.contact.table
    }

    /// The gauges of the case.
    #[must_use]
    pub fn gauges(&self) -> &Gauges {
        &self.accounts.measures.gauges
    }

    /// Bytes that this rank holds in particle arrays, lists and buffers.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.memory_by_part().iter().map(|(_, bytes)| bytes).sum()
    }

    /// The same by what they are for.
    #[must_use]
    pub fn memory_by_part(&self) -> [(&'static str, usize); 9] {
        let Search {
            lists,
            activity,
            labels,
        } = &self.search;
        let [order, motion, neighbours, foreign] = lists.memory_by_part();
        let others = activity.memory()
            + labels.memory()
            + self.removal.memory()
            + self.loads.memory()
            + self.self_gravity.as_ref().map_or(0, SelfGravity::memory)
            + self.accounts.memory()
            + self.step_control.memory();
        [
            ("particles", self.particles.memory()),
            ("order", order),
            ("motion_records", motion),
            ("neighbours", neighbours),
            ("foreign_neighbours", foreign),
            ("stress_records", self.sph.memory()),
            ("contact", self.contact.memory()),
            ("halo_and_balance", self.space.memory()),
            ("others", others),
        ]
    }
}
