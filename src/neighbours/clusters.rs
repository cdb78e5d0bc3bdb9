//! Lists of the own group's neighbours for clusters of eight receivers.

use std::ops::Range;

use rayon::prelude::*;

use super::sequence::Sequence;
use crate::sph::dispatch::{Instructions, Vectorised, instructions};
use crate::sph::lanes::{LANES, Lanes};

/// Clusters that one task handles.
pub const CLUSTERS_PER_CHUNK: usize = 64;

/// Up to eight owned particles of one group that stand side by side in canonical order.
#[derive(Debug, Clone, Copy)]
pub struct Cluster {
    /// Places in the sequence; unused lanes repeat the last valid one.
    pub receivers: [u32; LANES],
    /// Valid lanes.
    pub lanes: usize,
    /// Group of bodies.
    pub group: usize,
}

/// What is among the neighbours of a cluster.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Among {
    /// Images behind symmetry planes.
    pub mirrors: bool,
    /// Particles of other ranks.
    pub halo: bool,
}

/// Clusters and neighbour lists of one task.
#[derive(Debug, Clone, Default)]
pub struct Chunk {
    clusters: Vec<Cluster>,
    /// End of each cluster's neighbours in `neighbours`, and what is among them.
    ends: Vec<(u32, Among)>,
    neighbours: Vec<u32>,
}

impl Chunk {
    /// The clusters, each with its neighbours in canonical order and what is among those.
    pub fn iter(&self) -> impl Iterator<Item = (&Cluster, &[u32], Among)> {
        self.clusters.iter().enumerate().map(|(k, cluster)| {
            let start = if k == 0 { 0 } else { self.ends[k - 1].0 };
            let (end, among) = self.ends[k];
            (
                cluster,
                &self.neighbours[start as usize..end as usize],
                among,
            )
        })
    }

    fn build(&mut self, set: Instructions, sequence: &Sequence, owned: usize, reach: &[f64]) {
        self.neighbours.clear();
        self.ends.clear();
        let Self {
            clusters,
            ends,
            neighbours,
        } = self;
        for cluster in clusters {
            let among = set.run(ListNeighbours {
                sequence,
                owned,
                cluster,
                reach: reach[cluster.group],
                neighbours,
            });
            #[allow(
                clippy::cast_possible_truncation,
                reason = "64 clusters' lists fit u32"
            )]
            ends.push((neighbours.len() as u32, among));
        }
    }
}

/// Appends the neighbours of a cluster to a list; tells what is among them.
struct ListNeighbours<'a> {
    sequence: &'a Sequence,
    owned: usize,
    cluster: &'a Cluster,
    reach: f64,
    neighbours: &'a mut Vec<u32>,
}

impl Vectorised for ListNeighbours<'_> {
    type Output = Among;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Among {
        let sequence = self.sequence;
        let (lower, upper, h) = bounds(sequence, &self.cluster.receivers);
        let far = (h + self.reach) * INFLATION;
        let low = lower.map(V::splat);
        let high = upper.map(V::splat);
        let own = V::splat(h);
        let mut among = Among::default();
        sequence.in_box(
            self.cluster.group,
            &lower.map(|x| x - far),
            &upper.map(|x| x + far),
            |places| {
                for first in places.clone().step_by(LANES) {
                    let gap = |a: usize| {
                        let x = V::read(sequence.coordinates(a, first));
                        let gap = low[a].sub(x).max(x.sub(high[a])).max(V::splat(0.0));
                        gap.mul(gap)
                    };
                    let range = V::read(sequence.lengths(first)).add(own);
                    let range2 = range.mul(range).mul(V::splat(INFLATION));
                    let near = gap(0).add(gap(1)).add(gap(2)).less_than(range2);
                    let left = places.end - first;
                    let mut bits = if left < LANES {
                        near & ((1 << left) - 1)
                    } else {
                        near
                    };
                    while bits != 0 {
                        let place = first + bits.trailing_zeros() as usize;
                        bits &= bits - 1;
                        #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
                        self.neighbours.push(place as u32);
                        let image = sequence.images()[place];
                        among.mirrors |= image.code() != 0;
                        among.halo |= image.base() >= self.owned;
                    }
                }
            },
        );
        among
    }
}

