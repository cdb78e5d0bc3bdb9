//! Room report: one HTML page that tells a run, or two side by side, to people who were not there.
//!
//! A page opens from disk and asks the network for nothing: pictures, particles, style and script are in
//! it, and a policy in its head forbids all else. What comes from files is text and never markup
//! ([`html::Html`]). What a run does not have is named in its place, so that old and damaged runs have
//! pages too. The same run gives the same bytes.

#![expect(
    clippy::cast_precision_loss,
    reason = "counts and places in pictures need no more digits than a float has"
)]

mod compared;
mod found;
mod html;
mod page;
mod picture;
mod sections;
mod viewer;

pub use compared::compare;
pub use page::{Asked, tell};
