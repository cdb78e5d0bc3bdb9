//! Particles in the order of their ids, in even blocks over the ranks that write.
//!
//! Ranks own particles in any order. Block boundaries are ids, found by bisection on counts, all
//! at once; then each field's rows travel straight to their block. No rank ever holds more than
//! its own particles and its own block.

use std::ops::Range;

use crate::comm::{Comm, Exchange};
use crate::model::Sharing;

use super::{Block, OutputError, agree};

/// A rank that particles are sent to or received from.
#[derive(Debug, Clone)]
struct Peer {
    rank: usize,
    /// Which part of [`Rows::order`] goes there.
    send: Range<usize>,
    /// Rows that come from there.
    receive: usize,
}

/// Most rows of a writer, whose places are counted in `u32`.
const MOST_ROWS: u64 = 1 << 31;

/// How many of the ranks write so many rows: as many as are asked for, if they can hold them.
fn writers(asked: Option<usize>, total: u64, ranks: usize) -> usize {
    let least = usize::try_from(total.div_ceil(MOST_ROWS)).unwrap_or(usize::MAX);
    asked.unwrap_or(ranks).max(least).clamp(1, ranks)
}

/// The way of particles to rows in id order. Buffers are kept from one output to the next.
#[derive(Default)]
pub struct Rows {
    sharing: Sharing,
    block: Block,
    /// This rank's particles, by id.
    order: Vec<u32>,
    peers: Vec<Peer>,
    /// Part of `order` that stays here.
    own: Range<usize>,
    /// Row in the block of each arriving particle: own ones first, then by peer.
    places: Vec<u32>,
    exchange: Exchange,
    bytes: Vec<u8>,
}

impl Rows {
    /// For files that are written so.
    #[must_use]
    pub fn new(sharing: Sharing) -> Self {
        Self {
            sharing,
            ..Self::default()
        }
    }

    /// How files are written.
    #[must_use]
    pub fn sharing(&self) -> Sharing {
        self.sharing
    }

    /// This rank's block, after [`Self::plan`].
    #[must_use]
    pub fn block(&self) -> Block {
        self.block
    }

    /// Finds the row of every particle from this rank's ids `[owned]`. Collective.
    ///
    /// # Errors
    /// [`OutputError::DuplicateId`], the same on every rank.
    ///
    /// # Panics
    /// If this rank owns 2³² particles or more, which no store can hold.
    pub fn plan(&mut self, comm: &Comm, ids: &[u64]) -> Result<(), OutputError> {
        let particles = u32::try_from(ids.len()).expect("a rank's particles fit u32");
        self.plan_of(comm, ids, 0..particles)
    }

    /// As [`Self::plan`], of some particles alone: the others have no rows. Collective.
    ///
    /// # Errors
    /// [`OutputError::DuplicateId`], the same on every rank.
    pub fn plan_of(
        &mut self,
        comm: &Comm,
        ids: &[u64],
        chosen: impl IntoIterator<Item = u32>,
    ) -> Result<(), OutputError> {
        self.order.clear();
        self.order.extend(chosen);
        self.order.sort_unstable_by_key(|&i| ids[i as usize]);
        let mut total = [self.order.len() as u64];
        comm.sum_u64(&mut total);
        let (total, ranks) = (total[0], comm.size());
        let writers = writers(self.sharing.writers, total, ranks);
        let block = |rank: usize| Block::shared(total, rank, ranks, writers);
        self.block = block(comm.rank());

        let starts: Vec<u64> = (0..ranks).map(|rank| block(rank).first).collect();
        let cuts = find_cuts(comm, &starts, ids, &self.order);
        self.choose_peers(comm, &cuts);
        let placed = self.place(comm, ids);
        agree(comm, placed)
    }

    /// Who sends how much to whom. `cuts[r]` is where rank r's part of `order` starts.
    fn choose_peers(&mut self, comm: &Comm, cuts: &[usize]) {
        let sends: Vec<u64> = cuts.windows(2).map(|c| (c[1] - c[0]) as u64).collect();
        let mut receives = Vec::new();
        comm.all_to_all_u64(&sends, &mut receives);
        let me = comm.rank();
        self.own = cuts[me]..cuts[me + 1];
        self.peers.clear();
        for (rank, receive) in receives.into_iter().enumerate() {
            let receive = usize::try_from(receive).expect("a count fits memory");
            let send = cuts[rank]..cuts[rank + 1];
            if rank != me && (receive > 0 || !send.is_empty()) {
                self.peers.push(Peer {
                    rank,
                    send,
                    receive,
                });
            }
        }
    }

    /// Learns the ids that arrive, and thereby the row of each.
    fn place(&mut self, comm: &Comm, ids: &[u64]) -> Result<(), OutputError> {
        let arriving = self.own.len() + self.peers.iter().map(|p| p.receive).sum::<usize>();
        self.places.clear();
        self.places
            .extend(0..u32::try_from(arriving).expect("a block fits u32"));
        self.move_rows(comm, bytemuck::cast_slice(ids), 8);
        let arrived: Vec<u64> = bytemuck::pod_collect_to_vec(&self.bytes);
        let mut by_id = self.places.clone();
        by_id.sort_unstable_by_key(|&k| arrived[k as usize]);
        for (row, &k) in (0_u32..).zip(&by_id) {
            self.places[k as usize] = row;
        }
        for pair in by_id.windows(2) {
            let id = arrived[pair[0] as usize];
            if id == arrived[pair[1] as usize] {
                return Err(OutputError::DuplicateId { id });
            }
        }
        Ok(())
    }

