//! Lists that lanes do not share: of the neighbours of a cluster those that each receiver itself sums.

use super::cluster::Cluster;
use numerics::lanes::LANES;

/// Neighbours of the receivers of a chunk, cluster by cluster: each lane has a place in its cluster's list, in the order of that
/// list, and where it has no more the place of its receiver, which adds nothing to itself.
#[derive(Debug, Clone, Default)]
pub(super) struct CloseLists {
    /// End of each cluster's part of `places`.
    ends: Vec<u32>,
    places: Vec<[u16; LANES]>,
    /// Of one cluster, for each neighbour of the list a bit for each receiver that sums it.
    bits: Vec<u8>,
}

impl CloseLists {
    /// What a cluster's lanes sum; empty where nothing is listed, or too much.
    #[inline]
    pub(super) fn of(&self, cluster: usize) -> &[[u16; LANES]] {
        let Some(&end) = self.ends.get(cluster) else {
            return &[];
        };
        let start = cluster.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.places[start as usize..end as usize]
    }

    pub(super) fn clear(&mut self) {
        self.ends.clear();
        self.places.clear();
    }

    /// Adds the next cluster with its list; `near` writes a byte for each neighbour: bit k if lane k sums it.
    pub(super) fn push(
        &mut self,
        cluster: &Cluster,
        list: &[u32],
        near: impl FnOnce(&Cluster, &[u32], &mut Vec<u8>),
    ) {
        let start = self.places.len();
        if u16::try_from(list.len()).is_ok() {
            let mut bits = std::mem::take(&mut self.bits);
            bits.clear();
            near(cluster, list, &mut bits);
            let mut own = [0; LANES];
            for (own, receiver) in own.iter_mut().zip(&cluster.receivers) {
                *own = list.iter().position(|at| at == receiver).unwrap_or(0);
            }
            let mut used = [start; LANES];
            for (at, &bits) in bits.iter().enumerate() {
                for k in (0..LANES).filter(|&k| bits >> k & 1 == 1 && own[k] != at) {
                    if used[k] == self.places.len() {
                        self.grow(&own);
                    }
                    #[allow(
                        clippy::cast_possible_truncation,
                        reason = "lists that are this short"
                    )]
                    (self.places[used[k]][k] = at as u16);
                    used[k] += 1;
                }
            }
            self.bits = bits;
        }
        #[allow(clippy::cast_possible_truncation, reason = "a chunk's lists fit u32")]
        self.ends.push(self.places.len() as u32);
    }

    /// Adds a row in which each lane has its receiver.
    fn grow(&mut self, own: &[usize; LANES]) {
        let places = &mut self.places;
        if places.len() == places.capacity() {
            places.reserve_exact(places.len() / 16 + (1 << 9));
        }
        #[allow(clippy::cast_possible_truncation, reason = "lists that are this short")]
        places.push(own.map(|at| at as u16));
    }

    /// Gives room back that the lists do not take.
    pub(super) fn fit(&mut self) {
        let used = self.places.len();
        if self.places.capacity() > used + used / 4 + (1 << 9) {
            self.places.shrink_to(used + used / 16);
        }
    }

    pub(super) fn memory(&self) -> usize {
        4 * self.ends.capacity() + 2 * LANES * self.places.capacity() + self.bits.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each lane has its own neighbours in their order, without itself, then itself.
    #[test]
    fn lanes_have_lists_of_their_own() {
        let mut receivers = [12; LANES];
        receivers[..2].copy_from_slice(&[10, 11]);
        let cluster = Cluster {
            receivers,
            lanes: 3,
            group: 0,
            lower: [0.0; 3],
            upper: [0.0; 3],
        };
        let mut lists = CloseLists::default();
        lists.push(&cluster, &[12], |_, _, _| ());
        lists.push(&cluster, &[7, 10, 11, 12, 14], |_, list, bits| {
            assert_eq!(list.len(), 5);
            bits.extend([0b001, 0b011, 0b111, 0b110, 0b1000_0100]);
        });
        assert!(lists.of(0).is_empty());
        let lane = |k: usize| -> Vec<u16> { lists.of(1).iter().map(|row| row[k]).collect() };
        let lanes = [0, 1, 2, 6, 7].map(lane);
        let wanted: [Vec<u16>; 5] = [vec![0, 2], vec![1, 3], vec![2, 4], vec![3, 3], vec![4, 3]];
        assert_eq!(lanes, wanted);
        assert!(lists.of(2).is_empty());
    }
}
