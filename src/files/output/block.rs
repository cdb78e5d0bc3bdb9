//! Blocks of rows: the share of each rank.

use comm::Comm;

/// One rank's share of the rows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Block {
    /// Rows of all ranks.
    pub total: u64,
    /// The first row here.
    pub first: u64,
    /// Rows here.
    pub count: usize,
}

impl Block {
    /// The even share of `rank` among `ranks`.
    ///
    /// # Panics
    /// If a share is longer than an address.
    #[must_use]
    pub fn even(total: u64, rank: usize, ranks: usize) -> Self {
        Self::shared(total, rank, ranks, ranks)
    }

    /// The share of `rank` where `writers` of the ranks, evenly spread, have even shares and the
    /// others none.
    ///
    /// # Panics
    /// If a share is longer than an address.
    #[must_use]
    pub fn shared(total: u64, rank: usize, ranks: usize, writers: usize) -> Self {
        // So many of the writers come before this rank, the first of which is rank 0.
        let before = |rank: usize| (rank * writers).div_ceil(ranks);
        let first = start(total, before(rank), writers);
        let end = start(total, before(rank + 1), writers);
        Self {
            total,
            first,
            count: usize::try_from(end - first).expect("a block fits memory"),
        }
    }

    /// All of a few rows on rank 0.
    #[must_use]
    pub fn on_root(total: usize, comm: &Comm) -> Self {
        Self {
            total: total as u64,
            first: 0,
            count: if comm.is_root() { total } else { 0 },
        }
    }

    /// Returns true if it holds the end of all rows; where there are none, if it is `root`'s.
    #[must_use]
    pub fn closes(self, root: bool) -> bool {
        if self.total == 0 {
            root
        } else {
            self.count > 0 && self.first + self.count as u64 == self.total
        }
    }
}

/// First row of a writer: `⌊total · rank / ranks⌋`.
fn start(total: u64, rank: usize, ranks: usize) -> u64 {
    let first = u128::from(total) * rank as u128 / ranks as u128;
    u64::try_from(first).unwrap_or(total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_even_and_cover_all_rows() {
        for (total, ranks) in [(0, 3), (1, 3), (7, 3), (7, 1), (1 << 60, 5)] {
            let mut next = 0;
            for rank in 0..ranks {
                let block = Block::even(total, rank, ranks);
                assert_eq!(block.first, next);
                next += block.count as u64;
                assert!(block.count as u64 <= total / ranks as u64 + 1);
            }
            assert_eq!(next, total);
        }
    }

    #[test]
    fn writers_are_spread_evenly_and_have_even_blocks() {
        for (total, ranks, writers) in [
            (1000, 7, 3),
            (1000, 7, 1),
            (10, 7, 7),
            (0, 5, 2),
            (2, 12, 4),
            (1 << 60, 10_000, 765),
        ] {
            let blocks: Vec<Block> = (0..ranks)
                .map(|rank| Block::shared(total, rank, ranks, writers))
                .collect();
            let mut next = 0;
            for block in &blocks {
                assert_eq!((block.total, block.first), (total, next));
                next += block.count as u64;
            }
            assert_eq!(next, total);
            let full = blocks.iter().filter(|block| block.count > 0);
            let (most, least) = (
                full.clone().map(|b| b.count).max(),
                full.clone().map(|b| b.count).min(),
            );
            assert!(most.unwrap_or(0) - least.unwrap_or(0) <= 1);
            assert_eq!(full.count() as u64, total.min(writers as u64));
            let closing = (0..ranks).filter(|&rank| blocks[rank].closes(rank == 0));
            assert_eq!(closing.count(), 1);
        }
        for rank in 0..5 {
            assert_eq!(Block::shared(77, rank, 5, 5), Block::even(77, rank, 5));
        }
    }
}
