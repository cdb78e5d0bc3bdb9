//! Neighbour search: images sorted into thin columns, lists for clusters of eight receivers
//! (own group) and for single receivers (foreign bodies), and a brute-force oracle.

mod clusters;
mod columns;
mod foreign;
mod gather;
mod groups;
mod lists;
mod motion;
pub mod oracle;
mod parts;
mod sequence;
mod sort;

pub use clusters::{Among, CHUNKS_AT_ONCE, Chunk, Cluster, ClusterLists, Lengths};
pub use columns::ColumnGrid;
pub use foreign::{ContactClass, ForeignChunk, ForeignLists, ForeignTable, PairList};
pub use groups::Groups;
pub use lists::Lists;
pub use motion::MotionRecord;
pub use parts::{Kin, Part};
pub use sequence::{ImageFacts, Sequence};
