//! When fragments are told in a run, and what a fragment is.

use serde::Deserialize;

/// What belongs to fragments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Include {
    /// What has not failed.
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

/// Shortest link that links the neighbours of a particle of a cubic filling with each other, √2 spacings
/// apart.
const DIAGONAL: f64 = 1.42;

impl FragmentOptions {
    /// What looks like a mistake in a model of so many dimensions, if anything does.
    #[must_use]
    pub fn doubt(&self, dimension: usize) -> Option<String> {
        if self.link >= DIAGONAL || self.bridges || dimension == 1 {
            return None;
        }
        Some(format!(
            "a link of {} spacings is shorter than {DIAGONAL}: neighbours of a particle in a cubic filling are not \
             linked with each other, so that each particle is a bridge and all is dust, unless `bridges` is true",
            self.link
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_shorter_than_the_diagonal_is_doubtful() {
        let of = |link, bridges| FragmentOptions {
            link,
            bridges,
            ..FragmentOptions::default()
        };
        let doubt = of(1.4, false).doubt(3).unwrap();
        assert!(doubt.contains("a link of 1.4 spacings"), "{doubt}");
        assert_eq!(of(1.4, false).doubt(1), None);
        assert_eq!(of(1.4, true).doubt(2), None);
        assert_eq!(of(1.42, false).doubt(3), None);
    }
}
