//! The loop, the integrator and the time-step candidates.

mod busy;
mod candidate;
mod dormant;
mod error;
mod fields;
mod flight;
mod fragments;
mod given;
mod integrate;
mod kept_links;
mod measures;
mod removal;
mod restored;
mod search;
mod setup;
mod shown;
mod simulation;
mod taking_out;
mod timers;
mod told;

pub use crate::diagnose::failed_mass;
pub use crate::diagnose::{
    LoadState, NearestPair, NumericalFailure, PairState, Passed, PastStep, PostMortem, Reason,
    Removed, RunState, Totals, Worst,
};
pub use candidate::StepControl;
pub use error::{SetupError, StepError};
pub use fields::{bytes_of_messages, bytes_of_options, store_of};
pub use shown::Carried;
pub use simulation::Simulation;
pub use timers::{Phase, Timers};
