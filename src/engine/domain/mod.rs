//! Which rank owns what: slabs of slabs, migration, halo exchange, balance, mirror images.

mod balance;
mod choice;
mod chosen;
mod forecast;
mod halo;
mod halo_count;
mod histogram;
mod least;
mod migrate;
mod near;
mod needs;
mod nested;
mod outset;
mod partition;
mod rank_speed;
mod shown;
mod span;
mod tally;

pub use balance::{Balance, MOST_UNEVEN};
pub use choice::Choice;
pub use forecast::{Forecast, Fullest, reach};
pub use halo::{Halo, Reaches};
pub use histogram::{Cumulative, Histogram};
pub use migrate::Migration;
pub use nested::{Decomposition, NestedSlabs};
pub use outset::Outset;
pub use partition::Partition;
pub use rank_speed::RankSpeeds;
pub use shown::Shown;
pub(crate) use span::Span;
pub use tally::{GREETING, Sent, Tally, greetings, tally};
