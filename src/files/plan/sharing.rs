//! How ranks share a machine.

/// How ranks share a machine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Sharing {
    /// Threads of each rank.
    pub threads: usize,
    /// Ranks of each node.
    pub ranks_per_node: usize,
}
