//! Fragments: what hangs together, over all ranks, with the same bits on any of them.
//!
//! [`Labels`] is the one mechanism of connected components: threads join particles by union–find
//! ([`Sets`]), ranks merge the few labels that cross their faces ([`Merger`]). Self-contact gives it
//! the links of its lists; [`find`] gives it those of matter that is near, and sums over what hangs
//! together: a [`Census`]. Runs and `whipple fragments` call the same.

mod bridges;
mod census;
mod fragment;
mod labels;
mod links;
mod matter;
mod merger;
mod sums;

pub use census::{Census, Share, find, find_alone};
pub use fragment::Fragment;
pub use labels::{Labels, Member, Members};
pub use links::BYTES_OF_SEARCH;
pub use matter::{FirstSizes, Matter, Rule, Surroundings, belongs, images, link_reach};
pub use merger::{Merger, Row};
pub use particles::connected::{Set, Sets};
