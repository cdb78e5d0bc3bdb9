//! Own neighbours that are none: particles of another part of the same body leave the lists of the
//! SPH sums and become foreign ones. Lists whose particles are all of one part stay as they are.

use rayon::prelude::*;

use super::clusters::{Among, CHUNKS_AT_ONCE, Chunk, Cluster, ClusterLists};
use super::foreign::PairList;
use crate::numerics::lanes::LANES;

/// The part of a body that an image belongs to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Part {
    /// Smallest id of the part's particles.
    pub label: u64,
    /// Code of the symmetry planes behind which the image stands and that do not cut the part.
    pub code: u64,
}

/// What tells particles of one part from strangers.
#[derive(Debug, Clone, Copy)]
pub struct Kin<'a> {
    /// Parts of the images, by their places.
    pub parts: &'a [Part],
    /// Places of the images at the start, where those that began farther from each other than one
    /// are strangers too; else empty.
    pub references: &'a [[f64; 3]],
}

impl Kin<'_> {
    /// Whether two images belong together.
    #[must_use]
    pub fn own(&self, a: u32, b: u32) -> bool {
        self.parts[a as usize] == self.parts[b as usize] && self.near(a, b)
    }

    fn near(&self, a: u32, b: u32) -> bool {
        if self.references.is_empty() {
            return true;
        }
        let (a, b) = (&self.references[a as usize], &self.references[b as usize]);
        let r = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        r[0] * r[0] + r[1] * r[1] + r[2] * r[2] <= 1.0
    }

    /// Whether all of a cluster belong together with all of its neighbours.
    fn one(&self, cluster: &Cluster, neighbours: &[u32]) -> bool {
        let receivers = &cluster.receivers[..cluster.lanes];
        let part = self.parts[receivers[0] as usize];
        let same = |&place: &u32| self.parts[place as usize] == part;
        receivers.iter().all(same)
            && neighbours.iter().all(same)
            && (self.references.is_empty()
                || receivers
                    .iter()
                    .all(|&i| neighbours.iter().all(|&j| self.near(i, j))))
    }

    /// Whether two receivers have the same strangers among `neighbours`.
    fn agree(&self, a: u32, b: u32, neighbours: &[u32]) -> bool {
        self.parts[a as usize] == self.parts[b as usize]
            && (self.references.is_empty()
                || neighbours.iter().all(|&j| self.own(a, j) == self.own(b, j)))
    }
}

/// The strangers of a chunk's receivers, and lists in the making.
#[derive(Debug, Clone, Default)]
pub(super) struct Parted {
    pub(super) strangers: PairList,
    clusters: Vec<Cluster>,
    ends: Vec<(u32, Among)>,
    neighbours: Vec<u32>,
}

impl Parted {
    pub(super) fn memory(&self) -> usize {
        self.strangers.memory()
            + size_of::<Cluster>() * self.clusters.capacity()
            + size_of::<(u32, Among)>() * self.ends.capacity()
            + 4 * self.neighbours.capacity()
    }

    /// Takes over what of `cluster` belongs together with all its neighbours, in the order of its
    /// first receivers, each part with its own neighbours.
    fn split(&mut self, kin: &Kin, cluster: &Cluster, neighbours: &[u32], among: Among) {
        let receivers = &cluster.receivers[..cluster.lanes];
        let mut done = [false; LANES];
        for lead in 0..receivers.len() {
            if done[lead] {
                continue;
            }
            let mut part = *cluster;
            part.lanes = 0;
            for (k, &receiver) in receivers.iter().enumerate().skip(lead) {
                if !done[k] && (k == lead || kin.agree(receivers[lead], receiver, neighbours)) {
                    done[k] = true;
                    part.receivers[part.lanes..].fill(receiver);
                    part.lanes += 1;
                }
            }
            let own = |&&j: &&u32| kin.own(receivers[lead], j);
            self.neighbours.extend(neighbours.iter().filter(own));
            for &receiver in &part.receivers[..part.lanes] {
                let others = neighbours.iter().filter(|j| !own(j));
                self.strangers.add(receiver, others.copied());
            }
            self.push(part, among);
        }
    }

    fn push(&mut self, cluster: Cluster, among: Among) {
        self.clusters.push(cluster);
        #[allow(clippy::cast_possible_truncation, reason = "a chunk's lists fit u32")]
        self.ends.push((self.neighbours.len() as u32, among));
    }
}

impl Chunk {
    fn part(&mut self, kin: &Kin) {
        let mut parted = std::mem::take(&mut self.parted);
        parted.strangers.clear();
        let whole = |(cluster, list, _): (&Cluster, &[u32], Among)| {
            list.is_empty() || kin.one(cluster, list)
        };
        if !self.iter().all(whole) {
            parted.clusters.clear();
            parted.ends.clear();
            parted.neighbours.clear();
            for (cluster, list, among) in self.iter() {
                if whole((cluster, list, among)) {
                    parted.neighbours.extend_from_slice(list);
                    parted.push(*cluster, among);
                } else {
                    parted.split(kin, cluster, list, among);
                }
            }
            self.swap(
                &mut parted.clusters,
                &mut parted.ends,
                &mut parted.neighbours,
            );
        }
        self.parted = parted;
    }
}

impl ClusterLists {
    /// Takes strangers out of the lists. They become foreign neighbours.
    pub fn part(&mut self, kin: &Kin) {
        let chunks = self.chunks_mut().par_iter_mut();
        chunks
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|chunk| chunk.part(kin));
    }
}
