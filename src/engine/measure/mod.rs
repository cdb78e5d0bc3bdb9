//! Measures of a run: figures that answer questions, in place of particles.
//!
//! A file measures one kind of thing. All of them give the same bits on any ranks and threads:
//! sums are exact ([`numerics::exact_sum`]), extremes compare bits, and the nearest particle
//! is chosen by distance and then by id. Of a model with symmetry planes they report the whole, see
//! [`Whole`].

mod attached;
mod bar;
mod bodies;
mod debris;
mod figure;
mod flight;
mod footprint;
mod frame;
mod front;
mod gauge_reader;
mod gauge_shares;
mod gauges;
mod kept;
mod ledgers;
mod mask;
mod matter;
mod near;
mod outline;
mod plate;
mod reading;
mod remains;
mod revolved;
mod surroundings;
mod target;
mod voxels;
mod whole;
mod window;
mod witness;
mod zone;

pub use bodies::{BodyFigures, KeptBodies, bodies};
pub use figure::{Distribution, Figure, Findings, Told};
pub use gauges::{GaugeRow, Gauges};
pub use kept::{Measures, findings, mark_zones, remember};
pub use ledgers::whole_state;
pub use matter::{HeldMatter, Matter};
pub use reading::Reading;
pub use whole::Whole;
pub use witness::{Crossing, Witnesses};
