//! Which rank owns what: slabs, migration, halo exchange, balance, mirror images.

mod balance;
mod halo;
mod migrate;
mod mirrors;
mod needs;
mod outset;
mod partition;
mod rank_speed;
mod slabs;
mod span;

pub use balance::{Cumulative, Histogram, balance};
pub use halo::Halo;
pub use migrate::Migration;
pub use mirrors::{MirrorForce, Mirrors};
pub use outset::Outset;
pub use partition::Partition;
pub use rank_speed::RankSpeeds;
pub use slabs::{Decomposition, Slabs};
pub(crate) use span::Span;
