//! Which rank owns what: slabs, migration, halo exchange, balance, mirror images.

mod balance;
mod halo;
mod migrate;
mod mirrors;
mod pace;
mod slabs;

pub use balance::{Histogram, balance};
pub use halo::Halo;
pub use migrate::Migration;
pub use mirrors::Mirrors;
pub use pace::Paces;
pub use slabs::{Decomposition, Slabs};
