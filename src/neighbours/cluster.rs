//! Clusters of eight receivers, and lists of their neighbours.

use crate::numerics::lanes::LANES;

/// Up to eight owned particles of one group that stand side by side.
#[derive(Debug, Clone, Copy)]
pub struct Cluster {
    /// Places in the sequence, ascending; unused lanes repeat the last valid one.
    pub receivers: [u32; LANES],
    /// Valid lanes.
    pub lanes: usize,
    /// Group of bodies.
    pub group: usize,
    /// Box around the receivers (m).
    pub lower: [f64; 3],
    /// Upper end of the box (m).
    pub upper: [f64; 3],
}

/// What is among the neighbours of a cluster.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Among {
    /// Images behind symmetry planes.
    pub mirrors: bool,
    /// Particles of other ranks.
    pub halo: bool,
    /// Anything that is not at the group's common velocity.
    pub moving: bool,
}

impl Cluster {
    /// The longest smoothing length of the receivers (m), of those of all places.
    #[inline(always)]
    pub(super) fn longest(&self, lengths: &[f64]) -> f64 {
        let longer = |h, &i: &u32| f64::max(h, lengths[i as usize]);
        self.receivers.iter().fold(0.0, longer)
    }

    /// The receivers without repetitions.
    pub(crate) fn valid(&self) -> &[u32] {
        &self.receivers[..self.lanes]
    }
}

/// Clusters with their neighbours.
#[derive(Debug, Clone, Default)]
pub(super) struct Lists {
    pub(super) clusters: Vec<Cluster>,
    /// End of each cluster's neighbours in `neighbours`, and what is among them.
    pub(super) ends: Vec<(u32, Among)>,
    /// The lists one after the other, and unused space.
    pub(super) neighbours: Vec<u32>,
}

impl Lists {
    /// The clusters, each with its neighbours and what is among those.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&Cluster, &[u32], Among)> {
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

    pub(super) fn clear(&mut self) {
        self.clusters.clear();
        self.ends.clear();
        self.neighbours.clear();
    }

    /// Adds a cluster whose neighbours are those behind the last one's.
    pub(super) fn push(&mut self, cluster: Cluster, among: Among) {
        self.clusters.push(cluster);
        #[allow(clippy::cast_possible_truncation, reason = "a chunk's lists fit u32")]
        self.ends.push((self.neighbours.len() as u32, among));
    }

    pub(super) fn memory(&self) -> usize {
        size_of::<Cluster>() * self.clusters.capacity()
            + size_of::<(u32, Among)>() * self.ends.capacity()
            + 4 * self.neighbours.capacity()
    }
}
