//! The pair sums of smoothed particle hydrodynamics: slices, lists and a case's numbers in, slices out. They know neither
//! bodies nor ranks.
//!
//! A *cluster* of eight receivers meets its neighbours one by one in one canonical order; the
//! eight receivers stand in the lanes of a vector, so no sum ever crosses lanes and a lane
//! outside the support adds an exact zero. Lists of the total form, which last, have neighbours of each lane's own.

pub mod corrected;
pub mod face;
pub mod force_sweep;
pub mod from_mirrors;
pub mod gradient;
pub mod hourglass;
pub mod limiter;
pub mod linear_fit;
pub mod mid_step;
pub mod momentum;
pub mod neighbour_mean;
pub mod neighbourhood;
pub mod normalised;
pub mod principal;
pub mod pull_sweep;
pub mod scale;
pub mod step;
pub mod stress_points;
pub mod terms;
pub mod total;
