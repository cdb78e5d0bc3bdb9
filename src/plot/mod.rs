//! Room plot: pictures from result files.
//!
//! A [`Pictures`] takes a section of some snapshots and draws them one by one or as panels of one
//! picture; [`History`] draws energies against time. Everything is drawn by the program itself
//! with a font of its own: no Python, no system fonts. Sizes of a picture are in proportion to its
//! width, so that a wider picture is the same picture, finer.

#![expect(
    clippy::cast_precision_loss,
    reason = "positions in a picture need no more digits than a float has"
)]

mod axes;
mod bar;
mod canvas;
mod colour;
mod error;
mod field;
mod figure;
mod font;
mod history;
mod layout;
mod pictures;
mod section;
mod snapshot;
mod source;
mod ticks;
mod units;

pub use canvas::Canvas;
pub use error::PlotError;
pub use history::History;
pub use pictures::{Pictures, Request, title};
pub use source::{Wanted, choose, snapshots};
pub use units::parse as parse_quantity;
