//! The loop, the integrator and the time-step votes.

mod contact_phase;
mod integrate;
mod loads;
mod material_update;
mod normalised;
mod options;
mod search;
mod setup;
mod simulation;
mod state;
mod sums;
mod surface_forces;
mod sweeps;
mod timers;
mod vote;

pub use setup::SetupError;
pub use simulation::{Simulation, StepError};
pub use state::{LoadState, PairState, Reason, RunState, Totals, Worst};
pub use timers::{Phase, Timers};
