//! Particles and messages of each rank in a step, counted by one process for any number of ranks.
//!
//! Owners, peers and needs are those of the halo itself, by the same code.

use std::ops::Range;

use rayon::prelude::*;

use super::needs::{Extent, Finder, MYSELF, Needed};
use super::nested::{Decomposition, NestedSlabs};
use particles::Mirrors;

/// Particles that a rank owns, and those that a step brings it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Its own particles.
    pub owned: u64,
    /// Particles of other ranks.
    pub halo: u64,
    /// Images that its sums run over beside its own particles: particles of other ranks, and
    /// images of all of them behind symmetry planes.
    pub images: u64,
    /// Ranks that it exchanges messages with.
    pub peers: u64,
}

/// Message of a rank to a peer in each exchange.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sent {
    /// Sender.
    pub from: usize,
    /// Receiver.
    pub to: usize,
    /// Number of particles, perhaps none.
    pub particles: u64,
}

/// Ranks that are looked at before what they send is told.
const BLOCK: usize = 1024;

/// Bytes of the message in which ranks that are near tell each other where their particles are.
pub const EXTENT_MESSAGE: u64 = size_of::<Extent>() as u64;

/// Tells which rank greets which other, if no particle reaches farther than that (m).
pub fn extent_exchange(slabs: &NestedSlabs, farthest: f64, mut emit: impl FnMut(usize, usize)) {
    for from in 0..slabs.ranks() {
        slabs.near(from, 2.0 * farthest, |to| emit(from, to));
    }
}

/// Counts for particles at `positions` (m), which reach so far (m), and tells what each rank sends, by
/// rank and by peer.
pub fn tally(
    slabs: &NestedSlabs,
    mirrors: &Mirrors,
    (positions, reach): (&[[f64; 3]], &[f64]),
    mut emit: impl FnMut(Sent),
) -> Vec<Tally> {
    let dealt = Dealt::new(slabs, positions, reach);
    let boxes = Boxes::new(dealt.extents());
    let ranks = slabs.ranks();
    let mut tallies = vec![Tally::default(); ranks];
    for first in (0..ranks).step_by(BLOCK) {
        let block = first..ranks.min(first + BLOCK);
        let all: Vec<Needs> = (block.clone().into_par_iter())
            .map(|rank| Needs::of(&dealt, &boxes, mirrors, rank))
            .collect();
        for (from, needs) in block.zip(all) {
            let tally = &mut tallies[from];
            tally.owned = dealt.of(from).len() as u64;
            tally.images += needs.own_images;
            tally.peers = needs.peers.len() as u64;
            for (&to, &(particles, images)) in needs.peers.iter().zip(&needs.sent) {
                tallies[to].halo += particles;
                tallies[to].images += images;
                emit(Sent {
                    from,
                    to,
                    particles,
                });
            }
        }
    }
    tallies
}

/// Particles in the order of their ranks.
struct Dealt {
    /// Beginning of those of each rank, and the end.
    starts: Vec<usize>,
    positions: Vec<[f64; 3]>,
    reach: Vec<f64>,
}

impl Dealt {
    fn new(slabs: &NestedSlabs, positions: &[[f64; 3]], reach: &[f64]) -> Self {
        let owners: Vec<usize> = positions.par_iter().map(|x| slabs.owner(x)).collect();
        let mut starts = vec![0; slabs.ranks() + 1];
        for &owner in &owners {
            starts[owner + 1] += 1;
        }
        for rank in 0..slabs.ranks() {
            starts[rank + 1] += starts[rank];
        }
        let mut next = starts.clone();
        let mut dealt = Self {
            starts,
            positions: vec![[0.0; 3]; positions.len()],
            reach: vec![0.0; positions.len()],
        };
        for ((&owner, &position), &reach) in owners.iter().zip(positions).zip(reach) {
            let place = next[owner];
            next[owner] += 1;
            dealt.positions[place] = position;
            dealt.reach[place] = reach;
        }
        dealt
    }

    /// The places of a rank's particles.
    fn of(&self, rank: usize) -> Range<usize> {
        self.starts[rank]..self.starts[rank + 1]
    }

    fn particles(&self, rank: usize) -> impl Iterator<Item = (&[f64; 3], f64)> {
        let places = self.of(rank);
        let reach = self.reach[places.clone()].iter();
        self.positions[places].iter().zip(reach.copied())
    }

    /// By rank.
    fn extents(&self) -> Vec<Extent> {
        let extent = |rank| {
            let mut extent = Extent::EMPTY;
            for (position, reach) in self.particles(rank) {
                extent.add(position, reach);
            }
            extent
        };
        let ranks = 0..self.starts.len() - 1;
        ranks.into_par_iter().map(extent).collect()
    }
}

/// The extents of all ranks, of two that follow each other, of four and so on: ranks that follow each
/// other are near each other, so that few of many have to be looked at.
struct Boxes {
    /// By how often two have been joined.
    stages: Vec<Vec<Extent>>,
}

impl Boxes {
    fn new(extents: Vec<Extent>) -> Self {
        let mut stages = vec![extents];
        while let Some(last) = stages.last().filter(|last| last.len() > 1) {
            let join = |two: &[Extent]| two.iter().fold(Extent::EMPTY, |all, &one| all.join(one));
            stages.push(last.chunks(2).map(join).collect());
        }
        Self { stages }
    }

    fn of(&self, rank: usize) -> Extent {
        self.stages[0][rank]
    }

    /// The peers of a rank, ascending.
    fn peers(&self, rank: usize) -> Vec<usize> {
        let mine = self.of(rank);
        let mut peers = Vec::new();
        let mut waiting = vec![(self.stages.len() - 1, 0)];
        while let Some((stage, place)) = waiting.pop() {
            // What is not near some ranks together is near none of them.
            if !mine.may_need(&self.stages[stage][place]) {
                continue;
            }
            if stage > 0 {
                let parts = [2 * place + 1, 2 * place];
                let below = self.stages[stage - 1].len();
                let parts = parts.into_iter().filter(|&part| part < below);
                waiting.extend(parts.map(|part| (stage - 1, part)));
            } else if place != rank {
                peers.push(place);
            }
        }
        peers
    }
}

/// Particles of a rank that others need.
struct Needs {
    /// Images of its own particles that it needs itself.
    own_images: u64,
    peers: Vec<usize>,
    /// For each peer, particles that it needs, and how many they and their images are.
    sent: Vec<(u64, u64)>,
}

impl Needs {
    fn of(dealt: &Dealt, boxes: &Boxes, mirrors: &Mirrors, rank: usize) -> Self {
        let peers = boxes.peers(rank);
        let mut needs = Self {
            own_images: 0,
            sent: vec![(0, 0); peers.len()],
            peers,
        };
        if needs.peers.is_empty() && mirrors.is_empty() {
            return needs;
        }
        let theirs: Vec<Extent> = needs.peers.iter().map(|&peer| boxes.of(peer)).collect();
        let finder = Finder::new(mirrors, boxes.of(rank), &theirs);
        let mut found: Vec<Needed> = Vec::new();
        for (position, reach) in dealt.particles(rank) {
            found.clear();
            finder.find(0, position, reach, &mut found);
            for entry in &found {
                let images = u64::from(entry.needs.count_ones());
                if entry.peer == MYSELF {
                    needs.own_images += images;
                } else {
                    let sent = &mut needs.sent[usize::from(entry.peer)];
                    *sent = (sent.0 + 1, sent.1 + images);
                }
            }
        }
        needs
    }
}
