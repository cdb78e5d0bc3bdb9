//! The snapshots of a case: the default ones, and those of schedules of their own.

use super::format::{Portion, SnapshotFormat};
use crate::output::quantity::{Quantity, quantities_of};
use crate::output::{OutputError, Schedule};
use model::{Case, Precision, SnapshotSchedule};
use particles::ParticleStore;

/// A series of snapshots.
#[derive(Debug)]
pub struct Plan {
    /// Name of the schedule; the default snapshots have none.
    pub name: Option<String>,
    schedule: Schedule,
    quantities: Vec<Quantity>,
    precision: Precision,
    portion: Portion,
}

impl Plan {
    /// All of a case: the default snapshots first.
    ///
    /// # Errors
    /// [`OutputError::UnknownField`].
    pub fn all(case: &Case, particles: &ParticleStore) -> Result<Vec<Self>, OutputError> {
        let default = Self {
            name: None,
            schedule: Schedule::new(case.output.snapshot_every),
            quantities: quantities_of(case, &case.output.fields, particles)?,
            precision: Precision::Double,
            portion: Portion::default(),
        };
        let more = case.output.snapshots.iter();
        let more = more.map(|schedule| Self::of(schedule, case, particles));
        std::iter::once(Ok(default)).chain(more).collect()
    }

    fn of(
        schedule: &SnapshotSchedule,
        case: &Case,
        particles: &ParticleStore,
    ) -> Result<Self, OutputError> {
        Ok(Self {
            name: Some(schedule.name.clone()),
            schedule: Schedule::new(schedule.every),
            quantities: quantities_of(case, &schedule.fields, particles)?,
            precision: schedule.precision,
            portion: Portion::of(schedule),
        })
    }

    /// Returns true if a step from time `before` to time `now` (s) reaches or passes a due time.
    #[must_use]
    pub fn is_due(&self, before: f64, now: f64) -> bool {
        self.schedule.is_due(before, now)
    }

    /// Returns true if it holds the fragment of each particle.
    #[must_use]
    pub fn shows_fragments(&self) -> bool {
        let shows = |quantity: &Quantity| matches!(quantity, Quantity::Fragment);
        self.quantities.iter().any(shows)
    }

    /// Contents and format of each snapshot.
    #[must_use]
    pub fn format(&self) -> SnapshotFormat<'_> {
        SnapshotFormat {
            precision: self.precision,
            portion: &self.portion,
            schedule: self.name.as_deref(),
            ..SnapshotFormat::of(&self.quantities)
        }
    }
}
