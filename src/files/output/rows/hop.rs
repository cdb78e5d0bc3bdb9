//! One way of rows: from each rank to those that have the parts where they belong.

use std::ops::Range;

use rayon::prelude::*;

use comm::{self, Comm, Exchange};
use particles::GRAIN;

/// Who sends to whom, itself included.
#[derive(Debug, Clone, Default)]
pub struct Ways {
    /// The rank that each part goes to, ascending.
    pub to: Vec<usize>,
    /// Ranks that send here, ascending.
    pub from: Vec<usize>,
}

impl Ways {
    /// Each rank has a part, for which all others have rows.
    pub fn all(comm: &Comm) -> Self {
        let ranks: Vec<usize> = (0..comm.size()).collect();
        Self {
            to: ranks.clone(),
            from: ranks,
        }
    }
}

/// A rank that rows are sent to or received from.
#[derive(Debug, Clone)]
struct Peer {
    rank: usize,
    /// Which part of [`Hop::order`] goes there.
    send: Range<usize>,
    /// Which of the arriving rows come from there.
    receive: Range<usize>,
}

/// Rows go to the parts of all rows that their ids belong to, and stand there in the order of ids.
/// Buffers are kept from one output to the next.
#[derive(Debug, Default)]
pub struct Hop {
    /// This rank's rows that go anywhere, by id.
    order: Vec<u32>,
    peers: Vec<Peer>,
    /// Part of `order` that stays here.
    own: Range<usize>,
    /// By row of the part: which arriving row it is, own ones first, then by peer.
    arrivals: Vec<u32>,
    /// Ids of the part, ascending.
    ids: Vec<u64>,
}

/// Values of a part in the order of ids, of which any can be had when they are wanted.
pub struct Gathered<'a> {
    hop: &'a Hop,
    /// What has arrived.
    messages: &'a [comm::Peer],
    /// Of this rank's rows.
    values: &'a [u8],
    /// Bytes of a row.
    size: usize,
}

impl Hop {
    /// Takes some of this rank's rows, whose ids are `ids[i]`; gives their number.
    pub fn choose(&mut self, ids: &[u64], chosen: impl IntoIterator<Item = u32>) -> u64 {
        self.order.clear();
        self.order.extend(chosen);
        self.order.par_sort_unstable_by_key(|&i| ids[i as usize]);
        self.order.len() as u64
    }

    /// Finds the way of the rows chosen from `ids`. Parts begin at such rows of all ranks' rows.
    /// Collective.
    pub fn plan(
        &mut self,
        comm: &Comm,
        exchange: &mut Exchange,
        (ids, starts): (&[u64], &[u64]),
        ways: &Ways,
    ) {
        let cuts = find_cuts(comm, starts, ids, &self.order);
        self.choose_peers(comm, exchange, &cuts, ways);
        let arriving = (self.peers.last()).map_or(self.own.len(), |peer| peer.receive.end);
        self.arrivals.clear();
        self.arrivals
            .extend(0..u32::try_from(arriving).expect("a part fits u32"));
        let values = bytemuck::cast_slice(ids);
        let mut arrived = vec![0_u64; arriving];
        self.carry(comm, exchange, values, 8)
            .fill(0..arriving, bytemuck::cast_slice_mut(&mut arrived));
        self.arrivals
            .par_sort_unstable_by_key(|&k| arrived[k as usize]);
        self.ids.clear();
        self.ids
            .extend(self.arrivals.iter().map(|&k| arrived[k as usize]));
    }

    /// The ids of this rank's part, ascending, after [`Self::plan`].
    pub fn ids(&self) -> &[u64] {
        &self.ids
    }

    /// Who sends how much to whom. `cuts[k]` is where the k-th part of `order` starts.
    fn choose_peers(&mut self, comm: &Comm, exchange: &mut Exchange, cuts: &[usize], ways: &Ways) {
        let part = |rank: usize| match ways.to.binary_search(&rank) {
            Ok(k) => cuts[k]..cuts[k + 1],
            Err(_) => 0..0,
        };
        let mut ranks = [&ways.to[..], &ways.from].concat();
        ranks.sort_unstable();
        ranks.dedup();
        ranks.retain(|&rank| rank != comm.rank());
        exchange.set_peers(ranks.iter().copied());
        for (k, rank) in ranks.iter().enumerate() {
            if ways.to.binary_search(rank).is_ok() {
                let count = part(*rank).len() as u64;
                exchange.outgoing(k).extend(count.to_ne_bytes());
            }
            if ways.from.binary_search(rank).is_ok() {
                exchange.expect(k, 8);
            }
        }
        exchange.post(comm);
        exchange.wait();
        self.own = part(comm.rank());
        let mut arriving = self.own.len();
        self.peers.clear();
        for (k, rank) in ranks.into_iter().enumerate() {
            let count = exchange.incoming(k).first_chunk().copied();
            let receive = count.map_or(0, u64::from_ne_bytes);
            let receive = usize::try_from(receive).expect("a count fits memory");
            let receive = arriving..arriving + receive;
            arriving = receive.end;
            let send = part(rank);
            if !receive.is_empty() || !send.is_empty() {
                self.peers.push(Peer {
                    rank,
                    send,
                    receive,
                });
            }
        }
    }

