//! Neighbour search: images sorted into thin columns, lists for clusters of eight receivers
//! (own group) and for single receivers (foreign bodies), and a brute-force oracle.

mod clusters;
mod columns;
mod foreign;
pub mod oracle;
mod sequence;

pub use clusters::{Among, CLUSTERS_PER_CHUNK, Chunk, Cluster, ClusterLists};
pub use columns::ColumnGrid;
pub use foreign::{ContactClass, ForeignChunk, ForeignLists, ForeignTable, PairList};
pub use sequence::{Image, ImageFacts, Sequence};
