//! A run in its folder, on all ranks: how it starts or goes on, the loop between its files, why it stops,
//! and what it says.

pub mod driver;
pub mod exit;
#[cfg(feature = "fault-injection")]
mod fault;
pub mod launch;
mod options;
mod progress;
pub mod resume;
pub mod saved_case;
pub mod say;
pub mod start;
mod stop;
mod summary;
mod tables;

pub use options::CommonArgs;
