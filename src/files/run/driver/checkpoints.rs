//! The checkpoints of a run.

use std::time::Instant;

use super::Driver;
use crate::output::{OutputError, ResultExtents, checkpoint};
use comm::Comm;
use engine::step::measurements;

impl Driver<'_> {
    /// Writes a checkpoint; `stop` if a stop has written a snapshot of this step.
    pub(super) fn write_checkpoint(&mut self, comm: &Comm, stop: bool) -> Result<(), OutputError> {
        let begun = Instant::now();
        self.write_crossings(comm)?;
        // Rows before this checkpoint are not written again once it is there.
        let step = self.simulation.state.step;
        let mut results = ResultExtents::default();
        self.folder.on_root(comm, || {
            self.folder.list_checkpoint(step)?;
            if let Some(tables) = &mut self.tables {
                results.tables = tables.sync()?;
            }
            results.files = self.folder.result_files()?;
            if stop {
                let of_stop = self.folder.snapshot_of(None, step);
                let is_other = |name: &String| self.folder.path().join(name) != of_stop;
                results.files.retain(is_other);
            }
            Ok(())
        })?;
        let (folder, run) = (self.folder.checkpoints(), self.folder.id());
        measurements::join_extremes(&mut self.simulation, comm);
        let rows = &mut self.rows;
        let path = self.simulation.with_frozen(|simulation| {
            let state = &simulation.state;
            let text = serde_json::to_string(state).expect("plain numbers");
            let meta = checkpoint::Meta {
                run,
                step: state.step,
                time: state.time,
                state: &text,
                input: &simulation.case.resolved,
                results: &results,
            };
            let keep = simulation.case.output.checkpoints_kept;
            checkpoint::write(comm, &folder, &simulation.particles, &meta, keep, rows)
        })?;
        self.folder
            .on_root(comm, || self.folder.forget_set_aside())?;
        let took = begun.elapsed();
        self.output_time.checkpoints += took;
        let next = self.watch.wrote_checkpoint(took);
        let next = next.map_or(String::new(), |next| {
            let [took, next] = [took, next].map(|time| time.as_secs_f64());
            format!(" in {took:.3} s; the next after {next:.0} s")
        });
        let text = format!("checkpoint {}{next}", path.display());
        self.log(comm, &text);
        Ok(())
    }
}
