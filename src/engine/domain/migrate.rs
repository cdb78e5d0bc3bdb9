//! Particles move to the rank that owns their position, by any distance.

use rayon::prelude::*;

use super::nested::Decomposition;
use comm::{Comm, Exchange, PlainRecord, Receivers, Relay, Traffic};
use numerics::alone;
use particles::{FieldInfo, ParticleStore};

/// Particles that a rank may send in one round, or [`PART`] of its own if that is more: where a
/// whole model moves, as in a restart, its messages must not take as much memory as the model
/// itself.
const ROUND: usize = 1 << 12;
/// One part of so many.
const PART: usize = 32;
/// Particles that a task looks at.
const SHARE: usize = 4096;

/// Buffers of migration, kept from step to step.
pub struct Migration {
    round: usize,
    exchange: Exchange,
    /// Particles that leave: the ranks that the owner is ahead, round and round, and the particle.
    leaving: Vec<[u32; 2]>,
    /// The same, as the tasks found them.
    found: Vec<Vec<[u32; 2]>>,
    gone: Vec<u32>,
    moves: Vec<(u32, u32)>,
    /// What is told of those that leave and of those that arrive, these by ascending senders.
    counts: Vec<Count>,
    arrivals: Vec<Count>,
    relay: Relay<Count>,
    peers: Vec<usize>,
}

/// Particles that a rank sends to another.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Count {
    /// The receiver in the upper half, the sender in the lower one.
    key: u64,
    particles: u64,
}

impl PlainRecord for Count {
    fn key(&self) -> u64 {
        self.key
    }
}

impl Count {
    fn new([from, to]: [usize; 2], particles: usize) -> Self {
        Self {
            key: (to as u64) << 32 | from as u64,
            particles: particles as u64,
        }
    }

