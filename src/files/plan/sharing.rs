//! Sharing of a machine by ranks.

/// Sharing of a machine by ranks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Sharing {
    /// Threads of each rank.
    pub threads: usize,
    /// Ranks of each node.
    pub ranks_per_node: usize,
}
