//! The share of space that each rank owns, and the particles that ranks exchange.

use crate::domain::{Decomposition, Halo, Partition};
use crate::sph::Smoothing;
use comm::Comm;
use particles::{ActiveMut, ParticleStore};
use populate::Brick;

/// The partition of space among ranks, and the halo of this rank.
pub(super) struct Space {
    pub partition: Partition,
    pub halo: Halo,
}

impl Space {
    /// This rank's part of space.
    pub fn region(&self, comm: &Comm) -> Brick {
        self.partition.slabs().region(comm.rank())
    }

    /// Gives each rank its share of the work at a step, given the seconds that this rank has worked. Collective.
    pub fn balance(
        &mut self,
        comm: &Comm,
        particles: &ParticleStore,
        smoothing: &Smoothing,
        step: u64,
        busy: f64,
    ) {
        self.partition
            .balance(comm, particles, step, busy, |particles, i| {
                smoothing.reach(particles, i)
            });
    }

    /// Sends particles to the ranks that own where they are. Collective.
    pub fn migrate(&mut self, comm: &Comm, particles: &mut ParticleStore, smoothing: &Smoothing) {
        self.partition
            .migrate(comm, particles, &self.halo, |particles, i| {
                smoothing.reach(particles, i)
            });
    }

    /// Copies of the positions and velocities of active particles that other ranks need. Collective.
    pub fn exchange_motion(&mut self, comm: &Comm, active: ActiveMut, smoothing: &Smoothing) {
        self.halo
            .exchange_motion(comm, self.partition.reaches(), active, |particles, i| {
                smoothing.reach(particles, i)
            });
    }

    /// Messages and bytes that this rank has sent.
    pub fn traffic(&self) -> (u64, u64) {
        let (halo, migration) = (self.halo.traffic(), self.partition.traffic());
        (
            halo.messages + migration.messages,
            halo.bytes + migration.bytes,
        )
    }

    /// Bytes allocated.
    pub fn memory(&self) -> usize {
        self.halo.memory() + self.partition.memory()
    }
}
