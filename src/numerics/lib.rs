//! The numerical base: what knows nothing of particles, and gives the same bits on any machine.

pub mod alone;
pub mod arc;
pub mod attitude;
pub mod collector;
pub mod counter;
pub mod dispatch;
pub mod elementary;
pub mod ellipsoid;
pub mod exact_sum;
pub mod extent;
pub mod gathered_sums;
pub mod kernel;
pub mod lane_matrix;
pub mod lanes;
pub mod matrix;
pub mod meetings;
pub mod ordered;
pub mod principal;
pub mod tree;
pub mod vector;
pub mod virial;
