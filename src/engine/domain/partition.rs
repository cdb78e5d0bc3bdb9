//! Ownership of particles, kept even while they move.

use rayon::prelude::*;

use super::balance::Balance;
use super::choice::Choice;
use super::halo::{Halo, Reaches};
use super::initial_layout::InitialLayout;
use super::migrate::Migration;
use super::nested::NestedSlabs;
use super::rank_speed::RankSpeeds;
use comm::{Comm, Traffic};
use model::Case;
use particles::ParticleStore;

/// The slabs of a run, of one level or more, and what their balance and the moves between them need.
pub struct Partition {
    slabs: NestedSlabs,
    balance: Balance,
    rank_speeds: RankSpeeds,
    migration: Migration,
    /// Choice of levels, if the case leaves it open.
    choice: Option<Choice>,
    /// Number of changes of levels or axes.
    changes: u64,
    /// Most steps between two balances; zero for none.
    every: u64,
    /// Loss of steps since the last balance by unevenness.
    loss: Loss,
    price: Price,
    /// Counted work of this rank since its speed was measured.
    done: u64,
    /// Largest reach of the particles of all ranks when they last changed ranks (m).
    farthest: f64,
}

/// Regular balances from one look at levels and axes to the next.
const REVISED: u64 = 8;

/// Cost of a balance in steps, at least, with the moves that follow it, and at most.
const PRICES: [f64; 2] = [0.1, 25.0];

/// Cost of a balance, as it is measured.
#[derive(Debug, Clone, Copy)]
struct Price {
    /// In steps, the same on all ranks.
    steps: f64,
    /// Step and time (s) at which the last balance ended.
    ended: Option<(u64, f64)>,
}

impl Price {
    const UNKNOWN: Self = Self {
        steps: PRICES[0],
        ended: None,
    };

    /// Takes the seconds that a balance at a step has taken, of the steps since the last one. The least that any rank has
    /// measured counts: no short delay of one does. Collective.
    fn measure(&mut self, comm: &Comm, step: u64, seconds: f64) {
        let now = comm.seconds();
        let ended = self.ended.replace((step, now));
        let Some((last, since)) = ended.filter(|ended| ended.0 < step) else {
            return;
        };
        #[allow(clippy::cast_precision_loss, reason = "a number of steps")]
        let of_step = (now - seconds - since) / (step - last) as f64;
        // Where the clock stands still nothing is measured.
        let mut price = [(seconds / of_step).max(0.0).to_bits()];
        comm.min_u64(&mut price);
        let price = f64::from_bits(price[0]);
        if price > 0.0 {
            self.steps = 0.5 * (self.steps + price.clamp(PRICES[0], PRICES[1]));
        }
    }
}

/// Time that ranks have waited for the busiest one since the last balance, as its work is counted.
#[derive(Debug, Clone, Copy)]
struct Loss {
    /// In steps, beyond what the balance itself has left.
    steps: f64,
    /// The least of a step, in steps.
    least: f64,
}

impl Loss {
    const NONE: Self = Self {
        steps: 0.0,
        least: f64::INFINITY,
    };

    fn add(&mut self, step: f64) {
        self.least = self.least.min(step);
        self.steps += step - self.least;
    }
}

impl Partition {
    /// Slabs with an even number of particles, of which none is created. Collective.
    #[must_use]
    pub fn new(case: &Case, comm: &Comm, layout: &InitialLayout) -> Self {
        let mut balance = Balance::default();
        let slabs = layout.slabs(case, comm, (comm.size(), None), &mut balance);
        Self::with(slabs, balance, case, layout)
    }

    /// All particles on the first rank, until they are [distributed](Self::distribute).
    #[must_use]
    pub fn none(case: &Case, comm: &Comm, layout: &InitialLayout) -> Self {
        let levels = layout.known_levels(case, comm.size()).unwrap_or(1);
        let slabs = NestedSlabs::on_first(layout.axes, levels, comm.size());
        Self::with(slabs, Balance::default(), case, layout)
    }