    /// One field's rows of this rank's block in id order, `[block.count × size]` bytes, from its
    /// owned particles' values `[owned × size]`. Collective, after [`Self::plan`].
    pub fn collect(&mut self, comm: &Comm, values: &[u8], size: usize) -> &mut [u8] {
        self.move_rows(comm, values, size);
        &mut self.bytes
    }

    fn move_rows(&mut self, comm: &Comm, values: &[u8], size: usize) {
        let row = |i: u32| &values[i as usize * size..(i as usize + 1) * size];
        self.exchange.set_peers(self.peers.iter().map(|p| p.rank));
        for (k, peer) in self.peers.iter().enumerate() {
            self.exchange.expect(k, peer.receive * size);
            let message = self.exchange.outgoing(k);
            message.reserve(peer.send.len() * size);
            for &i in &self.order[peer.send.clone()] {
                message.extend_from_slice(row(i));
            }
        }
        self.exchange.post(comm);
        self.bytes.resize(self.places.len() * size, 0);
        let (own_places, mut places) = self.places.split_at(self.own.len());
        for (&i, &place) in self.order[self.own.clone()].iter().zip(own_places) {
            put(&mut self.bytes, place, row(i));
        }
        self.exchange.wait();
        for (k, peer) in self.peers.iter().enumerate() {
            let (here, rest) = places.split_at(peer.receive);
            for (row, &place) in self.exchange.incoming(k).chunks_exact(size).zip(here) {
                put(&mut self.bytes, place, row);
            }
            places = rest;
        }
    }
}

fn put(bytes: &mut [u8], place: u32, row: &[u8]) {
    let at = place as usize * row.len();
    bytes[at..at + row.len()].copy_from_slice(row);
}

/// Where each rank's block, which `starts` at such a row, starts in this rank's `order`, and its
/// length at the end: bisects for the largest id of all rows before each block, every boundary at
/// once. Collective.
fn find_cuts(comm: &Comm, starts: &[u64], ids: &[u64], order: &[u32]) -> Vec<usize> {
    let ranks = comm.size();
    let up_to = |id: u64| order.partition_point(|&i| ids[i as usize] <= id);
    let mut bounds = [
        order.first().map_or(u64::MAX, |&i| ids[i as usize]),
        u64::MAX - order.last().map_or(0, |&i| ids[i as usize]),
    ];
    comm.min_u64(&mut bounds);
    let mut lower = vec![bounds[0]; ranks];
    let mut upper = vec![u64::MAX - bounds[1]; ranks];
    let mut counts = vec![0; ranks];
    while lower.iter().zip(&upper).any(|(lower, upper)| lower < upper) {
        let middle = |r: usize| lower[r] + (upper[r] - lower[r]) / 2;
        for (r, count) in counts.iter_mut().enumerate() {
            *count = if lower[r] < upper[r] {
                up_to(middle(r)) as u64
            } else {
                0
            };
        }
        comm.sum_u64(&mut counts);
        for r in 0..ranks {
            if lower[r] < upper[r] {
                let middle = lower[r] + (upper[r] - lower[r]) / 2;
                if counts[r] >= starts[r] {
                    upper[r] = middle;
                } else {
                    lower[r] = middle + 1;
                }
            }
        }
    }
    let mut cuts: Vec<usize> = (0..ranks)
        .map(|r| if starts[r] == 0 { 0 } else { up_to(lower[r]) })
        .collect();
    cuts.push(order.len());
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_rows_than_a_writer_can_count_have_more_writers() {
        assert_eq!(writers(None, 10, 4), 4);
        assert_eq!(writers(Some(9), 10, 4), 4);
        assert_eq!(writers(Some(1), 1 << 31, 10_000), 1);
        assert_eq!(writers(Some(1), (1 << 31) + 1, 10_000), 2);
        assert_eq!(writers(Some(1), 1 << 40, 10_000), 512);
    }

    #[test]
    fn a_lone_rank_sorts_by_id() {
        let comm = Comm::solo();
        let mut rows = Rows::default();
        let ids = [7, u64::MAX, 0, 3];
        rows.plan(&comm, &ids).unwrap();
        assert_eq!(rows.block(), Block::even(4, 0, 1));
        let values: Vec<[u32; 3]> = (0..4).map(|i| [i, 10 * i, 100 * i]).collect();
        let bytes = rows.collect(&comm, bytemuck::cast_slice(&values), 12);
        let sorted: Vec<[u32; 3]> = bytemuck::pod_collect_to_vec(bytes);
        assert_eq!(
            sorted,
            [[2, 20, 200], [3, 30, 300], [0, 0, 0], [1, 10, 100]]
        );
    }

    #[test]
    fn particles_that_are_not_chosen_have_no_rows() {
        let (comm, mut rows) = (Comm::solo(), Rows::default());
        let ids = [7, 7, 0, 3];
        rows.plan_of(&comm, &ids, [0, 3]).unwrap();
        assert_eq!(rows.block(), Block::even(2, 0, 1));
        let bytes = rows.collect(&comm, &[10, 11, 12, 13], 1);
        assert_eq!(bytes, [13, 10]);
        rows.plan_of(&comm, &ids, []).unwrap();
        assert!(rows.collect(&comm, &[10, 11, 12, 13], 1).is_empty());
    }

    #[test]
    fn equal_ids_are_refused() {
        let refused = Rows::default().plan(&Comm::solo(), &[4, 9, 4]);
        assert!(matches!(refused, Err(OutputError::DuplicateId { id: 4 })));
    }
}
