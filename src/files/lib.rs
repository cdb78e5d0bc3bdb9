//! Files: inputs and what is wrong with them, plans, runs in their folders, results and checkpoints.

pub mod input;
mod opener;
pub mod output;
pub mod plan;
pub mod preflight;
pub mod run;

pub use opener::FileOpener;
