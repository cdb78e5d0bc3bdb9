//! Tables of measurements between steps.

use super::{Driver, census};
use crate::output::{OutputError, Schedule};
use comm::Comm;
use engine::step::measurements;
use model::Cadence;

impl Driver<'_> {
    /// Writes the gauges and measures that are due after a step that began at time `before` (s).
    pub(super) fn write_measures(&mut self, comm: &Comm, before: f64) -> Result<(), OutputError> {
        self.write_gauges(comm, before)?;
        self.write_findings(comm, before)
    }

    fn write_gauges(&mut self, comm: &Comm, before: f64) -> Result<(), OutputError> {
        if !self.simulation.gauges().any() {
            return Ok(());
        }
        let (step, now) = (self.simulation.state.step, self.simulation.state.time);
        let due = |every| match every {
            Cadence::Steps(steps) => step.is_multiple_of(steps),
            Cadence::Time(time) => step == 0 || Schedule::new(Some(time)).is_due(before, now),
        };
        let read = measurements::read_gauges(&mut self.simulation, comm, due);
        if read.is_empty() {
            return Ok(());
        }
        self.folder.on_root(comm, || match &mut self.tables {
            Some(tables) => tables.write_gauges(&self.simulation, &read),
            None => Ok(()),
        })
    }

    fn write_findings(&mut self, comm: &Comm, before: f64) -> Result<(), OutputError> {
        let (step, now) = (self.simulation.state.step, self.simulation.state.time);
        let options = &self.simulation.case.measure;
        let due = step == 0
            || self.simulation.is_finished()
            || Schedule::new(Some(options.every)).is_due(before, now);
        if options.measures.is_empty() || !due {
            return Ok(());
        }
        let found = measurements::findings(&mut self.simulation, comm);
        self.folder.on_root(comm, || match &mut self.tables {
            Some(tables) => tables.write_findings(&self.simulation, &found),
            None => Ok(()),
        })
    }

    /// Writes the particles that have passed witness planes since the last time.
    pub(super) fn write_crossings(&mut self, comm: &Comm) -> Result<(), OutputError> {
        let crossings = measurements::join_crossings(&mut self.simulation, comm);
        if crossings.is_empty() {
            return Ok(());
        }
        self.folder.on_root(comm, || match &mut self.tables {
            Some(tables) => tables.write_crossings(&self.simulation.case, &crossings),
            None => Ok(()),
        })
    }

    /// Labels of fragments of this rank's particles; writes their tables if `write`. Collective.
    pub(super) fn find_fragments(
        &mut self,
        comm: &Comm,
        write: bool,
    ) -> Result<Vec<u64>, OutputError> {
        let tables = write.then_some((self.folder, self.tables.as_mut()));
        census::take(comm, &mut self.simulation, tables)
    }
}
