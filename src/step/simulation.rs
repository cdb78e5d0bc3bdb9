//! The simulation: everything a rank holds, and one step of it.

use std::collections::VecDeque;

use thiserror::Error;

use super::contact_phase::ContactPhase;
use super::flight::Flight;
use super::loads::LoadStep;
use super::options::OptionPhase;
use super::parts::Parts;
use super::search::Search;
use super::state::{Reason, RunState};
use super::stress_points::StressPoints;
use super::sums::StepSums;
use super::surface_forces::SurfaceForces;
use super::sweeps::Sweeps;
use super::timers::{Phase, Timers};
use super::trouble::{Limits, PastVote, TroubleKind};
use crate::comm::Comm;
use crate::contact::ContactTable;
use crate::domain::{Halo, Histogram, Migration, Paces, Slabs, balance};
use crate::model::Case;
use crate::neighbours::Chunk;
use crate::particles::{HaloPhase, ParticleStore};

/// Why a step failed; the same on all ranks.
#[derive(Debug, Clone, Error)]
pub enum StepError {
    /// A particle's state is no number or out of range.
    #[error("step {step}: particle {id} {what} ({detail})")]
    Trouble {
        /// Step in which it was found.
        step: u64,
        /// Identity of the particle.
        id: u64,
        /// What is wrong.
        kind: TroubleKind,
        /// The same in words.
        what: String,
        /// The particle's state.
        detail: String,
    },
    /// Every particle was out of range.
    #[error("step {step}: no particle is left, all were out of range")]
    NothingLeft {
        /// Step in which the last one went.
        step: u64,
    },
}

/// One rank's part of a running case.
pub struct Simulation {
    /// The case.
    pub case: Case,
    /// This rank's particles.
    pub store: ParticleStore,
    /// Particles that this rank has frozen: they are in files, and in nothing else.
    pub(super) frozen: ParticleStore,
    /// The scalar state, equal on all ranks.
    pub state: RunState,
    /// Seconds by phase.
    pub timers: Timers,
    /// Fill everything that is not state with NaN between steps: for tests.
    pub poison: bool,
    /// Spare the sums of what moves alike without stress; off to test that no bit changes, and to
    /// time the sums.
    pub spare_calm: bool,
    /// What this rank wishes (a set of bits): all ranks' wishes are joined by the next step's vote.
    pub wishes: u64,
    /// The joined wishes of all ranks as of the last vote.
    pub agreed_wishes: u64,
    /// Particle updates that this rank has made.
    pub updates: u64,
    pub(super) contact: ContactTable,
    pub(super) slabs: Slabs,
    pub(super) histogram: Histogram,
    pub(super) paces: Paces,
    pub(super) migration: Migration,
    pub(super) halo: Halo,
    pub(super) search: Search,
    pub(super) sweeps: Sweeps,
    pub(super) options: OptionPhase,
    pub(super) stress_points: StressPoints,
    pub(super) contact_phase: ContactPhase,
    pub(super) parts: Parts,
    pub(super) loads: LoadStep,
    pub(super) surface_forces: SurfaceForces,
    pub(super) sums: StepSums,
    pub(super) scratch: Vec<u64>,
    pub(super) order: Vec<u32>,
    /// The store has not been in canonical order yet.
    pub(super) unordered: bool,
    /// Particles that have crossed a symmetry plane, by task.
    pub(super) crossed: Vec<Vec<usize>>,
    pub(super) reference_h: Vec<f64>,
    pub(super) limits: Limits,
    pub(super) flight: Flight,
    /// The last votes, for post-mortems.
    pub(super) votes: VecDeque<PastVote>,
}

