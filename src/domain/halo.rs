//! Halo exchange: copies of other ranks' particles within reach of this rank's, and the images
//! of all of them behind symmetry planes.

use super::mirrors::{Mirrors, codes};
use crate::comm::{Comm, Exchange, Traffic};
use crate::neighbours::Image;
use crate::particles::{FieldUse, ParticleStore, bytes_per_particle};

/// What a rank tells all others before the exchange.
#[derive(Debug, Clone, Copy)]
struct Extent {
    /// Smallest and largest coordinate of its particles along the slab axis (m).
    lower: f64,
    upper: f64,
    /// Largest reach of its particles (m).
    reach: f64,
}

impl Extent {
    const WORDS: usize = 3;

    fn is_empty(&self) -> bool {
        self.lower > self.upper
    }

    fn distance(&self, x: f64) -> f64 {
        (self.lower - x).max(x - self.upper).max(0.0)
    }
}

/// Halo lists and buffers, kept from step to step.
pub struct Halo {
    axis: usize,
    mirrors: Mirrors,
    exchange: Exchange,
    words: Vec<u64>,
    extents: Vec<Extent>,
    /// For each peer, the particles it needs and the codes of the images that it needs of each
    /// (a set of eight bits).
    sends: Vec<(Vec<u32>, Vec<u8>)>,
    /// For each peer, how many particles it sent.
    received: Vec<usize>,
    /// Images of owned particles, and halo particles with theirs.
    others: Vec<Image>,
}

impl Halo {
    /// Halo of slabs along `axis`.
    #[must_use]
    pub fn new(axis: usize, mirrors: Mirrors) -> Self {
        Self {
            axis,
            mirrors,
            exchange: Exchange::default(),
            words: Vec::new(),
            extents: Vec::new(),
            sends: Vec::new(),
            received: Vec::new(),
            others: Vec::new(),
        }
    }

    /// Decides who needs whom and starts to send [`FieldUse::HALO_MOTION`]. A pair of particles
    /// interacts within the sum of their `reach` (m). Collective.
    pub fn post_motion(
        &mut self,
        comm: &Comm,
        store: &mut ParticleStore,
        reach: impl Fn(&ParticleStore, usize) -> f64,
    ) {
        store.resize_halo(0);
        self.gather_extents(comm, store, &reach);
        self.find_peers(comm);
        self.choose(store, &reach);
        for k in 0..self.exchange.peers() {
            let (particles, codes) = &self.sends[k];
            let message = self.exchange.outgoing(k);
            message.extend_from_slice(codes);
            store.pack(FieldUse::HALO_MOTION, particles, message);
        }
        self.exchange.post_sizes(comm);
        self.exchange.post(comm);
        self.list_own_images(comm, store, &reach);
    }

    /// Receives what [`Self::post_motion`] of the others sent, and lists the halo particles and
    /// their images behind planes.
    pub fn finish_motion(&mut self, store: &mut ParticleStore) {
        self.exchange.wait();
        let size = 1 + bytes_per_particle(FieldUse::HALO_MOTION);
        self.received.clear();
        for k in 0..self.exchange.peers() {
            self.received.push(self.exchange.incoming(k).len() / size);
        }
        store.resize_halo(self.received.iter().sum());
        let mut first = store.owned();
        for (k, &count) in self.received.iter().enumerate() {
            let (needs, fields) = self.exchange.incoming(k).split_at(count);
            store.unpack(FieldUse::HALO_MOTION, first, count, fields);
            for (i, &need) in needs.iter().enumerate() {
                for code in (0..8).filter(|code| need >> code & 1 == 1) {
                    self.others.push(Image::new(first + i, code));
                }
            }
            first += count;
        }
    }

    /// Starts to send the fields of `uses` of the same particles.
    pub fn post(&mut self, comm: &Comm, store: &ParticleStore, uses: FieldUse) {
        let size = bytes_per_particle(uses);
        for k in 0..self.exchange.peers() {
            let message = self.exchange.outgoing(k);
            message.clear();
            store.pack(uses, &self.sends[k].0, message);
            self.exchange.expect(k, self.received[k] * size);
        }
        self.exchange.post(comm);
    }

