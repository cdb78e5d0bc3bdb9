//! Contact between bodies: a table of body pairs, and one file for each mode.
//!
//! Contact sees reference volumes `V = m/ρ₀`, reference smoothing lengths and reference moduli
//! only, so that its energy is a function of positions alone and its forces are that function's
//! exact gradient (physics page, section 5). Gases alone are as stiff as their pressure, see `gas`.
//!
//! A mode is an `impl` of `Constants` and of `Mode` for its parameters; nothing else knows it by
//! name.

mod accumulators;
mod connectivity;
mod force;
pub mod friction;
mod gas;
mod joint;
mod mode;
pub mod overlap;
mod pair;
mod penalty;
mod phase;
mod potential;
mod resistance;
mod sums;
mod surfaces;
mod table;
mod task;
mod view;
mod virial;

pub use connectivity::Connectivity;
pub(crate) use connectivity::EVERY;
pub use force::{BodyForce, ContactForce, TaskForces};
pub use pair::Pair;
pub use phase::Contact;
pub use sums::{Closest, PairExtremes};
pub(crate) use sums::{ContactSums, PairBook, PairSums, least, pair_key, pair_of};
pub(crate) use surfaces::SurfaceForces;
pub use table::ContactTable;
pub use view::ContactView;