impl Simulation {
    /// Whether the case has reached its end.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.state.time >= self.case.run.end_time
            || self
                .case
                .run
                .max_steps
                .is_some_and(|n| self.state.step >= n)
    }

    /// One step of kick–drift–kick. Collective.
    ///
    /// # Errors
    /// The same on all ranks if any particle's state is no number or out of range.
    pub fn advance(&mut self, comm: &Comm) -> Result<(), StepError> {
        let (dt, reason) = self.next_step();
        if self.poison {
            self.store.poison();
        }
        self.timers.skip();
        let end = match reason {
            Reason::End => self.case.run.end_time,
            _ => self.state.time + dt,
        };
        self.kick_and_drift(dt, end);
        self.timers.lap(Phase::Integrate);
        self.balance_work(comm);
        self.timers.lap(Phase::Balance);
        self.migration.migrate(comm, &self.slabs, &mut self.store);
        self.timers.lap(Phase::Migrate);
        self.evaluate(comm, dt);
        let vote = self.kick(dt);
        self.timers.lap(Phase::Integrate);
        self.state.step += 1;
        self.state.time = end;
        (self.state.last_dt, self.state.last_reason) = (dt, reason);
        self.book_step(comm, dt);
        self.updates += self.store.owned() as u64;
        self.vote(comm, vote)?;
        self.timers.lap(Phase::Vote);
        Ok(())
    }

    /// Stress, accelerations and rates at the current positions, from the predicted velocities,
    /// densities and energies.
    pub(super) fn evaluate(&mut self, comm: &Comm, dt: f64) {
        self.exchange_motion(comm);
        self.timers.lap(Phase::HaloMotion);
        self.find_neighbours();
        self.find_parts(comm);
        self.timers.lap(Phase::Neighbours);
        self.velocity_gradient_and_material(dt);
        self.prepare_options(dt);
        self.timers.lap(Phase::Material);
        self.contact_fractions(dt);
        self.timers.lap(Phase::ContactFractions);
        self.post_stress(comm);
        self.timers.lap(Phase::HaloStress);
        self.momentum_and_energy(false);
        self.timers.lap(Phase::Momentum);
        self.finish_stress();
        self.timers.lap(Phase::HaloStress);
        self.momentum_and_energy(true);
        self.timers.lap(Phase::Momentum);
        self.hold_by_friction(comm, dt);
        self.contact_forces(dt);
        self.timers.lap(Phase::ContactForces);
    }

    fn balance_work(&mut self, comm: &Comm) {
        let every = self.case.domain.balance_every;
        if self.unordered {
            self.unordered = !self.restore_order();
        }
        if every == 0 || !self.state.step.is_multiple_of(every) {
            return;
        }
        // After the next search, when those that change ranks now have found their place.
        self.unordered = true;
        if comm.size() > 1 {
            let positions = &self.store.position[..self.store.owned()];
            let work = &self.store.work;
            let counted = work.iter().map(|&w| u64::from(w)).sum();
            self.paces.measure(comm, counted, self.timers.busy());
            self.slabs = balance(
                comm,
                &self.slabs,
                positions,
                work,
                &mut self.histogram,
                &self.paces,
            );
        }
    }

    fn exchange_motion(&mut self, comm: &Comm) {
        let reference_h = &self.reference_h;
        self.halo.post_motion(comm, &mut self.store, |store, i| {
            store.smoothing_length[i].max(reference_h[store.body[i] as usize])
        });
        self.halo.finish_motion(&mut self.store);
    }

    fn stress_phase(&self) -> HaloPhase {
        if self.contact.has_pairs() {
            HaloPhase::FORCES
        } else {
            HaloPhase::STRESS
        }
    }

    fn post_stress(&mut self, comm: &Comm) {
        self.halo.post(comm, &self.store, self.stress_phase());
    }

    fn finish_stress(&mut self) {
        let phase = self.stress_phase();
        self.halo.finish(&mut self.store, phase);
    }

    /// Bytes that this rank holds in particle arrays, lists and buffers.
    #[must_use]
    pub fn memory(&self) -> usize {
        let crossed: usize = self.crossed.iter().map(Vec::capacity).sum();
        let words = 8 * (self.scratch.capacity() + crossed) + 4 * self.order.capacity();
        self.store.memory()
            + self.frozen.memory()
            + self.search.memory()
            + self.sweeps.memory()
            + self.options.memory()
            + self.stress_points.memory()
            + self.contact_phase.memory()
            + self.parts.memory()
            + self.loads.memory()
            + self.surface_forces.memory()
            + self.sums.memory()
            + self.flight.memory()
            + self.halo.memory()
            + self.migration.memory()
            + self.histogram.memory()
            + self.paces.memory()
            + words
    }

    /// Neighbours in the lists of the last search, summed over this rank's particles.
    #[must_use]
    pub fn list_entries(&self) -> u64 {
        let clusters = self.search.clusters.chunks().iter().flat_map(Chunk::iter);
        clusters
            .map(|(cluster, list, _)| (cluster.lanes * list.len()) as u64)
            .sum()
    }

    /// Messages and bytes that this rank has sent.
    #[must_use]
    pub fn traffic(&self) -> (u64, u64) {
        let (halo, migration) = (self.halo.traffic(), self.migration.traffic());
        (
            halo.messages + migration.messages,
            halo.bytes + migration.bytes,
        )
    }

    /// The faces between slabs (m) and their axis.
    #[must_use]
    pub fn slabs(&self) -> &Slabs {
        &self.slabs
    }

    /// The contact table.
    #[must_use]
    pub fn contact(&self) -> &ContactTable {
        &self.contact
    }
}
