//! What a simulation tells of what it holds and has sent.

use super::simulation::Simulation;
use crate::contact::ContactTable;
use crate::domain::{Halo, NestedSlabs};
use model::Axis;

impl Simulation {
    /// Particles that this rank has frozen.
    #[must_use]
    pub fn frozen(&self) -> usize {
        self.frozen.count()
    }

    /// Particles of this rank that steps leave out, as they rest far from what does not.
    #[must_use]
    pub fn asleep(&self) -> usize {
        let owned = self.particles.owned();
        owned - self.dormant.asleep.awake(owned)
    }

    /// Bytes that this rank holds in particle arrays, lists and buffers.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.memory_by_part().iter().map(|(_, bytes)| bytes).sum()
    }

    /// The same by what they are for.
    #[must_use]
    pub fn memory_by_part(&self) -> [(&'static str, usize); 9] {
        let [order, motion, neighbours, foreign] = self.lists.memory_by_part();
        let others = self.frozen.memory()
            + 4 * self.leaving.capacity()
            + self.collector.memory()
            + self.labels.memory()
            + self.loads.memory()
            + self.sums.memory()
            + self.kept_totals.memory()
            + self.measures.memory()
            + self.step_control.memory();
        [
            ("particles", self.particles.memory()),
            ("order", order),
            ("motion_records", motion),
            ("neighbours", neighbours),
            ("foreign_neighbours", foreign),
            ("stress_records", self.sph.memory()),
            ("contact", self.contact.memory()),
            (
                "halo_and_balance",
                self.halo.memory() + self.partition.memory(),
            ),
            ("others", self.dormant.memory() + others),
        ]
    }

    /// Who owns which place.
    #[must_use]
    pub fn slabs(&self) -> &NestedSlabs {
        self.partition.slabs()
    }

    /// The axes along which space is cut, by level.
    #[must_use]
    pub fn axes_of_slabs(&self) -> Vec<Axis> {
        let slabs = self.slabs();
        let levels = 0..slabs.levels();
        levels.map(|level| Axis::ALL[slabs.axis(level)]).collect()
    }

    /// How often levels or axes of the slabs have changed since the start of this process.
    #[must_use]
    pub fn changes_of_slabs(&self) -> u64 {
        self.partition.changes()
    }

    /// What this rank exchanges with others in each step.
    #[must_use]
    pub fn halo(&self) -> &Halo {
        &self.halo
    }

    /// Messages and bytes that this rank has sent.
    #[must_use]
    pub fn traffic(&self) -> (u64, u64) {
        let (halo, migration) = (self.halo.traffic(), self.partition.traffic());
        (
            halo.messages + migration.messages,
            halo.bytes + migration.bytes,
        )
    }

    /// The contact table.
    #[must_use]
    pub fn contact(&self) -> &ContactTable {
        &self.contact.table
    }
}
