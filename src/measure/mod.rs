//! What a run measures of itself: figures that answer questions, in place of particles.
//!
//! A file measures one kind of thing. All of them give the same bits on any ranks and threads:
//! sums are exact ([`crate::numerics::exact_sum`]), extremes compare bits, and whoever is nearest
//! is told by distance and then by id. Of a model with symmetry planes they report the whole, see
//! [`Whole`].

mod bodies;
mod whole;

pub use bodies::{BodyFigures, bodies};
pub use whole::Whole;
