//! The pair sums of smoothed particle hydrodynamics: sums over slices at the bottom, formulations
//! that run them over the particles of a rank above.
//!
//! A *cluster* of eight receivers meets its neighbours one by one in one canonical order; the
//! eight receivers stand in the lanes of a vector, so no sum ever crosses lanes and a lane
//! outside the support adds an exact zero.

pub mod corrected;
mod force_sweep;
mod formulation;
mod from_mirrors;
pub mod gradient;
pub mod hourglass;
pub mod linear_fit;
mod material_update;
pub mod mid_step;
pub mod momentum;
pub mod neighbourhood;
pub mod normalised;
mod phase;
pub mod principal;
mod pull_sweep;
mod recording;
mod rest;
mod scale;
mod signal;
mod smoothing;
mod step;
pub mod stress_points;
mod sums;
mod term_records;
pub mod terms;
mod virial;

pub use formulation::{Conventional, Corrected, Normalised, StressPoints};
pub use phase::Sph;
pub(crate) use phase::with_formulation;
pub use rest::Resting;
pub use signal::{SignalSpeed, Signals};
pub use smoothing::Smoothing;
pub use step::{Side, Step};
pub use virial::{StressForces, stress};
