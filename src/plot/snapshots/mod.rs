//! Snapshots, as charts and pictures take them.

pub mod bodies;
pub mod bulk;
pub mod extent;
pub mod field;
pub mod front;
pub mod grains;
pub mod images;
pub mod plane;
pub mod sample;
pub mod shape;
pub mod slice;
pub mod snapshot;
pub mod source;
