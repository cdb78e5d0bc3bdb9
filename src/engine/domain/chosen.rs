//! The particles that go to each peer.

use std::ops::Range;

use super::needs::{MYSELF, Needed};
use numerics::collector::Collector;

/// For each peer, one after the other, the particles that it needs. Kept from step to step.
#[derive(Debug, Default)]
pub(super) struct Chosen {
    pub(super) particles: Vec<u32>,
    /// The mirror masks of the images that it needs of each (a set of eight bits).
    pub(super) mirror_masks: Vec<u8>,
    /// End of those of each peer.
    ends: Vec<usize>,
}

impl Chosen {
    /// Nothing for so many peers.
    pub(super) fn clear(&mut self, peers: usize) {
        self.particles.clear();
        self.mirror_masks.clear();
        self.ends.clear();
        self.ends.resize(peers, 0);
    }

    /// Takes what tasks have found, each in the order of peers, for so many of them.
    pub(super) fn sort(&mut self, found: &[Vec<Needed>], peers: usize, collector: &mut Collector) {
        self.clear(peers);
        let tasks = found.len();
        let peer = |k: usize| u16::try_from(k / tasks).unwrap_or(MYSELF);
        let run = |k: usize| of_peer(&found[k % tasks], peer(k)).iter();
        let all = (peers * tasks, 1);
        collector.extend(&mut self.particles, all, |k| run(k).map(|e| e.particle));
        collector.extend(&mut self.mirror_masks, all, |k| run(k).map(|e| e.needs));
        let ends = collector.ends().chunks_exact(tasks.max(1));
        for (end, of_tasks) in self.ends.iter_mut().zip(ends) {
            *end = of_tasks[tasks - 1];
        }
    }

    /// The places of what the k-th peer needs.
    pub(super) fn of(&self, k: usize) -> Range<usize> {
        let start = k.checked_sub(1).map_or(0, |before| self.ends[before]);
        start..self.ends[k]
    }

    pub(super) fn memory(&self) -> usize {
        4 * self.particles.capacity() + self.mirror_masks.capacity() + 8 * self.ends.capacity()
    }
}

/// Entries that a task has found for a peer: they are in the order of peers.
pub(super) fn of_peer(found: &[Needed], peer: u16) -> &[Needed] {
    let start = found.partition_point(|entry| entry.peer < peer);
    let end = found.partition_point(|entry| entry.peer <= peer);
    &found[start..end]
}
