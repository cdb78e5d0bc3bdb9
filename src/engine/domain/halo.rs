//! Halo exchange: copies of other ranks' particles within reach of this rank's, and the images
//! of all of them behind symmetry planes.

use std::ops::Range;

use rayon::prelude::*;

use super::chosen::{Chosen, of_peer};
use super::needs::{Extent, Finder, MYSELF, Needed};
use super::nested::NestedSlabs;
use super::payload::Payload;
use comm::{Comm, Exchange, Traffic};
use numerics::collector::Collector;
use particles::{
    Active, ActiveMut, HaloImages, HaloPhase, Image, MirrorMask, Mirrors, ParticleStore,
    copy_at_once,
};

/// Slabs of ranks: each has its particles in its own slab.
#[derive(Debug, Clone, Copy)]
pub struct Reaches<'a> {
    /// The slabs.
    pub slabs: &'a NestedSlabs,
    /// Largest reach of the particles of all ranks (m).
    pub farthest: f64,
}

/// Halo lists and buffers, kept from step to step.
pub struct Halo {
    rank: usize,
    mirrors: Mirrors,
    exchange: Exchange,
    /// Extents to and from all ranks that are near.
    extent_exchange: Exchange,
    /// The box around this rank's particles.
    mine: Extent,
    /// The ranks to talk to, ascending.
    peers: Vec<usize>,
    /// Their extents.
    theirs: Vec<Extent>,
    chosen: Chosen,
    /// For each peer, how many particles it sent.
    received: Vec<usize>,
    /// Images of owned particles.
    own: Vec<Image>,
    /// Halo particles of lower ranks with their images, [`Self::own`], those of higher ranks.
    others: Vec<Image>,
    /// Number of them that are of lower ranks or behind a plane.
    below: usize,
    /// Needs that the tasks found, one after the other: see [`Needed`].
    found: Vec<Vec<Needed>>,
    collector: Collector,
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
            extent_exchange: Exchange::default(),
            mine: Extent::EMPTY,
            peers: Vec::new(),
            theirs: Vec::new(),
            chosen: Chosen::default(),
            received: Vec::new(),
            own: Vec::new(),
            others: Vec::new(),
            below: 0,
            found: Vec::new(),
            collector: Collector::default(),
        }
    }

    /// Decides who needs whom and starts to send their motion. A pair of particles
    /// interacts within the sum of their `reach` (m); nobody needs inactive particles. Collective.
    pub fn post_motion(
        &mut self,
        comm: &Comm,
        reaches: Reaches,
        active: ActiveMut,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        let (particles, inactive) = (active.particles, active.inactive);
        particles.resize_halo(0);
        let active = Active {
            particles,
            inactive,
        };
        self.rank = comm.rank();
        self.find_extent(active.particles, &reach);
        self.find_peers(comm, reaches);
        self.choose(active, &reach);
        let (chosen, store) = (&self.chosen, active.particles);
        let phase = store.motion_phase();
        fill(&mut self.exchange, |k, message| {
            message.extend_from_slice(&chosen.mirror_masks[chosen.of(k)]);
            store.pack(phase, &chosen.particles[chosen.of(k)], message);
        });
        self.exchange.post_with_sizes(comm);
    }

    /// Receives what [`Self::post_motion`] of the others sent, and lists the halo particles and
    /// their images behind planes.
    pub fn finish_motion(&mut self, particles: &mut ParticleStore) {
        self.exchange.wait();
        let phase = particles.motion_phase();
        let size = 1 + particles.bytes_per_particle(phase);
        self.received.clear();
        for k in 0..self.exchange.peers() {
            self.received.push(self.exchange.incoming(k).len() / size);
        }
        particles.resize_halo(self.received.iter().sum());
        let (exchange, received) = (&self.exchange, &self.received);
        let (peers, first) = (exchange.incoming_all(), particles.owned());
        particles.unpack_all(phase, first, received, |k| {
            &peers[k].incoming()[received[k]..]
        });
        let lower = (0..exchange.peers()).filter(|&k| exchange.rank(k) < self.rank);
        let lower = lower.count();
        self.others.clear();
        let above = self.list_images(0..lower, first);
        self.others.par_extend(self.own.par_iter().copied());
        self.below = self.others.len();
        self.list_images(lower..self.received.len(), above);
    }

    /// Lists the images of what some peers have sent, which stands in the store from a place on. Gives the
    /// place after it.
    fn list_images(&mut self, peers: Range<usize>, mut first: usize) -> usize {
        for k in peers {
            let needs = &self.exchange.incoming(k)[..self.received[k]];
            let images = |i: usize| images(first + i, needs[i]);
            let all = (needs.len(), SHARE);
            self.collector.extend(&mut self.others, all, images);
            first += needs.len();
        }
        first
    }

    /// [`Self::post_motion`] and [`Self::finish_motion`]. Collective.
    #[track_caller]
    pub fn exchange_motion(
        &mut self,
        comm: &Comm,
        reaches: Reaches,
        active: ActiveMut,
        reach: impl Fn(&ParticleStore, usize) -> f64 + Sync,
    ) {
        let (particles, inactive) = (active.particles, active.inactive);
        let active = ActiveMut {
            particles,
            inactive,
        };
        self.post_motion(comm, reaches, active, reach);
        self.finish_motion(particles);
    }

    /// [`Self::post`] and [`Self::finish`] of fields alone. Collective.
    #[track_caller]
    pub fn exchange(&mut self, comm: &Comm, particles: &mut ParticleStore, phase: HaloPhase) {
        self.post(comm, particles, phase, None);
        self.finish(particles, phase, None);
    }

    /// Starts to send the fields of `phase` of the same particles, and what else they show.
    pub fn post(
        &mut self,
        comm: &Comm,
        particles: &ParticleStore,
        phase: HaloPhase,
        payload: Option<&dyn Payload>,
    ) {
        let size = particles.bytes_per_particle(phase) + payload.map_or(0, Payload::size);
        let chosen = &self.chosen;
        fill(&mut self.exchange, |k, message| {
            let sent = &chosen.particles[chosen.of(k)];
            particles.pack(phase, sent, message);
            if let Some(payload) = payload {
                let fields = message.len();
                message.resize(sent.len() * size, 0);
                let slots = message[fields..].par_chunks_exact_mut(payload.size());
                let slots = slots.zip(sent).with_min_len(SHARE);
                slots.for_each(|(slot, &i)| slot.copy_from_slice(payload.of(i as usize)));
            }
        });
        for (k, count) in self.received.iter().enumerate() {
            self.exchange.expect(k, count * size);
        }
        self.exchange.post(comm);
    }

    /// Receives what [`Self::post`] of the others sent.
    pub fn finish(
        &mut self,
        particles: &mut ParticleStore,
        phase: HaloPhase,
        payload: Option<&mut dyn Payload>,
    ) {
        self.exchange.wait();
        let (peers, first) = (self.exchange.incoming_all(), particles.owned());
        let (received, size) = (&self.received, particles.bytes_per_particle(phase));
        particles.unpack_all(phase, first, received, |k| {
            &peers[k].incoming()[..received[k] * size]
        });
        if let Some(payload) = payload {
            let mut rest = payload.received(particles.halo());
            for (peer, count) in peers.iter().zip(received) {
                let values = &peer.incoming()[count * size..];
                let (slots, after) = rest.split_at_mut(values.len());
                copy_at_once(values, slots);
                rest = after;
            }
        }
    }

    /// Gives halo particles the values of their owners: those of this rank's particles stand first
    /// in `values`, those of halo particles after them. Collective.
    #[track_caller]
    pub fn exchange_values<T: bytemuck::Pod + Sync>(&mut self, comm: &Comm, values: &mut [T]) {
        let size = size_of::<T>();
        let (chosen, sent) = (&self.chosen, &*values);
        fill(&mut self.exchange, |k, message| {
            let particles = &chosen.particles[chosen.of(k)];
            message.resize(particles.len() * size, 0);
            let slots = message.par_chunks_exact_mut(size).zip(particles);
            slots.with_min_len(SHARE).for_each(|(slot, &i)| {
                slot.copy_from_slice(bytemuck::bytes_of(&sent[i as usize]));
            });
        });
        for (k, count) in self.received.iter().enumerate() {
            self.exchange.expect(k, count * size);
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

    /// Images beside this rank's own particles: [`Self::others`].
    #[must_use]
    pub fn images(&self) -> HaloImages<'_> {
        HaloImages {
            images: &self.others,
            below: self.below,
            mirrors: &self.mirrors,
        }
    }

    /// The symmetry planes.
    #[must_use]
    pub fn mirrors(&self) -> &Mirrors {
        &self.mirrors
    }

    /// Messages and bytes sent so far.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        let mut all = self.exchange.traffic;
        all += self.extent_exchange.traffic;
        all
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let found = |found: &Vec<Needed>| size_of::<Needed>() * found.capacity();
        self.exchange.memory()
            + self.extent_exchange.memory()
            + 8 * (self.received.capacity() + self.peers.capacity())
            + size_of::<Extent>() * self.theirs.capacity()
            + size_of::<Image>() * (self.own.capacity() + self.others.capacity())
            + self.chosen.memory()
            + self.found.iter().map(found).sum::<usize>()
            + self.collector.memory()
    }

    fn find_extent(
        &mut self,
        particles: &ParticleStore,
        reach: &(impl Fn(&ParticleStore, usize) -> f64 + Sync),
    ) {
        self.mine = (particles.position.par_chunks(SHARE).enumerate())
            .map(|(task, positions)| {
                let mut part = Extent::EMPTY;
                for (k, position) in positions.iter().enumerate() {
                    part.add(position, reach(particles, task * SHARE + k));
                }
                part
            })
            // same bits in any order: smallest and largest numbers
            .reduce(|| Extent::EMPTY, Extent::join);
    }

    /// Ranks whose slabs are near tell each other the boxes around their particles. Peers are those
    /// whose particles may stand within reach of this rank's, by a test that both sides answer alike.
    fn find_peers(&mut self, comm: &Comm, Reaches { slabs, farthest }: Reaches) {
        let range = 2.0 * farthest;
        self.peers.clear();
        slabs.near(self.rank, range, |other| self.peers.push(other));
        let (extent_exchange, mine) = (&mut self.extent_exchange, self.mine);
        extent_exchange.set_peers(self.peers.iter().copied());
        for k in 0..extent_exchange.peers() {
            extent_exchange
                .outgoing(k)
                .extend_from_slice(bytemuck::bytes_of(&mine));
            extent_exchange.expect(k, size_of::<Extent>());
        }
        extent_exchange.post(comm);
        extent_exchange.wait();
        self.peers.clear();
        self.theirs.clear();
        for k in 0..extent_exchange.peers() {
            let extent: Extent = bytemuck::pod_read_unaligned(extent_exchange.incoming(k));
            if mine.may_need(&extent) {
                self.peers.push(extent_exchange.rank(k));
                self.theirs.push(extent);
            }
        }
        self.exchange.set_peers(self.peers.iter().copied());
    }

    /// Fills the lists of particles and images to send, and those of this rank's own images that
    /// stand near its own particles.
    fn choose(&mut self, active: Active, reach: &(impl Fn(&ParticleStore, usize) -> f64 + Sync)) {
        let (particles, peers) = (active.particles, self.peers.len());
        self.own.clear();
        self.chosen.clear(peers);
        if peers == 0 && self.mirrors.is_empty() {
            return;
        }
        let finder = Finder::new(&self.mirrors, self.mine, &self.theirs);
        let tasks = particles.position.len().div_ceil(SHARE);
        self.found.resize(tasks, Vec::new());
        (&mut self.found, particles.position.par_chunks(SHARE))
            .into_par_iter()
            .enumerate()
            .for_each(|(task, (found, positions))| {
                found.clear();
                active
                    .inactive
                    .each_active(task * SHARE, positions.len(), |k| {
                        let i = task * SHARE + k;
                        finder.find(i, &positions[k], reach(particles, i), found);
                    });
                found.sort_unstable_by_key(|entry| (entry.peer, entry.particle));
            });
        let found = &self.found;
        self.chosen.sort(found, peers, &mut self.collector);
        let own = |task: usize| {
            let run = of_peer(&found[task], MYSELF);
            run.iter()
                .flat_map(|entry| images(entry.particle as usize, entry.needs))
        };
        self.collector.extend(&mut self.own, (tasks, 1), own);
    }
}

/// The images of a particle that `needs` names, in the order of their mirror masks.
fn images(slot: usize, needs: u8) -> impl Iterator<Item = Image> {
    let is_needed = move |mirror_mask: &MirrorMask| needs >> mirror_mask.bits() & 1 == 1;
    MirrorMask::all()
        .filter(is_needed)
        .map(move |mirror_mask| Image::new(slot, mirror_mask))
}

/// Has all threads fill the messages to all peers.
fn fill(exchange: &mut Exchange, fill: impl Fn(usize, &mut Vec<u8>) + Sync) {
    let peers = exchange.outgoing_all().par_iter_mut().enumerate();
    peers.for_each(|(k, peer)| {
        let message = peer.outgoing();
        message.clear();
        fill(k, message);
    });
}
