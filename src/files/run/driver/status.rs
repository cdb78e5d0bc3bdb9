//! The status of a run.

use std::time::Instant;

use super::Driver;
use crate::output::{OutputError, Phase, Status};
use comm::Comm;

impl Driver<'_> {
    /// Writes `status.json`, with the reason and the exit code of a run that ends. Rank 0's alone.
    pub(super) fn write_status(
        &self,
        phase: Phase,
        end: Option<(Option<&str>, u8)>,
    ) -> Result<(), OutputError> {
        let state = &self.simulation.state;
        let wall = self.start.elapsed().as_secs_f64();
        let left = self.progress.time_left().filter(|_| end.is_none());
        self.folder.write_status(&Status {
            reason: end.and_then(|(reason, _)| reason).map(str::to_owned),
            exit_code: end.map(|(_, code)| code),
            outlook: Some(self.watched.outlook(state, wall, left)),
            ..Status::new(phase, state.step, state.time)
        })
    }

    /// Writes the status of a running run. Rank 0's alone.
    pub(super) fn write_running(&mut self) -> Result<(), OutputError> {
        let begun = Instant::now();
        let written = self.write_status(Phase::Running, None);
        self.watched.wrote(begun);
        written
    }

    /// Writes that status if it is due, for watching the run.
    pub(super) fn renew_status(&mut self, comm: &Comm) {
        if comm.is_root() && self.watched.is_due() {
            // If the folder takes no files any more, required output fails and reports it.
            let _ = self.folder.check().and_then(|()| self.write_running());
        }
    }
}
