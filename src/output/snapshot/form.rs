//! What a snapshot holds and how.

use crate::output::partitions::PARTITION_ROWS;
use crate::output::quantity::Quantity;

/// What a snapshot holds and how.
#[derive(Debug, Clone, Copy)]
pub struct Form<'a> {
    /// What it tells of each particle.
    pub quantities: &'a [Quantity],
    /// Rows of a partition.
    pub partition_rows: u64,
}

impl<'a> Form<'a> {
    /// Some quantities of all particles.
    #[must_use]
    pub fn of(quantities: &'a [Quantity]) -> Self {
        Self {
            quantities,
            partition_rows: PARTITION_ROWS,
        }
    }
}
