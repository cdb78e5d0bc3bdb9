//! The loop, the integrator and the time-step candidates.

mod accounts;
mod activity;
mod candidate;
pub mod contact_stress;
mod error;
pub mod failure;
mod fields;
mod file_values;
mod flight;
pub mod fragments;
mod integrate;
mod kept_links;
pub mod measurements;
mod moving_cells;
mod removal;
mod restored;
mod search;
mod setup;
mod simulation;
mod space;
mod timers;

pub use crate::diagnose::failed_mass;
pub use crate::diagnose::{
    LoadState, NearestPair, NumericalFailure, PairState, Passed, PastStep, PostMortem, Reason,
    Removed, RunState, Tear, Totals, Worst,
};
pub use crate::loads::RigidState;
pub use candidate::StepControl;
pub use contact_stress::Carried;
pub use error::{SetupError, StepError};
pub use fields::{bytes_of_messages, bytes_of_options, store_of};
pub use search::Search;
pub use simulation::Simulation;
pub use timers::{Phase, Timers};