    /// The values of this rank's part in the order of ids, from those of its rows, `[rows × size]`.
    /// Collective, after [`Self::plan`].
    pub fn carry<'a>(
        &'a self,
        comm: &Comm,
        exchange: &'a mut Exchange,
        values: &'a [u8],
        size: usize,
    ) -> Gathered<'a> {
        exchange.set_peers(self.peers.iter().map(|p| p.rank));
        for (k, peer) in self.peers.iter().enumerate() {
            exchange.expect(k, peer.receive.len() * size);
            let order = &self.order[peer.send.clone()];
            let bytes = exchange.outgoing(k);
            bytes.resize(order.len() * size, 0);
            gather(bytes, (order, size), |i| row_of(values, i as usize, size));
        }
        exchange.post(comm);
        exchange.wait();
        Gathered {
            hop: self,
            messages: exchange.incoming_all(),
            values,
            size,
        }
    }
}

impl Gathered<'_> {
    /// Rows of the part.
    pub fn count(&self) -> usize {
        self.hop.arrivals.len()
    }

    /// Some rows, `[rows × size]` bytes.
    pub fn fill(&self, rows: Range<usize>, bytes: &mut [u8]) {
        let (hop, size) = (self.hop, self.size);
        let own = &hop.order[hop.own.clone()];
        let arrived = |k: u32| {
            if let Some(&i) = own.get(k as usize) {
                return row_of(self.values, i as usize, size);
            }
            let from = |peer: &Peer| peer.receive.end <= k as usize;
            let peer = hop.peers.partition_point(from);
            let place = k as usize - hop.peers[peer].receive.start;
            row_of(self.messages[peer].incoming(), place, size)
        };
        gather(bytes, (&hop.arrivals[rows], size), arrived);
    }

    /// Puts all rows in the place of what a buffer holds.
    pub fn copy_to(&self, bytes: &mut Vec<u8>) {
        bytes.resize(self.count() * self.size, 0);
        self.fill(0..self.count(), bytes);
    }

    /// All rows.
    pub fn all(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.copy_to(&mut bytes);
        bytes
    }
}

/// The k-th of rows of so many bytes.
fn row_of(rows: &[u8], k: usize, size: usize) -> &[u8] {
    &rows[k * size..(k + 1) * size]
}

/// Has `bytes` be the rows of an order, of so many bytes each.
fn gather<'a>(
    bytes: &mut [u8],
    (order, size): (&[u32], usize),
    row: impl Fn(u32) -> &'a [u8] + Sync,
) {
    let pieces = bytes.par_chunks_mut(GRAIN * size);
    let pieces = pieces.zip(order.par_chunks(GRAIN));
    pieces.for_each(|(bytes, order)| {
        for (place, &i) in bytes.chunks_exact_mut(size).zip(order) {
            place.copy_from_slice(row(i));
        }
    });
}

/// Where each part, which `starts` at such a row of all, starts in this rank's `order`, and its
/// length at the end: bisects for the largest id of all rows before each part, every boundary at
/// once. Collective.
fn find_cuts(comm: &Comm, starts: &[u64], ids: &[u64], order: &[u32]) -> Vec<usize> {
    let parts = starts.len();
    let up_to = |id: u64| order.partition_point(|&i| ids[i as usize] <= id);
    let mut bounds = [
        order.first().map_or(u64::MAX, |&i| ids[i as usize]),
        u64::MAX - order.last().map_or(0, |&i| ids[i as usize]),
    ];
    comm.min_u64(&mut bounds);
    let mut lower = vec![bounds[0]; parts];
    let mut upper = vec![u64::MAX - bounds[1]; parts];
    let mut counts = vec![0; parts];
    while lower.iter().zip(&upper).any(|(lower, upper)| lower < upper) {
        let middle = |k: usize| lower[k] + (upper[k] - lower[k]) / 2;
        for (k, count) in counts.iter_mut().enumerate() {
            *count = if lower[k] < upper[k] {
                up_to(middle(k)) as u64
            } else {
                0
            };
        }
        comm.sum_u64(&mut counts);
        for k in 0..parts {
            if lower[k] < upper[k] {
                let middle = lower[k] + (upper[k] - lower[k]) / 2;
                if counts[k] >= starts[k] {
                    upper[k] = middle;
                } else {
                    lower[k] = middle + 1;
                }
            }
        }
    }
    let mut cuts: Vec<usize> = (0..parts)
        .map(|k| if starts[k] == 0 { 0 } else { up_to(lower[k]) })
        .collect();
    cuts.push(order.len());
    cuts
}
