//! Neighbour search: images sorted into thin columns, lists for clusters of eight receivers
//! (own group) and for single receivers (foreign bodies).

mod close;
mod cluster;
mod clusters;
mod columns;
mod cursors;
mod facts;
mod foreign;
mod fragments;
mod gather;
mod group;
mod groups;
mod lists;
mod longest;
mod motion;
mod near;
mod pairs;
mod point;
mod sequence;
mod size_classes;
mod sort;
mod watch;

pub use cluster::{Among, Cluster};
pub use clusters::{CHUNKS_AT_ONCE, Chunk, ClusterLists, Lengths};
pub use columns::ColumnGrid;
pub use facts::{ImageFacts, ImageState};
pub use foreign::{ForeignChunk, ForeignLists, ForeignTable, GroupRanges};
pub use fragments::{Fragment, Membership};
pub use groups::Groups;
pub use lists::Lists;
pub use motion::MotionRecord;
pub use pairs::PairList;
pub use point::PointSearch;
pub use sequence::Sequence;
pub use size_classes::SizeClasses;
