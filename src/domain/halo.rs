//! Halo exchange: copies of other ranks' particles within reach of this rank's, and the images
//! of all of them behind symmetry planes.

use rayon::prelude::*;

use super::mirrors::Mirrors;
use super::needs::{Extent, Finder, Found, MYSELF};
use crate::comm::{Comm, Exchange, Traffic};
use crate::particles::{HaloPhase, Image, ParticleStore};

/// Halo lists and buffers, kept from step to step.
pub struct Halo {
    rank: usize,
    mirrors: Mirrors,
    exchange: Exchange,
    words: Vec<u64>,
    extents: Vec<Extent>,
    /// The ranks to talk to, ascending.
    peers: Vec<usize>,
    /// Their extents.
    theirs: Vec<Extent>,
    /// For each peer, the particles it needs and the codes of the images that it needs of each
    /// (a set of eight bits).
    sends: Vec<(Vec<u32>, Vec<u8>)>,
    /// For each peer, how many particles it sent.
    received: Vec<usize>,
    /// Images of owned particles.
    own: Vec<Image>,
    /// Halo particles of lower ranks with their images, [`Self::own`], those of higher ranks.
    others: Vec<Image>,
    /// How many of them are of lower ranks or stand behind a plane.
    below: usize,
    /// What the tasks found, one after the other: see [`Found`].
    found: Vec<Vec<Found>>,
}

/// Particles that a task looks at.
const SHARE: usize = 4096;

impl Halo {
    /// Halo with images behind planes.
    #[must_use]
    pub fn new(mirrors: Mirrors) -> Self {
        Self {
            rank: 0,
            mirrors,
            exchange: Exchange::default(),
            words: Vec::new(),
            extents: Vec::new(),
            peers: Vec::new(),
            theirs: Vec::new(),
            sends: Vec::new(),
            received: Vec::new(),
            own: Vec::new(),
            others: Vec::new(),
            below: 0,
            found: Vec::new(),
        }
    }

    /// Decides who needs whom and starts to send [`HaloPhase::MOTION`]. A pair of particles
    /// interacts within the sum of their `reach` (m). Collective.
    pub fn post_motion(
        &mut self,
        comm: &Comm,
        particles: &mut ParticleStore,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        particles.resize_halo(0);
        self.rank = comm.rank();
        self.gather_extents(comm, particles, &reach);
        self.find_peers(comm);
        self.choose(comm, particles, &reach);
        for k in 0..self.exchange.peers() {
            let (sent, codes) = &self.sends[k];
            let message = self.exchange.outgoing(k);
            message.extend_from_slice(codes);
            particles.pack(HaloPhase::MOTION, sent, message);
        }
        self.exchange.post_sizes(comm);
        self.exchange.post(comm);
    }

    /// Receives what [`Self::post_motion`] of the others sent, and lists the halo particles and
    /// their images behind planes.
    pub fn finish_motion(&mut self, particles: &mut ParticleStore) {
        self.exchange.wait();
        let size = 1 + particles.bytes_per_particle(HaloPhase::MOTION);
        self.received.clear();
        for k in 0..self.exchange.peers() {
            self.received.push(self.exchange.incoming(k).len() / size);
        }
        particles.resize_halo(self.received.iter().sum());
        self.others.clear();
        let mut own = Some(&self.own);
        let mut first = particles.owned();
        for (k, &count) in self.received.iter().enumerate() {
            if self.exchange.rank(k) > self.rank {
                self.others.extend(own.take().into_iter().flatten());
                self.below = self.others.len();
            }
            let (needs, fields) = self.exchange.incoming(k).split_at(count);
            particles.unpack(HaloPhase::MOTION, first, count, fields);
            for (i, &need) in needs.iter().enumerate() {
                for code in (0..8).filter(|code| need >> code & 1 == 1) {
                    self.others.push(Image::new(first + i, code));
                }
            }
            first += count;
        }
        if let Some(own) = own {
            self.others.extend(own);
            self.below = self.others.len();
        }
    }

    /// [`Self::post_motion`] and [`Self::finish_motion`]. Collective.
    pub fn exchange_motion(
        &mut self,
        comm: &Comm,
        particles: &mut ParticleStore,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        self.post_motion(comm, particles, reach);
        self.finish_motion(particles);
    }

    /// [`Self::post`] and [`Self::finish`]. Collective.
    pub fn exchange(&mut self, comm: &Comm, particles: &mut ParticleStore, phase: HaloPhase) {
        self.post(comm, particles, phase);
        self.finish(particles, phase);
    }

    /// Starts to send the fields of `phase` of the same particles.
    pub fn post(&mut self, comm: &Comm, particles: &ParticleStore, phase: HaloPhase) {
        let size = particles.bytes_per_particle(phase);
        for k in 0..self.exchange.peers() {
            let message = self.exchange.outgoing(k);
            message.clear();
            particles.pack(phase, &self.sends[k].0, message);
            self.exchange.expect(k, self.received[k] * size);
        }
        self.exchange.post(comm);
    }

    /// Receives what [`Self::post`] of the others sent.
    pub fn finish(&mut self, particles: &mut ParticleStore, phase: HaloPhase) {
        self.exchange.wait();
        let mut first = particles.owned();
        for (k, &count) in self.received.iter().enumerate() {
            particles.unpack(phase, first, count, self.exchange.incoming(k));
            first += count;
        }
    }

