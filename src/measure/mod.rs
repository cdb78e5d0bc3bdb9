//! What a run measures of itself: figures that answer questions, in place of particles.
//!
//! A file measures one kind of thing. All of them give the same bits on any ranks and threads:
//! sums are exact ([`crate::numerics::exact_sum`]), extremes compare bits, and whoever is nearest
//! is told by distance and then by id. Of a model with symmetry planes they report the whole, see
//! [`Whole`].

mod bodies;
mod gauge_reader;
mod gauge_shares;
mod gauges;
mod kept;
mod reading;
mod whole;
mod witness;

pub use bodies::{BodyFigures, bodies};
pub use gauges::{GaugeRow, Gauges};
pub use kept::Measures;
pub use reading::Reading;
pub use whole::Whole;
pub use witness::{Crossing, Witnesses, whole_passed};
