//! What charts and pictures take from snapshots.

pub mod extent;
pub mod field;
pub mod front;
pub mod plane;
pub mod slice;
pub mod snapshot;
pub mod source;
