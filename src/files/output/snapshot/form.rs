//! What a snapshot holds and how.

use crate::output::partitions::PARTITION_ROWS;
use crate::output::quantity::Quantity;
use model::{Case, Precision, Region, SnapshotSchedule};
use particles::ParticleStore;

/// What a snapshot holds and how.
#[derive(Debug, Clone, Copy)]
pub struct Form<'a> {
    /// What it tells of each particle.
    pub quantities: &'a [Quantity],
    /// Which particles it tells of.
    pub part: &'a Part,
    /// Of positions and of fields that are no whole numbers.
    pub precision: Precision,
    /// The schedule that it belongs to, if it is none of the usual snapshots.
    pub schedule: Option<&'a str>,
    /// Rows of a partition.
    pub partition_rows: u64,
}

impl<'a> Form<'a> {
    /// Some quantities of all particles.
    #[must_use]
    pub fn of(quantities: &'a [Quantity]) -> Self {
        Self {
            quantities,
            part: Part::ALL,
            precision: Precision::Double,
            schedule: None,
            partition_rows: PARTITION_ROWS,
        }
    }
}

/// Which particles a snapshot tells of.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Of these bodies; of all if absent.
    pub bodies: Option<Vec<usize>>,
    /// In this region.
    pub region: Region,
}

impl Default for Part {
    fn default() -> Self {
        Self::ALL.clone()
    }
}

impl Part {
    /// The whole model.
    const ALL: &Self = &Self {
        bodies: None,
        region: Region::OPEN,
    };

    /// That of a schedule.
    #[must_use]
    pub fn of(schedule: &SnapshotSchedule) -> Self {
        Self {
            bodies: schedule.bodies.clone(),
            region: schedule.region.unwrap_or(Region::OPEN),
        }
    }

    /// Whether it is the whole model.
    #[must_use]
    pub fn is_all(&self) -> bool {
        self == Self::ALL
    }

    /// The owned particles that belong to it; nothing where all do. A place that is no number is
    /// beyond no side, so that runaways are seen.
    #[must_use]
    pub(super) fn chosen(&self, particles: &ParticleStore) -> Option<Vec<u32>> {
        let is_in = |&i: &u32| {
            let i = i as usize;
            let body = particles.body[i] as usize;
            let bodies = self.bodies.as_ref();
            bodies.is_none_or(|bodies| bodies.contains(&body))
                && !self.region.is_left_by(&particles.position[i])
        };
        let owned = u32::try_from(particles.owned()).expect("a rank's particles fit u32");
        (!self.is_all()).then(|| (0..owned).filter(is_in).collect())
    }

    /// What it is, in words.
    #[must_use]
    pub(super) fn text(&self, case: &Case) -> String {
        let mut words = Vec::new();
        if let Some(bodies) = &self.bodies {
            let names = bodies.iter().filter_map(|&b| case.bodies.get(b));
            let names: Vec<&str> = names.map(|body| body.name.as_str()).collect();
            words.push(format!("of {}", names.join(", ")));
        }
        let sides = [("above", self.region.above), ("below", self.region.below)];
        for (side, ends) in sides {
            let named = ["x", "y", "z"].into_iter().zip(ends);
            let named = named.filter(|(_, end)| end.is_finite());
            let named: Vec<String> = named
                .map(|(axis, end)| format!("{axis} = {end} m"))
                .collect();
            if !named.is_empty() {
                words.push(format!("{side} {}", named.join(", ")));
            }
        }
        words.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_of_some_bodies_and_within_sides() {
        let mut particles = ParticleStore::default();
        particles.resize_owned(4);
        particles.resize_halo(1);
        for (i, (body, x)) in [(0, 0.0), (1, 1.0), (1, f64::NAN), (0, 2.0), (1, 0.5)]
            .into_iter()
            .enumerate()
        {
            particles.body[i] = body;
            particles.position[i] = [x, 0.0, 0.0];
        }
        let mut part = Part::default();
        assert!(part.is_all() && part.chosen(&particles).is_none());
        part.bodies = Some(vec![1]);
        assert_eq!(part.chosen(&particles), Some(vec![1, 2]));
        part.region.below[0] = 0.9;
        assert_eq!(part.chosen(&particles), Some(vec![2]));
        part.bodies = None;
        assert_eq!(part.chosen(&particles), Some(vec![0, 2]));
    }
}
