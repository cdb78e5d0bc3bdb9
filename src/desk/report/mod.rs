//! Reports: one HTML page on a run, or on two side by side, for people who were not there.
//!
//! A page opens from disk and asks the network for nothing: pictures, particles, style and script
//! are in it, and a policy in its head forbids all else. Texts from files are never markup
//! (`html.rs`). Missing data are named in their place, so that old and damaged runs have pages
//! too. The same run gives the same bytes.

#![expect(
    clippy::cast_precision_loss,
    reason = "counts and places in pictures need no more digits than a float has"
)]

mod compared;
mod html;
mod page;
mod picture;
mod run_files;
mod sections;
mod swept;
mod viewer;

pub use compared::compare;
pub use page::{PageOptions, render};
pub use swept::swept;
