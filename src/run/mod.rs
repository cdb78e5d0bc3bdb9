//! A run in its folder, on all ranks: how it starts or goes on, the loop between its files, why it
//! stops, and what it says.

mod announce;
mod census;
mod columns;
mod departures;
mod driver;
pub(crate) mod exit;
#[cfg(feature = "fault-injection")]
mod fault;
pub(crate) mod launch;
mod load;
mod notices;
mod options;
mod output_time;
mod progress;
pub(crate) mod resume;
pub(crate) mod saved_case;
pub(crate) mod say;
pub(crate) mod start;
mod stop;
mod summary;
mod tables;
pub(crate) mod voice;
mod watched;

pub(crate) use options::CommonArgs;
