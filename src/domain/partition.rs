//! Who owns which particles, kept even while they move.

use rayon::prelude::*;

use super::balance::Balance;
use super::choice::Choice;
use super::halo::{Halo, Reaches};
use super::migrate::Migration;
use super::nested::NestedSlabs;
use super::outset::Outset;
use super::rank_speed::RankSpeeds;
use crate::comm::{Comm, Traffic};
use crate::model::Case;
use crate::particles::ParticleStore;

/// The slabs of a run, of one level or more, and what their balance and the moves between them need.
pub struct Partition {
    slabs: NestedSlabs,
    balance: Balance,
    rank_speeds: RankSpeeds,
    migration: Migration,
    /// Where levels are to be chosen.
    choice: Option<Choice>,
    /// How often levels or axes have changed.
    changes: u64,
    /// Steps between two balances; zero for none.
    every: u64,
    /// Largest reach of the particles of all ranks when they last changed ranks (m).
    farthest: f64,
}

/// Balances from one look at levels and axes to the next.
const REVISED: u64 = 8;

impl Partition {
    /// Slabs with an even number of particles, of which none is created. Collective.
    #[must_use]
    pub fn new(case: &Case, comm: &Comm, outset: &Outset) -> Self {
        let mut balance = Balance::default();
        let slabs = outset.slabs(case, comm, (comm.size(), None), &mut balance);
        Self::with(slabs, balance, case, outset)
    }

    /// All particles on the first rank, until they are [dealt](Self::deal).
    #[must_use]
    pub fn none(case: &Case, comm: &Comm, outset: &Outset) -> Self {
        let levels = outset.known_levels(case, comm.size()).unwrap_or(1);
        let slabs = NestedSlabs::on_first(outset.axes, levels, comm.size());
        Self::with(slabs, Balance::default(), case, outset)
    }

    fn with(slabs: NestedSlabs, balance: Balance, case: &Case, outset: &Outset) -> Self {
        let is_open = outset.known_levels(case, slabs.ranks()).is_none();
        Self {
            choice: is_open.then(|| Choice::new(case)),
            changes: 0,
            slabs,
            balance,
            rank_speeds: RankSpeeds::default(),
            migration: Migration::default(),
            every: case.domain.balance_every,
            farthest: 0.0,
        }
    }

    /// The slabs.
    #[must_use]
    pub fn slabs(&self) -> &NestedSlabs {
        &self.slabs
    }

    /// The slabs, and what reaches farthest of all particles since the last [`Self::migrate`] (m).
    #[must_use]
    pub fn reaches(&self) -> Reaches<'_> {
        Reaches {
            slabs: &self.slabs,
            farthest: self.farthest,
        }
    }

    /// Whether slabs are balanced at a step.
    #[must_use]
    pub fn is_due(&self, step: u64) -> bool {
        self.every != 0 && step.is_multiple_of(self.every)
    }

    /// Moves faces at a step so that each rank gets its share of work, given the seconds that this rank
    /// has worked; now and then revises levels and axes. Collective.
    pub fn balance(
        &mut self,
        comm: &Comm,
        (particles, step): (&ParticleStore, u64),
        busy: f64,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        if comm.size() == 1 {
            return;
        }
        // same bits in any order: whole numbers
        let counted = particles.work.par_iter().map(|&w| u64::from(w)).sum();
        self.rank_speeds.measure(comm, counted, busy);
        self.cut(comm, particles);
        if step > 0 && step.is_multiple_of(REVISED * self.every) {
            let before = (self.slabs.levels(), self.slabs.axes());
            self.revise(comm, particles, reach);
            let is_new = before != (self.slabs.levels(), self.slabs.axes());
            self.changes += u64::from(is_new);
        }
    }

    /// Takes the levels and axes that suit the particles, where the case leaves them open. Collective.
    fn revise(
        &mut self,
        comm: &Comm,
        particles: &ParticleStore,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        if let Some(choice) = &mut self.choice {
            let positions = &particles.position[..particles.owned()];
            let all = (positions, particles.work.as_slice());
            let by = (&mut self.balance, &self.rank_speeds);
            choice.revise(comm, &mut self.slabs, by, all, |i| reach(particles, i));
        }
    }

    /// [`Self::deal`], in slabs of the levels and axes that suit the particles. Collective.
    pub fn begin(
        &mut self,
        comm: &Comm,
        particles: &mut ParticleStore,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        self.cut(comm, particles);
        self.revise(comm, particles, reach);
        self.hand_out(comm, particles);
    }

    /// Cuts slabs anew for any shares of all particles, and deals these to the ranks. Collective.
    pub fn deal(&mut self, comm: &Comm, particles: &mut ParticleStore) {
        self.cut(comm, particles);
        self.hand_out(comm, particles);
    }

    /// Deals any shares of all particles to the ranks. Collective.
    fn hand_out(&mut self, comm: &Comm, particles: &mut ParticleStore) {
        self.migration
            .migrate(comm, &self.slabs, particles, &[], |_, _| 0.0);
        // Its buffers have carried whole shares of the model; never again so much.
        self.migration = Migration::default();
    }

    fn cut(&mut self, comm: &Comm, particles: &ParticleStore) {
        let positions = &particles.position[..particles.owned()];
        let all = (positions, particles.work.as_slice());
        self.balance
            .cut(comm, &mut self.slabs, all, &self.rank_speeds);
    }

    /// Sends every particle to the rank whose slab it is in, among the peers of the last `halo`
    /// if no particle goes farther. Drops the halo; the order of the store changes. Collective.
    pub fn migrate(
        &mut self,
        comm: &Comm,
        particles: &mut ParticleStore,
        halo: &Halo,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        let near = halo.peers();
        self.farthest = self
            .migration
            .migrate(comm, &self.slabs, particles, near, reach);
    }

    /// How often levels or axes have changed since the start of this process.
    #[must_use]
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Messages and bytes sent so far.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        self.migration.traffic()
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.migration.memory()
            + self.balance.memory()
            + self.rank_speeds.memory()
            + self.choice.as_ref().map_or(0, Choice::memory)
            + 8 * self.slabs.faces().len()
    }
}
