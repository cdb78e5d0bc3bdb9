//! The loop, the integrator and the time-step votes.

mod contact_phase;
mod contact_sums;
mod flight;
mod freeze;
mod gain;
mod integrate;
mod loads;
mod material_update;
mod normalised;
mod options;
mod parts;
mod post_mortem;
mod restored;
mod search;
mod setup;
mod simulation;
mod span;
mod state;
mod stress_fit;
mod stress_moments;
mod stress_points;
mod sums;
mod surface_forces;
mod surface_friction;
mod surface_motion;
mod sweeps;
mod timers;
mod trouble;
mod vote;

pub use options::bytes_of_options;
pub use post_mortem::PostMortem;
pub use setup::SetupError;
pub use simulation::{Simulation, StepError};
pub use state::{
    Closest, LoadState, NearestPair, PairExtremes, PairState, Reason, RunState, Totals, Worst,
};
pub use timers::{Phase, Timers};
pub use trouble::{PastVote, Removed, TroubleKind};