    /// The sender.
    fn sender(&self) -> usize {
        usize::try_from(self.key & u64::from(u32::MAX)).unwrap_or(0)
    }
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
            found: Vec::new(),
            gone: Vec::new(),
            moves: Vec::new(),
            counts: Vec::new(),
            arrivals: Vec::new(),
            relay: Relay::new(Receivers::Named),
            peers: Vec::new(),
        }
    }

    /// Sends every owned particle to the owner of its position. `near` are ranks (ascending) that all
    /// name each other: where nobody goes to another and no round is full, they alone talk. Drops
    /// the halo; the order of the store changes. Gives the largest `reach` (m) of the particles of all
    /// ranks, zero if there is one rank. Collective.
    pub fn migrate(
        &mut self,
        comm: &Comm,
        owners: &(impl Decomposition + Sync),
        particles: &mut ParticleStore,
        near: &[usize],
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) -> f64 {
        let (rank, size) = (comm.rank(), comm.size());
        if size == 1 {
            return 0.0;
        }
        let farthest = self.find_leaving(comm, owners, particles, &reach);
        let most = self.round.max(particles.owned() / PART);
        let is_near = |to: &[u32; 2]| near.binary_search(&rank_ahead(rank, to[0], size)).is_ok();
        let is_far = self.leaving.iter().any(|to| !is_near(to));
        let rounds = self.leaving.len().div_ceil(most) as u64;
        // Numbers that are not negative are ordered as their bits are.
        let mut vote = [rounds, u64::from(is_far), farthest.to_bits()];
        comm.max_u64(&mut vote);
        let [rounds, is_far, farthest] = vote;
        let farthest = f64::from_bits(farthest);
        if rounds == 1 && is_far == 0 {
            self.exchange.set_peers(near.iter().copied());
            self.swap(comm, particles, false);
            return farthest;
        }
        for round in 0..rounds {
            if round > 0 {
                self.find_leaving(comm, owners, particles, &reach);
            }
            // The next rank's first, so that no rank is sent to by all at once.
            self.leaving.truncate(most);
            self.tell_counts(comm);
            self.swap(comm, particles, true);
        }
        farthest
    }

    /// Lists who leaves, by owner from the next rank on, and then by place in the store. Gives the largest
    /// reach (m) of this rank's particles.
    fn find_leaving(
        &mut self,
        comm: &Comm,
        owners: &(impl Decomposition + Sync),
        particles: &ParticleStore,
        reach: &(impl Fn(&ParticleStore, usize) -> f64 + Sync),
    ) -> f64 {
        let (rank, size) = (comm.rank(), comm.size());
        let region = owners.region(rank);
        let positions = &particles.position[..particles.owned()];
        self.found
            .resize(positions.len().div_ceil(SHARE), Vec::new());
        let farthest = (&mut self.found, positions.par_chunks(SHARE))
            .into_par_iter()
            .enumerate()
            .map(|(task, (found, positions))| {
                let mut farthest: f64 = 0.0;
                found.clear();
                for (k, position) in positions.iter().enumerate() {
                    let i = task * SHARE + k;
                    farthest = farthest.max(reach(particles, i));
                    if region.holds(position) {
                        continue;
                    }
                    let owner = owners.owner(position);
                    if owner != rank {
                        #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
                        found.push([ahead_of(rank, owner, size), i as u32]);
                    }
                }
                farthest
            })
            // same bits in any order: a largest number
            .reduce(|| 0.0, f64::max);
        self.leaving.clear();
        self.leaving.extend(self.found.iter().flatten());
        self.leaving.sort_unstable();
        farthest
    }

    /// Tells ranks how many particles they get, and makes peers of those that get any or send
    /// some. Collective.
    fn tell_counts(&mut self, comm: &Comm) {
        let (rank, size) = (comm.rank(), comm.size());
        self.counts.clear();
        self.peers.clear();
        for part in self.leaving.chunk_by(|a, b| a[0] == b[0]) {
            let to = rank_ahead(rank, part[0][0], size);
            self.counts.push(Count::new([rank, to], part.len()));
            self.peers.push(to);
        }
        let never = |_: &mut Count, _: &Count| unreachable!("each pair of ranks has a key");
        let arrivals = self.relay.send(comm, &mut self.counts, never);
        self.arrivals.clear();
        self.arrivals.extend_from_slice(arrivals);
        self.peers.extend(self.arrivals.iter().map(Count::sender));
        self.peers.sort_unstable();
        self.peers.dedup();
        self.exchange.set_peers(self.peers.iter().copied());
    }

    /// Sends those that leave to the peers, of whom one knows how many they send or hears it.
    fn swap(&mut self, comm: &Comm, particles: &mut ParticleStore, is_known: bool) {
        let size = particles.bytes_per_particle(FieldInfo::leaves);
        alone::visit(self.leaving.len());
        self.gone.clear();
        self.gone.extend(self.leaving.iter().map(|[_, i]| i));
        for k in 0..self.exchange.peers() {
            let peer = self.exchange.rank(k);
            let ahead = ahead_of(comm.rank(), peer, comm.size());
            let start = self.leaving.partition_point(|to| to[0] < ahead);
            let end = self.leaving.partition_point(|to| to[0] <= ahead);
            particles.pack(
                FieldInfo::leaves,
                &self.gone[start..end],
                self.exchange.outgoing(k),
            );
            if is_known {
                let found = self.arrivals.binary_search_by_key(&peer, Count::sender);
                let particles = found.map_or(0, |at| self.arrivals[at].particles);
                let particles = usize::try_from(particles).expect("a count fits memory");
                self.exchange.expect(k, particles * size);
            }
        }
        if is_known {
            self.exchange.post(comm);
        } else {
            self.exchange.post_with_sizes(comm);
        }
        particles.remove(&mut self.gone, &mut self.moves);
        let mut first = particles.owned();
        let incoming = (0..self.exchange.peers()).map(|k| self.exchange.incoming(k).len());
        let arriving = incoming.sum::<usize>() / size;
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
        let counts = self.counts.capacity() + self.arrivals.capacity();
        self.exchange.memory()
            + self.relay.memory()
            + 4 * self.gone.capacity()
            + 8 * (self.leaving.capacity() + self.moves.capacity())
            + 8 * self.found.iter().map(Vec::capacity).sum::<usize>()
            + 8 * self.peers.capacity()
            + size_of::<Count>() * counts
    }
}

/// Number of ranks that another one is ahead, round and round.
#[allow(clippy::cast_possible_truncation, reason = "ranks fit u32")]
fn ahead_of(rank: usize, other: usize, size: usize) -> u32 {
    ((other + size - rank) % size) as u32
}

/// The rank so many ahead.
fn rank_ahead(rank: usize, ahead: u32, size: usize) -> usize {
    (rank + ahead as usize) % size
}
