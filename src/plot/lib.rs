//! Room plot: pictures from result files.
//!
//! A [`Pictures`] takes a section of some snapshots and draws them one by one or as panels of one
//! picture; [`Profiles`] draws values along a line, with the exact answer where there is one;
//! [`Scenes`] show whole models from a side and [`Radiographs`] the mass along each line of sight;
//! [`movie`] puts one picture after the other.
//! [`Tables`] and [`History`] draw columns of tables. These are [`Chart`]s. Every picture is made as
//! SVG, and its pixels from that with a font of the program's own: no Python, no system fonts. Sizes
//! of a picture are in proportion to its width, so that a wider picture is the same picture, finer.

#![expect(
    clippy::cast_precision_loss,
    reason = "positions in a picture need no more digits than a float has"
)]

mod arrow;
mod axes;
mod canvas;
mod chart;
mod colour;
mod discs;
mod dots;
mod error;
mod file;
mod font;
mod format;
mod frame;
mod header;
mod length_bar;
pub mod movie;
mod picture;
mod pixels;
mod preview;
mod radiograph;
mod scene;
mod sequence;
mod snapshots;
mod stretch;
mod style;
mod svg;
mod ticks;
mod units;

pub use canvas::{Canvas, Rgb};
pub use chart::curves::{Chart, Curve, Quantity};
pub use chart::distributions::distributions;
pub use chart::fragments::{By, cumulative, tables_of_run};
pub use chart::history::History;
pub use chart::profile::{Along, ProfileRequest, Profiles};
pub use chart::series::parse_pair;
pub use chart::tables::{Columns, Points, Tables, widest};
pub use chart::tornado::{Bar, Group, Tornado};
pub use colour::Scale;
pub use colour::body as colour_of;
pub use error::PlotError;
pub use file::save;
pub use format::Format;
pub use header::Mark;
pub use picture::pictures::{Pictures, Request};
pub use pixels::Pixels;
pub use preview::page::preview;
pub use radiograph::radiographs::{RadiographRequest, Radiographs};
pub use scene::camera::Camera;
pub use scene::scenes::{SceneRequest, Scenes};
pub use sequence::{NO_TABLE, Sequence};
pub use snapshots::bodies::Bodies;
pub use snapshots::field::{Drawn, SYMMETRIC, TENSOR, VECTOR};
pub use snapshots::front::{Direction, front, largest_reaches};
pub use snapshots::grains::Selection;
pub use snapshots::shape::{Fill, Shape};
pub use snapshots::snapshot::Snapshot;
pub use snapshots::snapshot::{bodies, title};
pub use snapshots::source::{Source, Wanted, choose, snapshots};
pub use svg::hex;
pub use units::decimals;
pub use units::parse as parse_quantity;
