//! Fragments as they are typed.

use serde::Deserialize;
use toml::Spanned;

use crate::input::quantity::{Placed, Time};
use crate::model::Include;

optional_tables! {
    /// `[fragments]`
    FragmentsParams {
        /// Time between two censuses.
        every: Option<Placed<Time>>,
        /// Largest distance of linked particles, over the mean of their sizes.
        link: Option<Spanned<f64>>,
        /// What belongs to fragments.
        include: Option<Include>,
        /// Whether a single particle joins two fragments.
        bridges: Option<bool>,
        /// Whether particles of different bodies are linked.
        across_bodies: Option<bool>,
        /// Least number of particles of a fragment.
        min_particles: Option<Spanned<i64>>,
    }
}
