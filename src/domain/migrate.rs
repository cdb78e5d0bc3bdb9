//! Particles move to the rank that owns their position, by any distance.

use super::slabs::Decomposition;
use crate::comm::{Comm, Exchange, Traffic};
use crate::particles::{FieldInfo, ParticleStore};

/// Particles that a rank may send in one round, or [`PART`] of its own if that is more: where a
/// whole model moves, as in a restart, its messages must not take as much memory as the model
/// itself.
const ROUND: usize = 1 << 12;
/// One part of so many.
const PART: usize = 32;

/// Buffers of migration, kept from step to step.
pub struct Migration {
    round: usize,
    exchange: Exchange,
    leaving: Vec<Vec<u32>>,
    gone: Vec<u32>,
    moves: Vec<(u32, u32)>,
    counts: Vec<u64>,
    arrivals: Vec<u64>,
}

impl Default for Migration {
    fn default() -> Self {
        Self::in_rounds_of(ROUND)
    }
}

impl Migration {
    /// A rank may send so many particles (at least one) in one round, however few it has.
    #[must_use]
    pub fn in_rounds_of(round: usize) -> Self {
        Self {
            round,
            exchange: Exchange::default(),
            leaving: Vec::new(),
            gone: Vec::new(),
            moves: Vec::new(),
            counts: Vec::new(),
            arrivals: Vec::new(),
        }
    }

    /// Sends every owned particle to the owner of its position. Drops the halo; the order of
    /// the store changes. Collective.
    pub fn migrate(
        &mut self,
        comm: &Comm,
        owners: &impl Decomposition,
        particles: &mut ParticleStore,
    ) {
        let (rank, size) = (comm.rank(), comm.size());
        if size == 1 {
            return;
        }
        self.leaving.resize(size, Vec::new());
        self.find_leaving(rank, owners, particles);
        let leaving: usize = self.leaving.iter().map(Vec::len).sum();
        let most = self.round.max(particles.owned() / PART);
        let mut rounds = [leaving.div_ceil(most) as u64];
        comm.max_u64(&mut rounds);
        for round in 0..rounds[0] {
            if round > 0 {
                self.find_leaving(rank, owners, particles);
            }
            self.limit_round(rank, most);
            self.counts.clear();
            self.counts
                .extend(self.leaving.iter().map(|list| list.len() as u64));
            comm.all_to_all_u64(&self.counts, &mut self.arrivals);
            self.swap(comm, particles);
        }
    }

    fn find_leaving(
        &mut self,
        rank: usize,
        owners: &impl Decomposition,
        particles: &ParticleStore,
    ) {
        self.leaving.iter_mut().for_each(Vec::clear);
        for (i, position) in particles.position[..particles.owned()].iter().enumerate() {
            let owner = owners.owner(position);
            if owner != rank {
                #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
                self.leaving[owner].push(i as u32);
            }
        }
    }

    /// Keeps what fits a round, the next rank's first, so that no rank is sent to by all at once.
    fn limit_round(&mut self, rank: usize, mut room: usize) {
        let (before, after) = self.leaving.split_at_mut(rank);
        for list in after.iter_mut().chain(before) {
            list.truncate(room);
            room -= list.len();
        }
    }

    fn swap(&mut self, comm: &Comm, particles: &mut ParticleStore) {
        let peers = (0..comm.size()).filter(|&r| self.counts[r] > 0 || self.arrivals[r] > 0);
        self.exchange.set_peers(peers);
        let size = particles.bytes_per_particle(FieldInfo::leaves);
        let mut arriving = 0;
        for k in 0..self.exchange.peers() {
            let peer = self.exchange.rank(k);
            particles.pack(
                FieldInfo::leaves,
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
        particles.remove(&mut self.gone, &mut self.moves);
        let mut first = particles.owned();
        particles.resize_owned(first + arriving);
        self.exchange.wait();
        for k in 0..self.exchange.peers() {
            let bytes = self.exchange.incoming(k);
            let count = bytes.len() / size;
            particles.unpack(FieldInfo::leaves, first, count, bytes);
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
