//! Fragments as they are typed.

use serde::Deserialize;
use toml::Spanned;

use crate::input::quantity::{Placed, Time};
use model::Include;

optional_tables! {
    /// `[fragments]`
    FragmentsParams {
        /// Time between two censuses; at usual snapshots if absent.
        every: Option<Placed<Time>>,
        /// Largest distance of linked particles, over the mean of their sizes; `1.5` if absent.
        link: Option<Spanned<f64>>,
        /// What belongs to fragments; `"intact"` if absent.
        include: Option<Include>,
        /// Whether a single particle joins two fragments; `false` if absent.
        bridges: Option<bool>,
        /// Whether particles of different bodies are linked; `true` if absent.
        across_bodies: Option<bool>,
        /// Least number of particles of a fragment; `8` if absent.
        min_particles: Option<Spanned<i64>>,
    }
}
