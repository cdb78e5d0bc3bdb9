//! Partitions of a snapshot's rows, which parallel readers of VTKHDF share: a fixed number of rows each,
//! whatever the ranks.

use super::Block;

/// Rows of a partition.
pub const PARTITION_ROWS: u64 = 1 << 22;

/// Most partitions of a file that is read: as many as 4 · 10¹² particles have.
const MOST: u64 = 1 << 20;

/// Rows cut into partitions. A file without rows has one, of none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Partitions {
    total: u64,
    /// Rows of each but the last.
    rows: u64,
}

impl Partitions {
    /// Cuts `total` rows into partitions of `rows` each, at least one.
    #[must_use]
    pub fn new(total: u64, rows: u64) -> Self {
        Self {
            total,
            rows: rows.max(1),
        }
    }

    /// Number of partitions.
    #[must_use]
    pub fn count(self) -> u64 {
        self.total.div_ceil(self.rows).max(1)
    }

    /// Rows of each.
    pub fn sizes(self) -> impl Iterator<Item = u64> {
        (0..self.count()).map(move |k| self.rows.min(self.total - k * self.rows))
    }

    /// The number of a row in its partition.
    #[must_use]
    pub fn local_row(self, row: u64) -> u64 {
        row % self.rows
    }

    /// The offsets of a block's cells: one for each row, and one behind the last row of each
    /// partition, which the rank with that row writes. The rank with the end of all rows `closes` the
    /// last one.
    ///
    /// # Panics
    /// If the block is longer than an address.
    #[must_use]
    pub fn offsets(self, block: Block, closes: bool) -> Block {
        let total = self.total + self.count();
        let at = |row: u64| row + row / self.rows;
        let first = at(block.first);
        let end = if closes {
            total
        } else {
            at(block.first + block.count as u64)
        };
        Block {
            total,
            first,
            count: usize::try_from(end - first).expect("a block fits memory"),
        }
    }

    /// The value of an entry of all offsets: they begin at zero in each partition.
    #[must_use]
    pub fn offset(self, entry: u64) -> u64 {
        entry % (self.rows + 1)
    }
}

/// Checks the partitions that an untrusted file declares.
///
/// # Errors
/// A text if they cannot be those of `rows` rows.
pub fn check(sizes: &[i64], rows: u64) -> Result<(), String> {
    check_count(sizes.len() as u64)?;
    let mut sum = 0_u64;
    for &size in sizes {
        let size = u64::try_from(size).map_err(|_| format!("a partition of {size} rows"))?;
        let more = sum.checked_add(size).filter(|&sum| sum <= rows);
        sum = more.ok_or_else(|| format!("its partitions have more than the {rows} rows"))?;
    }
    if sum == rows {
        Ok(())
    } else {
        Err(format!("its partitions have {sum} of the {rows} rows"))
    }
}

/// Checks the number of partitions that a file declares, before memory is taken for them.
///
/// # Errors
/// A text if there are none or more than any snapshot has.
pub fn check_count(partitions: u64) -> Result<(), String> {
    if (1..=MOST).contains(&partitions) {
        Ok(())
    } else {
        Err(format!("{partitions} partitions, not 1 to {MOST}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All offsets, as ranks write them one after the other.
    fn offsets(total: u64, rows: u64, ranks: usize) -> Vec<u64> {
        let partitions = Partitions::new(total, rows);
        let mut all = Vec::new();
        for rank in 0..ranks {
            let block = Block::even(total, rank, ranks);
            let mine = partitions.offsets(block, block.closes(rank == 0));
            assert_eq!(mine.total, total + partitions.count());
            if mine.count > 0 {
                assert_eq!(mine.first, all.len() as u64);
            }
            all.extend(
                (mine.first..)
                    .take(mine.count)
                    .map(|e| partitions.offset(e)),
            );
        }
        all
    }

    #[test]
    fn each_partition_has_its_own_offsets_whatever_the_ranks() {
        assert_eq!(offsets(0, 4, 3), [0]);
        assert_eq!(offsets(3, 4, 2), [0, 1, 2, 3]);
        assert_eq!(offsets(4, 4, 2), [0, 1, 2, 3, 4]);
        assert_eq!(offsets(5, 2, 1), [0, 1, 2, 0, 1, 2, 0, 1]);
        for total in 0..20 {
            for rows in [1, 2, 3, 5, 19, 20, 21] {
                let partitions = Partitions::new(total, rows);
                let sizes: Vec<u64> = partitions.sizes().collect();
                assert_eq!(sizes.len() as u64, partitions.count());
                assert_eq!(sizes.iter().sum::<u64>(), total);
                let expected: Vec<u64> = sizes.iter().flat_map(|&n| 0..=n).collect();
                for ranks in [1, 2, 3, 7, 30] {
                    assert_eq!(
                        offsets(total, rows, ranks),
                        expected,
                        "{total} {rows} {ranks}"
                    );
                }
            }
        }
    }

    /// Numbers of virtual particles, more than fit memory.
    #[test]
    fn more_than_four_thousand_million_rows_have_their_places() {
        for (total, ranks) in [(1 << 32, 7), (5_000_000_001, 10_000), (1 << 40, 100_000)] {
            let partitions = Partitions::new(total, PARTITION_ROWS);
            assert_eq!(partitions.sizes().sum::<u64>(), total);
            assert!(
                partitions
                    .sizes()
                    .all(|n| (1..=PARTITION_ROWS).contains(&n))
            );
            let sizes: Vec<i64> = partitions
                .sizes()
                .map(|n| i64::try_from(n).unwrap())
                .collect();
            assert!(check(&sizes, total).is_ok());
            let (mut row, mut entry) = (0, 0);
            for rank in 0..ranks {
                let block = Block::even(total, rank, ranks);
                let offsets = partitions.offsets(block, block.closes(rank == 0));
                assert_eq!((block.first, offsets.first), (row, entry));
                // The first offset is that of the first row.
                assert_eq!(partitions.offset(entry), partitions.local_row(row));
                row += block.count as u64;
                entry += offsets.count as u64;
            }
            assert_eq!(row, total);
            assert_eq!(entry, total + partitions.count());
            let last = partitions.sizes().last().unwrap();
            assert_eq!(partitions.offset(entry - 1), last);
        }
        assert_eq!(Partitions::new(1 << 32, PARTITION_ROWS).count(), 1024);
        assert_eq!(Partitions::new((1 << 32) + 1, PARTITION_ROWS).count(), 1025);
    }

    #[test]
    fn partitions_that_cannot_be_are_refused() {
        assert!(check(&[0], 0).is_ok());
        assert!(check(&[2, 2, 1], 5).is_ok());
        for (sizes, expected) in [
            (&[][..], "0 partitions"),
            (&[3], "have 3 of the 5 rows"),
            (&[6], "more than the 5 rows"),
            (&[6, -1], "more than the 5 rows"),
            (&[-1, 6], "a partition of -1 rows"),
            (&[i64::MAX, i64::MAX, i64::MAX], "more than the 5 rows"),
        ] {
            let error = check(sizes, 5).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
        assert!(check_count(u64::MAX).is_err());
    }
}
