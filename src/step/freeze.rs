//! Frozen particles: taken out of all sums like removed ones, kept for the files.
//!
//! Were a particle to stay in the sums at rest, it would push others without being pushed: momentum
//! and energy would be lost in each step, and its state, which is out of range, would go on to act.
//! So it takes part in nothing, the rest of the run is that of a removal to the last bit, and what
//! it carried is booked in the same way. What is left of it in files is where it was and of what,
//! the fields that are [`FieldInfo::kept`]. All else of it, velocity and stress among it, is zero.

use super::simulation::Simulation;
use crate::comm::Comm;
use crate::particles::{FieldInfo, Owner, ParticleStore};

impl Simulation {
    /// Keeps the owned particles `indices` for the files.
    pub(super) fn freeze(&mut self, indices: &[u32]) {
        let mut remains = Vec::new();
        self.store.pack(FieldInfo::is_kept, indices, &mut remains);
        let (frozen, count) = (&mut self.frozen, indices.len());
        let first = frozen.owned();
        frozen.resize_owned(first + count);
        frozen.unpack(FieldInfo::is_kept, first, count, &remains);
        for mark in &mut frozen.frozen[first..] {
            *mark = 1;
        }
    }

    /// Parts frozen particles from those that a checkpoint holds with them, whatever becomes of the
    /// next ones, gives up the fields `unused` and sizes all others. Collective.
    pub(super) fn part_frozen(&mut self, comm: &Comm, unused: Owner) {
        let marks = (0_u32..).zip(&self.store.frozen);
        let mut leaving: Vec<u32> = marks
            .filter(|&(_, &frozen)| frozen != 0)
            .map(|(i, _)| i)
            .collect();
        let any = comm.any(!leaving.is_empty());
        let unused = if any { unused - Owner::FREEZE } else { unused };
        self.store.drop_fields(unused);
        self.store.resize_owned(self.store.owned());
        self.frozen = ParticleStore::default();
        self.frozen.drop_fields(unused);
        self.freeze(&leaving);
        self.store.remove(&mut leaving, &mut Vec::new());
    }

    /// Does something, such as writing files, while the store holds this rank's frozen particles
    /// too, in place of the halo.
    pub fn with_frozen<T>(&mut self, task: impl FnOnce(&Self) -> T) -> T {
        let owned = self.store.owned();
        if self.frozen.owned() > 0 {
            self.store.append(&self.frozen);
        }
        let result = task(self);
        if self.frozen.owned() > 0 {
            self.store.resize_owned(owned);
        }
        result
    }

    /// Particles that this rank has frozen.
    #[must_use]
    pub fn frozen(&self) -> usize {
        self.frozen.owned()
    }
}