    /// Receives what [`Self::post`] of the others sent.
    pub fn finish(&mut self, store: &mut ParticleStore, uses: FieldUse) {
        self.exchange.wait();
        let mut first = store.owned();
        for (k, &count) in self.received.iter().enumerate() {
            store.unpack(uses, first, count, self.exchange.incoming(k));
            first += count;
        }
    }

    /// After [`Self::finish_motion`]: the images of owned particles behind planes, and the halo
    /// particles with theirs.
    #[must_use]
    pub fn others(&self) -> &[Image] {
        &self.others
    }

    /// The symmetry planes.
    #[must_use]
    pub fn mirrors(&self) -> &Mirrors {
        &self.mirrors
    }

    /// Messages and bytes sent so far.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        self.exchange.traffic
    }

    fn gather_extents(
        &mut self,
        comm: &Comm,
        store: &ParticleStore,
        reach: &impl Fn(&ParticleStore, usize) -> f64,
    ) {
        let mut mine = Extent {
            lower: f64::INFINITY,
            upper: f64::NEG_INFINITY,
            reach: 0.0,
        };
        for (i, position) in store.position.iter().enumerate() {
            mine.lower = mine.lower.min(position[self.axis]);
            mine.upper = mine.upper.max(position[self.axis]);
            mine.reach = mine.reach.max(reach(store, i));
        }
        let words = [mine.lower, mine.upper, mine.reach].map(f64::to_bits);
        comm.all_gather_u64(&words, &mut self.words);
        self.extents.clear();
        self.extents
            .extend(self.words.chunks_exact(Extent::WORDS).map(|word| Extent {
                lower: f64::from_bits(word[0]),
                upper: f64::from_bits(word[1]),
                reach: f64::from_bits(word[2]),
            }));
    }

    /// Peers are the ranks whose particles may stand within reach of this rank's, by a test that
    /// both sides answer alike. Images behind planes are never nearer than their particles.
    fn find_peers(&mut self, comm: &Comm) {
        let me = comm.rank();
        let mine = self.extents[me];
        let extents = &self.extents;
        self.exchange.set_peers((0..comm.size()).filter(|&other| {
            let theirs = extents[other];
            if other == me || mine.is_empty() || theirs.is_empty() {
                return false;
            }
            let range = mine.reach + theirs.reach;
            let gap = (theirs.lower - mine.upper).max(mine.lower - theirs.upper);
            gap <= range
        }));
    }

    /// Fills the lists of particles and images to send.
    fn choose(&mut self, store: &ParticleStore, reach: &impl Fn(&ParticleStore, usize) -> f64) {
        let peers = self.exchange.peers();
        if self.sends.len() < peers {
            self.sends.resize(peers, <(Vec<u32>, Vec<u8>)>::default());
        }
        for (particles, needs) in &mut self.sends {
            particles.clear();
            needs.clear();
        }
        if peers == 0 {
            return;
        }
        let farthest = self.farthest();
        for (i, position) in store.position.iter().enumerate() {
            let range = reach(store, i) + farthest;
            let near = self.mirrors.near(position, range);
            for k in 0..peers {
                let theirs = self.extents[self.exchange.rank(k)];
                let mut need = 0_u8;
                for code in codes(near, true) {
                    if theirs.distance(self.image_along(position, code)) <= range {
                        need |= 1 << code;
                    }
                }
                if need != 0 {
                    #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
                    self.sends[k].0.push(i as u32);
                    self.sends[k].1.push(need);
                }
            }
        }
    }

    /// Lists the images of owned particles near this rank's own particles.
    fn list_own_images(
        &mut self,
        comm: &Comm,
        store: &ParticleStore,
        reach: &impl Fn(&ParticleStore, usize) -> f64,
    ) {
        self.others.clear();
        if self.mirrors.is_empty() {
            return;
        }
        let farthest = self.farthest();
        let mine = self.extents[comm.rank()];
        for (i, position) in store.position.iter().enumerate() {
            let range = reach(store, i) + farthest;
            for code in codes(self.mirrors.near(position, range), false) {
                if mine.distance(self.image_along(position, code)) <= range {
                    self.others.push(Image::new(i, code));
                }
            }
        }
    }

    /// The largest reach of any particle (m).
    fn farthest(&self) -> f64 {
        self.extents.iter().map(|e| e.reach).fold(0.0, f64::max)
    }

    fn image_along(&self, position: &[f64; 3], code: u8) -> f64 {
        self.mirrors.reflect_position(position, code)[self.axis]
    }
}