/// Box tests reach this much farther than the kernel, so that rounding
/// never drops a pair with a contribution.
pub(super) const INFLATION: f64 = 1.0 + 1e-9;

/// All clusters of a rank with their lists. Buffers are kept from step to step.
#[derive(Debug, Clone, Default)]
pub struct ClusterLists {
    chunks: Vec<Chunk>,
    used: usize,
}

impl ClusterLists {
    /// Groups the owned particles (store indices below `owned`) into clusters and lists the
    /// neighbours of each. `reach[g]` is the largest smoothing length (m) among the images of
    /// group g.
    pub fn build(&mut self, sequence: &Sequence, owned: usize, reach: &[f64]) {
        let set = instructions();
        self.gather_clusters(sequence, owned);
        self.chunks[..self.used]
            .par_iter_mut()
            .for_each(|chunk| chunk.build(set, sequence, owned, reach));
    }

    /// The tasks, for parallel iteration.
    #[must_use]
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks[..self.used]
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.chunks
            .iter()
            .map(|chunk| {
                4 * chunk.neighbours.capacity()
                    + 8 * chunk.ends.capacity()
                    + size_of::<Cluster>() * chunk.clusters.capacity()
            })
            .sum()
    }

    fn gather_clusters(&mut self, sequence: &Sequence, owned: usize) {
        for chunk in &mut self.chunks {
            chunk.clusters.clear();
        }
        self.used = 0;
        for group in 0..sequence.groups() {
            let mut cluster = Cluster {
                receivers: [0; LANES],
                lanes: 0,
                group,
            };
            let Range { start, end } = sequence.group(group);
            for place in start..end {
                let image = sequence.images()[place];
                if image.code() != 0 || image.base() >= owned {
                    continue;
                }
                #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
                cluster.receivers[cluster.lanes..].fill(place as u32);
                cluster.lanes += 1;
                if cluster.lanes == LANES {
                    self.push(cluster);
                    cluster.lanes = 0;
                }
            }
            if cluster.lanes > 0 {
                self.push(cluster);
            }
        }
    }

    fn push(&mut self, cluster: Cluster) {
        let full =
            self.used == 0 || self.chunks[self.used - 1].clusters.len() == CLUSTERS_PER_CHUNK;
        if full {
            if self.used == self.chunks.len() {
                self.chunks.push(Chunk::default());
            }
            self.used += 1;
        }
        self.chunks[self.used - 1].clusters.push(cluster);
    }
}

/// Box around eight receivers (m) and their largest smoothing length (m).
#[inline(always)]
pub(super) fn bounds(sequence: &Sequence, receivers: &[u32; LANES]) -> ([f64; 3], [f64; 3], f64) {
    let at = |axis: usize, place: u32| sequence.coordinates(axis, place as usize)[0];
    let mut lower = std::array::from_fn(|a| at(a, receivers[0]));
    let mut upper: [f64; 3] = lower;
    let mut h: f64 = 0.0;
    for &place in receivers {
        for a in 0..3 {
            lower[a] = f64::min(lower[a], at(a, place));
            upper[a] = f64::max(upper[a], at(a, place));
        }
        h = h.max(sequence.lengths(place as usize)[0]);
    }
    (lower, upper, h)
}

/// Square of the distance between a box and a point (m²).
#[inline]
pub(super) fn distance2(lower: &[f64; 3], upper: &[f64; 3], point: &[f64; 3]) -> f64 {
    let mut sum = 0.0;
    for a in 0..3 {
        let gap = (lower[a] - point[a]).max(point[a] - upper[a]).max(0.0);
        sum += gap * gap;
    }
    sum
}
