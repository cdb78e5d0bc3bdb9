//! The snapshots of a run: the default ones, and those of schedules of their own.

use std::time::Instant;

use super::Driver;
use crate::output::{OutputError, RunFolder, make_folder, series, snapshot};
use comm::Comm;

impl Driver<'_> {
    /// Writes the snapshots that are due after a `step` between two times (s), or all of them, and the
    /// tables of fragments if `census_due`.
    pub(super) fn write_snapshots(
        &mut self,
        comm: &Comm,
        step: Option<[f64; 2]>,
        census_due: bool,
    ) -> Result<(), OutputError> {
        let is_due = |plan: &snapshot::Plan| step.is_none_or(|[a, b]| plan.is_due(a, b));
        let due: Vec<bool> = self.plans.iter().map(is_due).collect();
        self.write_due(comm, &due, census_due)
    }

    /// Writes the default snapshot where a run stops.
    pub(super) fn write_stop(&mut self, comm: &Comm) -> Result<(), OutputError> {
        let due: Vec<bool> = (0..self.plans.len()).map(|k| k == 0).collect();
        self.write_due(comm, &due, false)
    }

    /// Writes the snapshots of some of the plans.
    fn write_due(
        &mut self,
        comm: &Comm,
        due: &[bool],
        census_due: bool,
    ) -> Result<(), OutputError> {
        let begun = Instant::now();
        self.simulation.complete_shown(comm);
        let mut chosen = self.plans.iter().zip(due).filter(|(_, due)| **due);
        let labels = if census_due || chosen.any(|(plan, _)| plan.shows_fragments()) {
            self.find_fragments(comm, census_due)?
        } else {
            Vec::new()
        };
        for (k, _) in due.iter().enumerate().filter(|(_, due)| **due) {
            self.write_snapshot(comm, k, &labels)?;
            // Snapshots of portions say little about the time of a checkpoint.
            if k == 0 {
                self.watch.wrote_snapshot(begun.elapsed());
                self.shown = Some(self.simulation.state.step);
            }
        }
        self.output_time.snapshots += begun.elapsed();
        Ok(())
    }

    /// Writes the snapshot of one of the plans.
    fn write_snapshot(
        &mut self,
        comm: &Comm,
        plan: usize,
        labels: &[u64],
    ) -> Result<(), OutputError> {
        let (plan, rows) = (&self.plans[plan], &mut self.rows);
        let name = plan.name.as_deref();
        let path = self.folder.snapshot_of(name, self.simulation.state.step);
        self.folder.on_root(comm, || {
            let folder = self.folder.snapshots_of(name);
            make_folder(&folder)?;
            self.folder.list(&path)?;
            self.folder.list(&self.folder.series_of(name))
        })?;
        self.simulation.with_frozen(|simulation| {
            let meta = snapshot::Meta {
                run: self.folder.id(),
                case: &simulation.case,
                step: simulation.state.step,
                time: simulation.state.time,
                threads: rayon::current_num_threads(),
                wall_seconds: self.start.elapsed().as_secs_f64(),
                fragments: labels,
            };
            let format = plan.format();
            snapshot::write(comm, &path, &simulation.particles, &meta, &format, rows)
        })?;
        let state = &self.simulation.state;
        self.folder.on_root(comm, || {
            let file = RunFolder::snapshot_name(state.step);
            series::add(&self.folder.series_of(name), &file, state.time)
        })?;
        self.log(comm, &format!("snapshot {}", path.display()));
        Ok(())
    }
}
