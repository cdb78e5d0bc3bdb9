//! What charts and pictures take from snapshots.

pub mod bodies;
pub mod extent;
pub mod field;
pub mod front;
pub mod images;
pub mod matter;
pub mod plane;
pub mod sample;
pub mod slice;
pub mod snapshot;
pub mod source;
