//! Clusters of eight receivers, and lists of their neighbours.

use numerics::lanes::LANES;

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

/// Kinds that are among the neighbours of a cluster.
#[allow(clippy::struct_excessive_bools, reason = "independent of each other")]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Among {
    /// Images behind symmetry planes.
    pub mirrors: bool,
    /// Particles of other ranks.
    pub halo: bool,
    /// Anything that is not at the group's common velocity.
    pub moving: bool,
    /// Not all that is in range: strangers have been taken out.
    pub parted: bool,
    /// Nothing that anybody sums: all in range rests, and belongs to this rank and this group. The list may be empty.
    pub resting: bool,
}

impl Among {
    /// Nothing that anybody needs.
    pub(super) const RESTING: Self = Self {
        mirrors: false,
        halo: false,
        moving: false,
        parted: false,
        resting: true,
    };
}

impl Cluster {
    /// The longest smoothing length of the receivers (m), of those of all places.
    #[inline(always)]
    pub(super) fn longest(&self, lengths: &[f64]) -> f64 {
        let longer = |h, &i: &u32| f64::max(h, lengths[i as usize]);
        self.receivers.iter().fold(0.0, longer)
    }

    /// The receivers without repetitions.
    #[must_use]
    pub fn valid(&self) -> &[u32] {
        &self.receivers[..self.lanes]
    }

    /// Takes over the receivers of another one.
    fn take(&mut self, other: &Self) {
        let rest = &mut self.receivers[self.lanes..];
        rest[..other.lanes].copy_from_slice(other.valid());
        rest[other.lanes..].fill(other.receivers[LANES - 1]);
        self.lanes += other.lanes;
        for a in 0..3 {
            self.lower[a] = self.lower[a].min(other.lower[a]);
            self.upper[a] = self.upper[a].max(other.upper[a]);
        }
    }
}

/// The box (m) around all receivers of some clusters; an empty one without any.
pub(super) fn around<'a>(clusters: impl Iterator<Item = &'a Cluster>) -> ([f64; 3], [f64; 3]) {
    let none = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    clusters.fold(none, |(lower, upper), cluster| {
        (
            std::array::from_fn(|a| lower[a].min(cluster.lower[a])),
            std::array::from_fn(|a| upper[a].max(cluster.upper[a])),
        )
    })
}

/// Neighbours that a cluster of several may have.
const FEW: usize = 32;

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

    /// Lets clusters that follow each other share their lanes where they have few neighbours and none
    /// in common, as lone particles do. A receiver keeps its neighbours in their order, among others out
    /// of its range: all that is in its range stood in its list, unless strangers were taken out.
    pub(super) fn join(&mut self) {
        let (mut kept, mut start) = (0, 0);
        for next in 1..self.clusters.len() {
            let (middle, among) = self.ends[next - 1];
            let (end, their) = self.ends[next];
            let (own, other) =
                self.neighbours[start..end as usize].split_at(middle as usize - start);
            let cluster = self.clusters[next];
            let joins = self.clusters[kept].lanes + cluster.lanes <= LANES
                && own.len() + other.len() <= FEW
                && among == their
                && !among.parted
                // Whose position is no number has no neighbours, and stays by itself.
                && !own.is_empty()
                && !other.is_empty()
                && !other.iter().any(|index| own.contains(index));
            if joins {
                self.clusters[kept].take(&cluster);
            } else {
                (kept, start) = (kept + 1, middle as usize);
                self.clusters[kept] = cluster;
            }
            self.ends[kept] = (end, their);
        }
        self.clusters.truncate(kept + 1);
        self.ends.truncate(kept + 1);
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

    /// Gives room back that the lists do not take: other matter comes to a chunk from step to step, and with
    /// it the longest lists of all. Those of what rests come and go, and keep it.
    pub(super) fn fit(&mut self) {
        let used = self.ends.last().map_or(0, |(end, _)| *end as usize);
        let rests = || self.ends.iter().any(|(_, among)| among.resting);
        if self.neighbours.len() > used + used / 4 + (1 << 10) && !rests() {
            self.neighbours.truncate(used + used / 16 + LANES);
            self.neighbours.shrink_to_fit();
        }
    }

    pub(super) fn memory(&self) -> usize {
        size_of::<Cluster>() * self.clusters.capacity()
            + size_of::<(u32, Among)>() * self.ends.capacity()
            + 4 * self.neighbours.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cluster of these receivers, with these neighbours.
    fn push(lists: &mut Lists, receivers: &[u32], neighbours: &[u32], among: Among) {
        let mut all = [*receivers.last().unwrap(); LANES];
        all[..receivers.len()].copy_from_slice(receivers);
        let cluster = Cluster {
            receivers: all,
            lanes: receivers.len(),
            group: 0,
            lower: [f64::from(receivers[0]); 3],
            upper: [f64::from(all[LANES - 1]); 3],
        };
        lists.neighbours.extend_from_slice(neighbours);
        lists.push(cluster, among);
    }

    fn joined(lists: &mut Lists) -> Vec<(Vec<u32>, Vec<u32>)> {
        lists.join();
        let all = lists.iter();
        all.map(|(cluster, list, _)| (cluster.valid().to_vec(), list.to_vec()))
            .collect()
    }

    #[test]
    fn lone_particles_share_lanes() {
        let mut lists = Lists::default();
        for k in 0..11 {
            push(&mut lists, &[k], &[k], Among::default());
        }
        let all: Vec<u32> = (0..11).collect();
        let wanted = [0..8, 8..11]
            .map(|k: std::ops::Range<usize>| (all[k.clone()].to_vec(), all[k].to_vec()));
        assert_eq!(joined(&mut lists), wanted);
        let (cluster, _, _) = lists.iter().next().unwrap();
        assert_eq!((cluster.lower, cluster.upper), ([0.0; 3], [7.0; 3]));
        assert_eq!(lists.iter().nth(1).unwrap().0.receivers[3..], [10; 5]);
    }

    #[test]
    fn who_has_neighbours_in_common_or_lacks_some_stays_apart() {
        let moving = Among {
            moving: true,
            ..Among::default()
        };
        let parted = Among {
            parted: true,
            ..Among::default()
        };
        let none = Among::default();
        let mut lists = Lists::default();
        let all: [(&[u32], &[u32], Among); 8] = [
            (&[0, 1], &[0, 1, 2], none),
            (&[2], &[1, 2], none),
            (&[3], &[3, 4], none),
            (&[5], &[5], moving),
            (&[6], &[6], parted),
            (&[7], &[7], parted),
            (&[8], &[], none),
            (&[9], &[], none),
        ];
        for (receivers, neighbours, among) in all {
            push(&mut lists, receivers, neighbours, among);
        }
        let wanted: [(&[u32], &[u32]); 7] = [
            (&[0, 1], &[0, 1, 2]),
            (&[2, 3], &[1, 2, 3, 4]),
            (&[5], &[5]),
            (&[6], &[6]),
            (&[7], &[7]),
            (&[8], &[]),
            (&[9], &[]),
        ];
        let wanted = wanted.map(|(a, b)| (a.to_vec(), b.to_vec()));
        assert_eq!(joined(&mut lists), wanted);
    }
}
