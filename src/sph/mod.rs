//! The pair sums of smoothed particle hydrodynamics: slices in, slices out.
//!
//! A *cluster* of eight receivers meets its neighbours one by one in one canonical order; the
//! eight receivers stand in the lanes of a vector, so no sum ever crosses lanes and a lane
//! outside the support adds an exact zero.

pub mod gradient;
pub mod kernel;
pub mod linear_fit;
pub mod mid_step;
pub mod momentum;
pub mod neighbourhood;
pub mod normalised;
pub mod options;
pub mod principal;
pub mod stress_points;
