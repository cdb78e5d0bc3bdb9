//! Files: inputs and what is wrong with them, plans, runs in their folders, results and checkpoints.

pub mod input;
pub mod output;
pub mod plan;
pub mod preflight;
pub mod run;
