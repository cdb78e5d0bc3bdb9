//! Conserved sums and measures of what an impact leaves behind.

pub mod hole;
pub mod pieces;
