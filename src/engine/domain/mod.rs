//! Ownership by ranks: slabs of slabs, migration, halo exchange, balance, mirror images.

mod balance;
mod choice;
mod chosen;
mod forecast;
mod halo;
mod halo_count;
mod histogram;
mod initial_layout;
mod least;
mod migrate;
mod near;
mod needs;
mod nested;
mod partition;
mod payload;
mod rank_speed;
mod span;
mod tally;

pub use balance::{Balance, MOST_UNEVEN};
pub use choice::Choice;
pub use forecast::{Forecast, Fullest, reach};
pub use halo::{Halo, Reaches};
pub use histogram::{Cumulative, Histogram};
pub use initial_layout::InitialLayout;
pub use migrate::Migration;
pub use nested::{Decomposition, NestedSlabs};
pub use partition::Partition;
pub use payload::Payload;
pub use rank_speed::RankSpeeds;
pub(crate) use span::Span;
pub use tally::{EXTENT_MESSAGE, Sent, Tally, extent_exchange, tally};
