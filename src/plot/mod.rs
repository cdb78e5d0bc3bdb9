//! Room plot: pictures from result files.
//!
//! A [`Pictures`] takes a section of some snapshots and draws them one by one or as panels of one
//! picture; [`Profiles`] draws values along a line, with the exact answer where there is one;
//! [`Tables`] and [`energies`] draw columns of tables. These are [`Chart`]s. Everything is drawn by the program itself
//! with a font of its own: no Python, no system fonts. Sizes of a picture are in proportion to its
//! width, so that a wider picture is the same picture, finer.

#![expect(
    clippy::cast_precision_loss,
    reason = "positions in a picture need no more digits than a float has"
)]

mod axes;
mod bar;
mod canvas;
mod cells;
mod chart;
mod colour;
mod error;
mod exact;
mod field;
mod figure;
mod font;
mod front;
mod history;
mod layout;
mod pictures;
mod plane;
mod profile;
mod raster;
mod section;
mod series;
mod snapshot;
mod source;
mod table;
mod tables;
mod ticks;
mod units;

pub use axes::Mark;
pub use canvas::{Canvas, Rgb};
pub use chart::{Chart, Curve, Quantity};
pub use error::PlotError;
pub use front::{Direction, front};
pub use history::energies;
pub use pictures::{Pictures, Request, title};
pub use profile::{Along, ProfileRequest, Profiles};
pub use series::parse_pair;
pub use source::{Source, Wanted, choose, snapshots};
pub use tables::{Columns, Points, Tables};
pub use units::parse as parse_quantity;
