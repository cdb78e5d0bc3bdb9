//! Ballistic limit equations of spacecraft shields, and fits of craters and holes.
//!
//! Pure formulas, one file for each, in SI units; inside, each computes in the units that its
//! constants were fitted in ([`handbook`]). They know nothing of the engine: designers' curves to lay
//! beside its answers. `docs/src/theory/ballistic-limits.md` has them with their sources.

#![expect(clippy::doc_markdown, reason = "symbols of formulas stand as on paper")]

pub mod crater;
pub mod handbook;
pub mod hole;
pub mod modified_nno;
pub mod nno;
pub mod regime;
mod shield;
pub mod sizing;
pub mod stuffed;
pub mod thin_bumper;

pub use regime::{Limit, Regime};
pub use shield::{Shield, Shot};
