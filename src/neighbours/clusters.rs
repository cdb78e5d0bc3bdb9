//! Lists of the own group's neighbours for clusters of eight receivers.

use std::ops::Range;

use rayon::prelude::*;

use super::sequence::Sequence;
use crate::sph::gradient::MotionRecord;
use crate::sph::lanes::LANES;

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

/// Clusters and neighbour lists of one task.
#[derive(Debug, Clone, Default)]
pub struct Chunk {
    clusters: Vec<Cluster>,
    /// End of each cluster's neighbours in `neighbours`, and whether mirror images are among them.
    ends: Vec<(u32, bool)>,
    neighbours: Vec<u32>,
}

impl Chunk {
    /// The clusters, each with its neighbours in canonical order and whether mirror images are
    /// among them.
    pub fn iter(&self) -> impl Iterator<Item = (&Cluster, &[u32], bool)> {
        self.clusters.iter().enumerate().map(|(k, cluster)| {
            let start = if k == 0 { 0 } else { self.ends[k - 1].0 };
            let (end, mirrored) = self.ends[k];
            (
                cluster,
                &self.neighbours[start as usize..end as usize],
                mirrored,
            )
        })
    }

    fn build(&mut self, sequence: &Sequence, sources: &[MotionRecord], reach: &[f64]) {
        self.neighbours.clear();
        self.ends.clear();
        for cluster in &self.clusters {
            let own = cluster.receivers.map(|k| sources[k as usize]);
            let (lower, upper) = bounding_box(&own);
            let h = own
                .iter()
                .map(|r| r.smoothing_length)
                .fold(0.0, f64::max);
            let far = (h + reach[cluster.group]) * INFLATION;
            let mut mirrored = false;
            let neighbours = &mut self.neighbours;
            sequence.in_box(
                cluster.group,
                &lower.map(|x| x - far),
                &upper.map(|x| x + far),
                |place| {
                    let source = &sources[place as usize];
                    let range = h + source.smoothing_length;
                    if distance2(&lower, &upper, &source.position) < range * range * INFLATION {
                        neighbours.push(place);
                        mirrored |= sequence.images()[place as usize].code() != 0;
                    }
                },
            );
            #[allow(clippy::cast_possible_truncation, reason = "64 clusters' lists fit u32")]
            self.ends.push((neighbours.len() as u32, mirrored));
        }
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
    /// neighbours of each. `sources` are the images in the order of `sequence`; `reach[g]` is
    /// the largest smoothing length (m) among the images of group g.
    pub fn build(
        &mut self,
        sequence: &Sequence,
        owned: usize,
        sources: &[MotionRecord],
        reach: &[f64],
    ) {
        self.gather_clusters(sequence, owned);
        self.chunks[..self.used]
            .par_iter_mut()
            .for_each(|chunk| chunk.build(sequence, sources, reach));
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
        let full = self.used == 0
            || self.chunks[self.used - 1].clusters.len() == CLUSTERS_PER_CHUNK;
        if full {
            if self.used == self.chunks.len() {
                self.chunks.push(Chunk::default());
            }
            self.used += 1;
        }
        self.chunks[self.used - 1].clusters.push(cluster);
    }
}

/// Box around eight records (m).
pub(super) fn bounding_box(records: &[MotionRecord; LANES]) -> ([f64; 3], [f64; 3]) {
    let mut lower = records[0].position;
    let mut upper = lower;
    for record in &records[1..] {
        for a in 0..3 {
            lower[a] = lower[a].min(record.position[a]);
            upper[a] = upper[a].max(record.position[a]);
        }
    }
    (lower, upper)
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
