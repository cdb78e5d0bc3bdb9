//! The pair sums of smoothed particle hydrodynamics: sums over slices at the bottom, formulations
//! that run them over the particles of a rank above.
//!
//! A *cluster* of eight receivers meets its neighbours one by one in one canonical order; the
//! eight receivers stand in the lanes of a vector, so no sum ever crosses lanes and a lane
//! outside the support adds an exact zero.

mod faces;
mod formulation;
mod hourglass_update;
mod material_update;
mod neighbour_strain;
mod phase;
mod recording;
mod rest;
mod shared;
mod signal;
mod smoothing;
mod term_records;
mod virial;

pub use formulation::{Conventional, Corrected, Normalised, StressPoints};
pub(crate) use material_update::thinned;
pub use phase::Sph;
pub(crate) use phase::with_formulation;
pub use rest::Resting;
pub use signal::{SignalSpeed, Signals};
pub use smoothing::Smoothing;
pub use sums::step::{Side, Step};
pub use virial::{StressForces, stress};
