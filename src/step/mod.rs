//! The loop, the integrator and the time-step votes.

mod error;
mod fields;
mod flight;
mod integrate;
mod removal;
mod restored;
mod setup;
mod simulation;
mod timers;
mod vote;

pub use crate::diagnose::{
    LoadState, NearestPair, PairState, PastVote, PostMortem, Reason, Removed, RunState, Totals,
    TroubleKind, Worst,
};
pub use error::{SetupError, StepError};
pub use fields::bytes_of_options;
pub use simulation::Simulation;
pub use timers::{Phase, Timers};
pub use vote::Votes;