    /// Gives halo particles the values of their owners: those of this rank's particles stand first
    /// in `values`, those of halo particles after them. Collective.
    pub fn exchange_values<T: bytemuck::Pod>(&mut self, comm: &Comm, values: &mut [T]) {
        let size = size_of::<T>();
        for k in 0..self.exchange.peers() {
            let message = self.exchange.outgoing(k);
            message.clear();
            for &i in &self.sends[k].0 {
                message.extend_from_slice(bytemuck::bytes_of(&values[i as usize]));
            }
            self.exchange.expect(k, self.received[k] * size);
        }
        self.exchange.post(comm);
        self.exchange.wait();
        let mut first = values.len() - self.received.iter().sum::<usize>();
        for (k, &count) in self.received.iter().enumerate() {
            bytemuck::cast_slice_mut(&mut values[first..first + count])
                .copy_from_slice(self.exchange.incoming(k));
            first += count;
        }
    }

    /// After [`Self::finish_motion`]: the images of owned particles behind planes, and the halo
    /// particles with theirs.
    #[must_use]
    pub fn others(&self) -> &[Image] {
        &self.others
    }

    /// The ranks with which particles are exchanged since the last [`Self::post_motion`], ascending:
    /// each names this one too.
    #[must_use]
    pub fn peers(&self) -> &[usize] {
        &self.peers
    }

    /// How many of [`Self::others`], the first ones, stand below this rank's own particles as far as
    /// ranks tell: a hint for their sort.
    #[must_use]
    pub fn below(&self) -> usize {
        self.below
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

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let send =
            |(particles, codes): &(Vec<u32>, Vec<u8>)| 4 * particles.capacity() + codes.capacity();
        let found = |found: &Vec<Found>| size_of::<Found>() * found.capacity();
        self.exchange.memory()
            + 8 * (self.words.capacity() + self.received.capacity() + self.peers.capacity())
            + size_of::<Extent>() * (self.extents.capacity() + self.theirs.capacity())
            + size_of::<Image>() * (self.own.capacity() + self.others.capacity())
            + self.sends.iter().map(send).sum::<usize>()
            + self.found.iter().map(found).sum::<usize>()
    }

    fn gather_extents(
        &mut self,
        comm: &Comm,
        particles: &ParticleStore,
        reach: &(impl Fn(&ParticleStore, usize) -> f64 + Sync),
    ) {
        let mine = (particles.position.par_chunks(SHARE).enumerate())
            .map(|(task, positions)| {
                let mut part = Extent::EMPTY;
                for (k, position) in positions.iter().enumerate() {
                    part.add(position, reach(particles, task * SHARE + k));
                }
                part
            })
            // same bits in any order: smallest and largest numbers
            .reduce(|| Extent::EMPTY, Extent::join);
        comm.all_gather_u64(&mine.write(), &mut self.words);
        self.extents.clear();
        let words = self.words.chunks_exact(Extent::WORDS);
        self.extents.extend(words.map(Extent::read));
    }

    /// Peers are the ranks whose particles may stand within reach of this rank's, by a test that
    /// both sides answer alike.
    fn find_peers(&mut self, comm: &Comm) {
        let me = comm.rank();
        let (extents, mine) = (&self.extents, self.extents[me]);
        let is_peer = |&other: &usize| other != me && mine.may_need(&extents[other]);
        self.peers.clear();
        self.peers.extend((0..comm.size()).filter(is_peer));
        self.exchange.set_peers(self.peers.iter().copied());
    }

    /// Fills the lists of particles and images to send, and those of this rank's own images that
    /// stand near its own particles.
    fn choose(
        &mut self,
        comm: &Comm,
        particles: &ParticleStore,
        reach: &(impl Fn(&ParticleStore, usize) -> f64 + Sync),
    ) {
        let peers = self.exchange.peers();
        if self.sends.len() < peers {
            self.sends.resize(peers, <(Vec<u32>, Vec<u8>)>::default());
        }
        for (particles, needs) in &mut self.sends {
            particles.clear();
            needs.clear();
        }
        self.own.clear();
        if peers == 0 && self.mirrors.is_empty() {
            return;
        }
        self.theirs.clear();
        let extents = &self.extents;
        self.theirs
            .extend(self.peers.iter().map(|&rank| extents[rank]));
        let finder = Finder::new(&self.mirrors, extents[comm.rank()], &self.theirs);
        let tasks = particles.position.len().div_ceil(SHARE);
        self.found.resize(tasks, Vec::new());
        (&mut self.found, particles.position.par_chunks(SHARE))
            .into_par_iter()
            .enumerate()
            .for_each(|(task, (found, positions))| {
                found.clear();
                for (k, position) in positions.iter().enumerate() {
                    let i = task * SHARE + k;
                    finder.find(i, position, reach(particles, i), found);
                }
            });
        for entry in self.found.iter().flatten() {
            if entry.peer == MYSELF {
                let images = (1..8).filter(|code| entry.needs >> code & 1 == 1);
                let base = entry.particle as usize;
                self.own.extend(images.map(|code| Image::new(base, code)));
            } else {
                let (particles, needs) = &mut self.sends[usize::from(entry.peer)];
                particles.push(entry.particle);
                needs.push(entry.needs);
            }
        }
    }
}