    fn with(slabs: NestedSlabs, balance: Balance, case: &Case, layout: &InitialLayout) -> Self {
        let is_open = layout.known_levels(case, slabs.ranks()).is_none();
        Self {
            choice: is_open.then(|| Choice::new(case)),
            changes: 0,
            slabs,
            balance,
            rank_speeds: RankSpeeds::default(),
            migration: Migration::default(),
            every: case.domain.balance_every,
            loss: Loss::NONE,
            price: Price::UNKNOWN,
            done: 0,
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

    /// True if a step is one of those at regular intervals when slabs are balanced in any case.
    #[must_use]
    pub fn is_regular(&self, step: u64) -> bool {
        self.every != 0 && step.is_multiple_of(self.every)
    }

    /// True if slabs are balanced at a step: at regular intervals, and as soon as what was lost since
    /// the last balance is worth one.
    #[must_use]
    pub fn is_due(&self, step: u64) -> bool {
        self.is_regular(step) || self.every != 0 && self.loss.steps > self.price.steps
    }

    /// The work that this rank has counted in a step, and the load that it is for one of its speed.
    #[must_use]
    pub fn count(&mut self, comm: &Comm, particles: &ParticleStore) -> [u64; 2] {
        if comm.size() == 1 {
            return [0; 2];
        }
        // same bits in any order: whole numbers
        let work = particles.work.par_iter().map(|&w| u64::from(w)).sum();
        self.done += work;
        [work, self.rank_speeds.load(work)]
    }

    /// Takes the work of all ranks in a step, and the largest load.
    pub fn receive_work(&mut self, comm: &Comm, [work, load]: [u64; 2]) {
        if work > 0 {
            #[allow(clippy::cast_precision_loss, reason = "a ratio")]
            self.loss
                .add(load as f64 * comm.size() as f64 / work as f64);
        }
    }

    /// Moves faces at a step so that each rank gets its share of work, given the seconds that this rank
    /// has worked; now and then revises levels and axes. Collective.
    pub fn balance(
        &mut self,
        comm: &Comm,
        particles: &ParticleStore,
        step: u64,
        busy: f64,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        if comm.size() == 1 {
            return;
        }
        self.loss = Loss::NONE;
        if self.is_regular(step) {
            let done = std::mem::take(&mut self.done);
            self.rank_speeds.measure(comm, done, busy);
        }
        let seconds = self.cut(comm, particles);
        self.price.measure(comm, step, seconds);
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

    /// [`Self::distribute`], in slabs of the levels and axes that suit the particles. Collective.
    pub fn begin(
        &mut self,
        comm: &Comm,
        particles: &mut ParticleStore,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        self.cut(comm, particles);
        self.revise(comm, particles, reach);
        self.send_all(comm, particles);
    }

    /// Cuts slabs anew for any shares of all particles, and distributes these to the ranks. Collective.
    pub fn distribute(&mut self, comm: &Comm, particles: &mut ParticleStore) {
        self.cut(comm, particles);
        self.send_all(comm, particles);
    }

    /// Sends any shares of all particles to the ranks that own them. Collective.
    fn send_all(&mut self, comm: &Comm, particles: &mut ParticleStore) {
        self.migration
            .migrate(comm, &self.slabs, particles, &[], |_, _| 0.0);
        // Its buffers have carried whole shares of the model; never again so much.
        self.migration = Migration::default();
    }

    fn cut(&mut self, comm: &Comm, particles: &ParticleStore) -> f64 {
        let positions = &particles.position[..particles.owned()];
        let all = (positions, particles.work.as_slice());
        self.balance
            .cut(comm, &mut self.slabs, all, &self.rank_speeds)
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

    /// Number of changes of levels or axes since the start of this process.
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
            + self.choice.as_ref().map_or(0, Choice::memory)
            + 8 * self.slabs.faces().len()
    }
}
