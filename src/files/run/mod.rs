//! A run in its folder, on all ranks: how it starts or goes on, the loop between its files, why it
//! stops, and what it says.

mod announce;
mod census;
mod columns;
mod departures;
mod driver;
pub mod exit;
#[cfg(debug_assertions)]
mod fault;
pub mod launch;
mod load;
mod notices;
mod options;
mod output_time;
mod progress;
pub mod resume;
pub mod saved_case;
pub mod say;
pub mod start;
mod stop;
mod summary;
mod tables;
pub mod voice;
mod watched;

pub use options::CommonArgs;
