//! The snapshots that a case asks for: the usual ones, and those of schedules of their own.

use super::form::{Form, Part};
use crate::output::quantity::{Quantity, quantities_of};
use crate::output::{OutputError, Schedule};
use model::{Case, Precision, SnapshotSchedule};
use particles::ParticleStore;

/// Snapshots that are written again and again.
#[derive(Debug)]
pub struct Plan {
    /// Of the schedule; the usual snapshots have none.
    pub name: Option<String>,
    schedule: Schedule,
    quantities: Vec<Quantity>,
    precision: Precision,
    part: Part,
}

impl Plan {
    /// All of a case: the usual snapshots first.
    ///
    /// # Errors
    /// [`OutputError::UnknownField`].
    pub fn all(case: &Case, particles: &ParticleStore) -> Result<Vec<Self>, OutputError> {
        let usual = Self {
            name: None,
            schedule: Schedule::new(case.output.snapshot_every),
            quantities: quantities_of(case, &case.output.fields, particles)?,
            precision: Precision::Double,
            part: Part::default(),
        };
        let more = case.output.snapshots.iter();
        let more = more.map(|schedule| Self::of(schedule, case, particles));
        std::iter::once(Ok(usual)).chain(more).collect()
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
            part: Part::of(schedule),
        })
    }

    /// Whether a step from time `before` to time `now` (s) reaches or passes a due time.
    #[must_use]
    pub fn is_due(&self, before: f64, now: f64) -> bool {
        self.schedule.is_due(before, now)
    }

    /// Whether it tells the fragment of each particle.
    #[must_use]
    pub fn shows_fragments(&self) -> bool {
        let shows = |quantity: &Quantity| matches!(quantity, Quantity::Fragment);
        self.quantities.iter().any(shows)
    }

    /// What each holds and how.
    #[must_use]
    pub fn form(&self) -> Form<'_> {
        Form {
            precision: self.precision,
            part: &self.part,
            schedule: self.name.as_deref(),
            ..Form::of(&self.quantities)
        }
    }
}
