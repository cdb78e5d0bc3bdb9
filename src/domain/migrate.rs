//! Particles move to the rank that owns their position, by any distance.

use super::slabs::Decomposition;
use crate::comm::{Comm, Exchange, Traffic};
use crate::particles::{FieldUse, ParticleStore};

/// Buffers of migration, kept from step to step.
#[derive(Default)]
pub struct Migration {
    exchange: Exchange,
    leaving: Vec<Vec<u32>>,
    gone: Vec<u32>,
    moves: Vec<(u32, u32)>,
    counts: Vec<u64>,
    arrivals: Vec<u64>,
}

impl Migration {
    /// Sends every owned particle to the owner of its position. Drops the halo; the order of
    /// the store changes. Collective.
    pub fn migrate(&mut self, comm: &Comm, owners: &impl Decomposition, store: &mut ParticleStore) {
        let (rank, size) = (comm.rank(), comm.size());
        if size == 1 {
            return;
        }
        self.leaving.resize(size, Vec::new());
        self.leaving.iter_mut().for_each(Vec::clear);
        for (i, position) in store.position[..store.owned()].iter().enumerate() {
            let owner = owners.owner(position);
            if owner != rank {
                #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
                self.leaving[owner].push(i as u32);
            }
        }
        if !comm.any(self.leaving.iter().any(|list| !list.is_empty())) {
            return;
        }
        self.counts.clear();
        self.counts
            .extend(self.leaving.iter().map(|list| list.len() as u64));
        comm.all_to_all_u64(&self.counts, &mut self.arrivals);
        self.swap(comm, store);
    }

    fn swap(&mut self, comm: &Comm, store: &mut ParticleStore) {
        let peers = (0..comm.size()).filter(|&r| self.counts[r] > 0 || self.arrivals[r] > 0);
        self.exchange.set_peers(peers);
        let size = store.bytes_per_particle(FieldUse::LEAVING);
        let mut arriving = 0;
        for k in 0..self.exchange.peers() {
            let peer = self.exchange.rank(k);
            store.pack(
                FieldUse::LEAVING,
                &self.leaving[peer],
                self.exchange.outgoing(k),
            );
            let count = usize::try_from(self.arrivals[peer]).expect("a count fits memory");
            self.exchange.expect(k, count * size);
            arriving += count;
        }
        self.exchange.post(comm);
        self.gone.clear();
        self.gone.extend(self.leaving.iter().flatten());
        store.remove(&mut self.gone, &mut self.moves);
        let mut first = store.owned();
        store.resize_owned(first + arriving);
        self.exchange.wait();
        for k in 0..self.exchange.peers() {
            let bytes = self.exchange.incoming(k);
            let count = bytes.len() / size;
            store.unpack(FieldUse::LEAVING, first, count, bytes);
            first += count;
        }
    }

    /// Messages and bytes sent so far.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        self.exchange.traffic
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let leaving: usize = self.leaving.iter().map(Vec::capacity).sum();
        let words = [&self.counts, &self.arrivals].map(Vec::capacity);
        self.exchange.memory()
            + 4 * (leaving + self.gone.capacity())
            + 8 * self.moves.capacity()
            + 8 * words.iter().sum::<usize>()
    }
}
