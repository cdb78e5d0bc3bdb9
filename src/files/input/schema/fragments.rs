//! Fragments as they are typed.

use serde::Deserialize;
use toml::Spanned;

use crate::input::quantity::{Placed, Time};
use model::{FragmentOptions, Include};

/// Links beyond it reach through gaps wider than the support of most kernels.
const LONGEST: f64 = 4.0;

optional_tables! {
    /// `[fragments]`
    FragmentsParams {
        /// Time between two censuses.
        every: Option<Placed<Time>>, Positive => "at usual snapshots";
        /// Largest distance of linked particles, over the mean of their sizes.
        link: Option<Spanned<f64>> = FragmentOptions::default().link, Within(1.0, LONGEST);
        /// What belongs to fragments.
        include: Option<Include> = FragmentOptions::default().include;
        /// True if a single particle joins two fragments.
        bridges: Option<bool> = FragmentOptions::default().bridges;
        /// True if particles of different bodies are linked.
        across_bodies: Option<bool> = FragmentOptions::default().across_bodies;
        /// Least number of particles of a fragment.
        min_particles: Option<Spanned<i64>> = FragmentOptions::default().min_particles, AtLeast(1);
    }
}
