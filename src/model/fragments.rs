//! When fragments are told in a run, and what a fragment is.

use serde::Deserialize;

/// What belongs to fragments.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Include {
    /// What has not failed.
    #[default]
    Intact,
    /// All matter.
    All,
}

/// The table `[fragments]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FragmentOptions {
    /// Time between two censuses (s); at each snapshot if absent. There is one at the end, too.
    pub every: Option<f64>,
    /// Largest distance of linked particles, over the mean of their sizes at the start.
    pub link: f64,
    /// What belongs to fragments.
    pub include: Include,
    /// Whether a single particle joins what hangs together by nothing else.
    pub bridges: bool,
    /// Whether particles of different bodies are linked.
    pub across_bodies: bool,
    /// Least number of particles of a fragment; the rest is dust.
    pub min_particles: u64,
}

impl Default for FragmentOptions {
    /// See the theory page "Fragments" for the reasons.
    fn default() -> Self {
        Self {
            every: None,
            link: 1.5,
            include: Include::Intact,
            bridges: false,
            across_bodies: true,
            min_particles: 8,
        }
    }
}
