//! Contents and format of a snapshot.

use crate::output::partitions::PARTITION_ROWS;
use crate::output::quantity::Quantity;
use model::{Case, Precision, Region, SnapshotSchedule};
use particles::ParticleStore;

/// Contents and format of a snapshot.
#[derive(Debug, Clone, Copy)]
pub struct SnapshotFormat<'a> {
    /// Quantities of each particle.
    pub quantities: &'a [Quantity],
    /// The particles that it holds.
    pub portion: &'a Portion,
    /// Precision of positions and real fields.
    pub precision: Precision,
    /// The schedule that it belongs to, if it is no default snapshot.
    pub schedule: Option<&'a str>,
    /// Rows of a partition.
    pub partition_rows: u64,
}

impl<'a> SnapshotFormat<'a> {
    /// Some quantities of all particles.
    #[must_use]
    pub fn of(quantities: &'a [Quantity]) -> Self {
        Self {
            quantities,
            portion: Portion::ALL,
            precision: Precision::Double,
            schedule: None,
            partition_rows: PARTITION_ROWS,
        }
    }
}

/// The particles that a snapshot holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Portion {
    /// Particles of these bodies; of all if absent.
    pub bodies: Option<Vec<usize>>,
    /// Particles in this region.
    pub region: Region,
}

impl Default for Portion {
    fn default() -> Self {
        Self::ALL.clone()
    }
}

impl Portion {
    /// The whole model.
    const ALL: &Self = &Self {
        bodies: None,
        region: Region::OPEN,
    };

    /// The portion of a schedule.
    #[must_use]
    pub fn of(schedule: &SnapshotSchedule) -> Self {
        Self {
            bodies: schedule.bodies.clone(),
            region: schedule.region.unwrap_or(Region::OPEN),
        }
    }

    /// Returns true if it is the whole model.
    #[must_use]
    pub fn is_all(&self) -> bool {
        self == Self::ALL
    }

    /// The owned particles that belong to it; `None` if all do. A NaN position is beyond no side, so that
    /// runaways are seen.
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

    /// Its description in words.
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
        let mut portion = Portion::default();
        assert!(portion.is_all() && portion.chosen(&particles).is_none());
        portion.bodies = Some(vec![1]);
        assert_eq!(portion.chosen(&particles), Some(vec![1, 2]));
        portion.region.below[0] = 0.9;
        assert_eq!(portion.chosen(&particles), Some(vec![2]));
        portion.bodies = None;
        assert_eq!(portion.chosen(&particles), Some(vec![0, 2]));
    }
}
