//! A run in its folder, on all ranks: its start or restart, the loop with its output, reasons to stop, and
//! messages to the user.

mod announce;
mod census;
pub(crate) mod columns;
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
pub mod verbosity;
mod watched;

pub use options::CommonArgs;
pub use stop::parse_until;
