//! Particles in the order of their ids, in even blocks over the ranks that write.
//!
//! Ranks own particles in any order, independent of ids: a rank may have rows of any block. So rows go
//! in two transfers over groups of some √P ranks, first to a rank of the group that has their block,
//! then within the group. No rank sends more than 2√P messages for a field. Beside its own particles
//! and its own block a rank has the rows that pass through it, one field at a time: as much as its own
//! again, and a few times that where many ranks have rows for one group.
//!
//! Boundaries are ids, found by bisection on counts, all at once: those of groups by all ranks,
//! those of blocks by each group for itself. Up to three ranks are one group, for which the second
//! transfer is enough.

mod groups;
mod transfer;

use comm::{Comm, Exchange};
use model::Sharing;

use super::{Block, OutputError, agree};
use groups::Groups;
use transfer::{Routes, Transfer};

pub use transfer::Gathered;

/// Most rows of a writer, which are counted in `u32`.
const MOST_ROWS: u64 = 1 << 31;

/// Rows of a writer where a case does not tell how many ranks write: 16 MB of vectors.
const ROWS: u64 = (16 << 20) / 24;

/// Ranks that write then, at least: those of a node or less.
const FEW: u64 = 16;

/// Number of ranks that write `total` rows: the wanted number, or by bytes, if they can hold them.
fn writers(wanted: Option<usize>, total: u64, ranks: usize) -> usize {
    let number = |count: u64| usize::try_from(count).unwrap_or(usize::MAX);
    let by_bytes = number(total.div_ceil(ROWS).max(FEW));
    let least = number(total.div_ceil(MOST_ROWS));
    wanted.unwrap_or(by_bytes).max(least).clamp(1, ranks)
}

/// The first transfer, to the groups of ranks.
struct ToGroups {
    groups: Groups,
    /// The ranks of this one's group.
    group: Comm,
    routes: Routes,
    transfer: Transfer,
    /// Values on their way through this rank.
    passing: Vec<u8>,
}

impl ToGroups {
    /// Over all ranks, unless they are one group. Collective.
    fn new(comm: &Comm) -> Option<Self> {
        let (groups, rank) = (Groups::of(comm.size()), comm.rank());
        (groups.count() > 1).then(|| Self {
            groups,
            group: comm.among(groups.members(groups.group(rank))),
            routes: Routes {
                to: groups.gates(rank).collect(),
                from: groups.guests(rank).collect(),
            },
            transfer: Transfer::default(),
            passing: Vec::new(),
        })
    }
}

/// Gathers particles as rows in id order. Buffers are kept from one output to the next.
#[derive(Default)]
pub struct Rows {
    sharing: Sharing,
    block: Block,
    /// Ranks that the transfers are for.
    ranks: usize,
    to_groups: Option<ToGroups>,
    to_blocks: Transfer,
    exchange: Exchange,
}

impl Rows {
    /// For files that ranks share so.
    #[must_use]
    pub fn new(sharing: Sharing) -> Self {
        Self {
            sharing,
            ..Self::default()
        }
    }

    /// The sharing of files among ranks.
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
        let ranks = comm.size();
        if self.ranks != ranks {
            self.ranks = ranks;
            self.to_groups = ToGroups::new(comm);
        }
        let first = self.to_groups.as_mut();
        let first = first.map_or(&mut self.to_blocks, |first| &mut first.transfer);
        let mut total = [first.choose(ids, chosen)];
        comm.sum_u64(&mut total);
        let total = total[0];
        let writers = writers(self.sharing.writers, total, ranks);
        let block = |rank: usize| Block::shared(total, rank, ranks, writers);
        self.block = block(comm.rank());

        let (mut group, mut members, mut ids) = (comm, 0..ranks, ids);
        if let Some(first) = &mut self.to_groups {
            let groups = first.groups;
            let starts = (0..groups.count()).map(|k| block(groups.members(k).start).first);
            let starts: Vec<u64> = starts.collect();
            let exchange = &mut self.exchange;
            let transfer = &mut first.transfer;
            transfer.plan(comm, exchange, ids, &starts, &first.routes);
            members = groups.members(groups.group(comm.rank()));
            (group, ids) = (&first.group, first.transfer.ids());
            self.to_blocks.choose(ids, (0..).take(ids.len()));
        }
        let begin = block(members.start).first;
        let starts: Vec<u64> = members.map(|rank| block(rank).first - begin).collect();
        let routes = Routes::all(group);
        self.to_blocks
            .plan(group, &mut self.exchange, ids, &starts, &routes);
        agree(comm, self.check())
    }

    /// Refuses ids that two particles have.
    fn check(&self) -> Result<(), OutputError> {
        let mut pairs = self.to_blocks.ids().windows(2);
        match pairs.find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(OutputError::DuplicateId { id: pair[0] }),
            None => Ok(()),
        }
    }

    /// One field's rows of this rank's block in id order, from its owned particles' values
    /// `[owned × size]` bytes. Collective, after [`Self::plan`].
    pub fn collect<'a>(&'a mut self, comm: &Comm, values: &'a [u8], size: usize) -> Gathered<'a> {
        let exchange = &mut self.exchange;
        match &mut self.to_groups {
            Some(first) => {
                let passing = first.transfer.carry(comm, exchange, values, size);
                passing.copy_to(&mut first.passing);
                (self.to_blocks).carry(&first.group, exchange, &first.passing, size)
            }
            None => self.to_blocks.carry(comm, exchange, values, size),
        }
    }
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
    fn many_ranks_have_writers_by_bytes() {
        assert_eq!(writers(None, 0, 1), 1);
        assert_eq!(writers(None, 10_000_000, 10_000), 16);
        // 10⁵ particles of each of 128 ranks on a node: some 18 writers a node.
        assert_eq!(writers(None, 1_000_000_000, 10_000), 1431);
        assert_eq!(writers(None, 1 << 40, 10_000), 10_000);
    }

    #[test]
    fn a_lone_rank_sorts_by_id() {
        let comm = Comm::solo();
        let mut rows = Rows::default();
        let ids = [7, u64::MAX, 0, 3];
        rows.plan(&comm, &ids).unwrap();
        assert_eq!(rows.block(), Block::even(4, 0, 1));
        let values: Vec<[u32; 3]> = (0..4).map(|i| [i, 10 * i, 100 * i]).collect();
        let bytes = rows.collect(&comm, bytemuck::cast_slice(&values), 12).all();
        let sorted: Vec<[u32; 3]> = bytemuck::pod_collect_to_vec(&bytes);
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
        assert_eq!(bytes.all(), [13, 10]);
        rows.plan_of(&comm, &ids, []).unwrap();
        let none = rows.collect(&comm, &[10, 11, 12, 13], 1);
        assert_eq!(none.count(), 0);
    }

    #[test]
    fn equal_ids_are_refused() {
        let refused = Rows::default().plan(&Comm::solo(), &[4, 9, 4]);
        assert!(matches!(refused, Err(OutputError::DuplicateId { id: 4 })));
    }
}
