//! A transfer of rows from each rank to those with the sections that they belong to.

use std::ops::Range;

use rayon::prelude::*;

use comm::{self, Comm, Exchange};
use particles::GRAIN;

/// Ranks that this one sends to and receives from, itself included.
#[derive(Debug, Clone, Default)]
pub struct Routes {
    /// The rank that each section goes to, ascending.
    pub to: Vec<usize>,
    /// Ranks that send here, ascending.
    pub from: Vec<usize>,
}

impl Routes {
    /// Each rank has a section, for which all others have rows.
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
    /// Range of [`Transfer::order`] that goes there.
    send: Range<usize>,
    /// Range of the arriving rows that come from there.
    receive: Range<usize>,
}

/// Rows go to the sections of all rows that their ids belong to, and are there in the order of ids.
/// Buffers are kept from one output to the next.
#[derive(Debug, Default)]
pub struct Transfer {
    /// This rank's rows that are chosen, by id.
    order: Vec<u32>,
    peers: Vec<Peer>,
    /// Range of `order` that stays here.
    own: Range<usize>,
    /// By row of the section: the number of the arriving row, own ones first, then by peer.
    arrivals: Vec<u32>,
    /// Ids of the section, ascending.
    ids: Vec<u64>,
}

/// Values of a section in the order of ids, of which any range can be filled.
pub struct Gathered<'a> {
    transfer: &'a Transfer,
    /// Received messages.
    messages: &'a [comm::Peer],
    /// Values of this rank's rows.
    values: &'a [u8],
    /// Bytes of a row.
    size: usize,
}

impl Transfer {
    /// Chooses some of this rank's rows, whose ids are `ids[i]`; returns their number.
    pub fn choose(&mut self, ids: &[u64], chosen: impl IntoIterator<Item = u32>) -> u64 {
        self.order.clear();
        self.order.extend(chosen);
        self.order.par_sort_unstable_by_key(|&i| ids[i as usize]);
        self.order.len() as u64
    }

    /// Finds the destinations of the rows chosen from `ids`. Sections begin at the rows `starts` of all
    /// ranks' rows. Collective.
    pub fn plan(
        &mut self,
        comm: &Comm,
        exchange: &mut Exchange,
        ids: &[u64],
        starts: &[u64],
        routes: &Routes,
    ) {
        let cuts = find_cuts(comm, starts, ids, &self.order);
        self.choose_peers(comm, exchange, &cuts, routes);
        let arriving = (self.peers.last()).map_or(self.own.len(), |peer| peer.receive.end);
        self.arrivals.clear();
        self.arrivals
            .extend(0..u32::try_from(arriving).expect("a section fits u32"));
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

    /// The ids of this rank's section, ascending, after [`Self::plan`].
    pub fn ids(&self) -> &[u64] {
        &self.ids
    }

    /// Exchanges the numbers of rows. The k-th section of `order` starts at `cuts[k]`.
    fn choose_peers(
        &mut self,
        comm: &Comm,
        exchange: &mut Exchange,
        cuts: &[usize],
        routes: &Routes,
    ) {
        let section = |rank: usize| match routes.to.binary_search(&rank) {
            Ok(k) => cuts[k]..cuts[k + 1],
            Err(_) => 0..0,
        };
        let mut ranks = [&routes.to[..], &routes.from].concat();
        ranks.sort_unstable();
        ranks.dedup();
        ranks.retain(|&rank| rank != comm.rank());
        exchange.set_peers(ranks.iter().copied());
        for (k, rank) in ranks.iter().enumerate() {
            if routes.to.binary_search(rank).is_ok() {
                let count = section(*rank).len() as u64;
                exchange.outgoing(k).extend(count.to_ne_bytes());
            }
            if routes.from.binary_search(rank).is_ok() {
                exchange.expect(k, 8);
            }
        }
        exchange.post(comm);
        exchange.wait();
        self.own = section(comm.rank());
        let mut arriving = self.own.len();
        self.peers.clear();
        for (k, rank) in ranks.into_iter().enumerate() {
            let count = exchange.incoming(k).first_chunk().copied();
            let receive = count.map_or(0, u64::from_ne_bytes);
            let receive = usize::try_from(receive).expect("a count fits memory");
            let receive = arriving..arriving + receive;
            arriving = receive.end;
            let send = section(rank);
            if !receive.is_empty() || !send.is_empty() {
                self.peers.push(Peer {
                    rank,
                    send,
                    receive,
                });
            }
        }
    }

    /// The values of this rank's section in the order of ids, from those of its rows, `[rows × size]`.
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
            gather(bytes, order, size, |i| row_of(values, i as usize, size));
        }
        exchange.post(comm);
        exchange.wait();
        Gathered {
            transfer: self,
            messages: exchange.incoming_all(),
            values,
            size,
        }
    }
}

impl Gathered<'_> {
    /// Number of rows.
    pub fn count(&self) -> usize {
        self.transfer.arrivals.len()
    }

    /// Some rows, `[rows × size]` bytes.
    pub fn fill(&self, rows: Range<usize>, bytes: &mut [u8]) {
        let (transfer, size) = (self.transfer, self.size);
        let own = &transfer.order[transfer.own.clone()];
        let arrived = |k: u32| {
            if let Some(&i) = own.get(k as usize) {
                return row_of(self.values, i as usize, size);
            }
            let from = |peer: &Peer| peer.receive.end <= k as usize;
            let peer = transfer.peers.partition_point(from);
            let row = k as usize - transfer.peers[peer].receive.start;
            row_of(self.messages[peer].incoming(), row, size)
        };
        gather(bytes, &transfer.arrivals[rows], size, arrived);
    }

    /// Replaces the content of a buffer by all rows.
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

/// The k-th of rows of `size` bytes.
fn row_of(rows: &[u8], k: usize, size: usize) -> &[u8] {
    &rows[k * size..(k + 1) * size]
}

/// Fills `bytes` with the rows of an order, of `size` bytes each.
fn gather<'a>(bytes: &mut [u8], order: &[u32], size: usize, row: impl Fn(u32) -> &'a [u8] + Sync) {
    let pieces = bytes.par_chunks_mut(GRAIN * size);
    let pieces = pieces.zip(order.par_chunks(GRAIN));
    pieces.for_each(|(bytes, order)| {
        for (target, &i) in bytes.chunks_exact_mut(size).zip(order) {
            target.copy_from_slice(row(i));
        }
    });
}

/// The start of each section in this rank's `order`, and the length of that at the end. Sections start
/// at the rows `starts` of all ranks' rows. Bisects for the largest id of all rows before each section,
/// every boundary at once. Collective.
fn find_cuts(comm: &Comm, starts: &[u64], ids: &[u64], order: &[u32]) -> Vec<usize> {
    let sections = starts.len();
    let up_to = |id: u64| order.partition_point(|&i| ids[i as usize] <= id);
    let mut bounds = [
        order.first().map_or(u64::MAX, |&i| ids[i as usize]),
        u64::MAX - order.last().map_or(0, |&i| ids[i as usize]),
    ];
    comm.min_u64(&mut bounds);
    let mut lower = vec![bounds[0]; sections];
    let mut upper = vec![u64::MAX - bounds[1]; sections];
    let mut counts = vec![0; sections];
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
        for k in 0..sections {
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
    let mut cuts: Vec<usize> = (0..sections)
        .map(|k| if starts[k] == 0 { 0 } else { up_to(lower[k]) })
        .collect();
    cuts.push(order.len());
    cuts
}
