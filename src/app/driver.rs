//! The run loop: steps, and what is written between them.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use super::report::{Progress, Tables, summary};
use super::stop::{self, Watch};
use super::{EXIT_STOPPED, report};
use crate::comm::Comm;
use crate::output::checkpoint;
use crate::output::snapshot::{self, Quantity};
use crate::output::{
    Log, OutputError, Phase, Rows, RunFolder, Schedule, Status, on_root, series, write_json,
};
use crate::step::{self, Simulation};

/// The step that this process is in, for the message of a panic.
pub static STEP: AtomicU64 = AtomicU64::new(0);

/// Options of the loop.
pub struct Options {
    /// Stop with a checkpoint at the first step at or after this time (s).
    pub until: Option<f64>,
    /// Stop with a checkpoint when this much time has passed.
    pub walltime: Option<Duration>,
    /// Fill all that is not state with NaN between steps.
    pub poison: bool,
    /// When the program started.
    pub start: Instant,
}

/// One rank's part of a run in its folder.
pub struct Driver<'a> {
    simulation: Simulation,
    folder: &'a RunFolder,
    until: Option<f64>,
    start: Instant,
    watch: Watch,
    quantities: Vec<Quantity>,
    rows: Rows,
    tables: Option<Tables>,
    log: Log,
    progress: Progress,
}

/// How a loop ended.
enum End {
    Finished,
    Until,
    Stopped(&'static str),
}

impl<'a> Driver<'a> {
    /// Opens the tables, and writes the first snapshot of a run that does not go on from a
    /// checkpoint. Collective.
    ///
    /// # Errors
    /// The same on all ranks.
    pub fn begin(
        comm: &Comm,
        mut simulation: Simulation,
        folder: &'a RunFolder,
        options: &Options,
        restarted: Option<&Path>,
    ) -> Result<Self, OutputError> {
        simulation.poison = options.poison;
        let quantities = snapshot::quantities(&simulation.case.output.fields)?;
        let mut tables = None;
        on_root(comm, || {
            let resume = restarted.is_some().then_some(&simulation.state);
            tables = Some(Tables::open(folder, resume)?);
            Ok(())
        })?;
        let watched = comm.is_root().then(|| folder.path());
        let mut driver = Self {
            until: options.until,
            start: options.start,
            watch: Watch::new(watched, options.walltime).since(options.start),
            quantities,
            rows: Rows::default(),
            tables,
            log: Log::new(&folder.log(), comm.rank()),
            progress: Progress::new(comm, &simulation),
            simulation,
            folder,
        };
        driver.announce(comm, restarted);
        if restarted.is_none() {
            driver.write_row(comm)?;
            driver.write_snapshot(comm)?;
        }
        Ok(driver)
    }

    /// Steps to the end of the case or to a stop; returns the exit code. Collective.
    pub fn run(mut self, comm: &Comm) -> u8 {
        let folder = self.folder;
        match self.advance(comm) {
            Ok(End::Finished) => self.close(comm, Phase::Finished, None, 0),
            Ok(End::Until) => {
                let reason = "the time of --until is reached";
                self.close(comm, Phase::Stopped, Some(reason), 0)
            }
            Ok(End::Stopped(reason)) => {
                self.close(comm, Phase::Stopped, Some(reason), EXIT_STOPPED)
            }
            Err(message) => {
                self.progress.finish();
                self.log(comm, &format!("failed: {message}"));
                fail(comm, folder, &message)
            }
        }
    }

    fn advance(&mut self, comm: &Comm) -> Result<End, String> {
        loop {
            if self.simulation.is_finished() {
                return Ok(End::Finished);
            }
            if self
                .until
                .is_some_and(|until| self.simulation.state.time >= until)
            {
                return Ok(End::Until);
            }
            STEP.store(self.simulation.state.step + 1, Ordering::Relaxed);
            self.simulation.wishes = self.watch.wishes();
            let before = self.simulation.state.time;
            self.simulation.advance(comm).map_err(|e| e.to_string())?;
            self.write(comm, before).map_err(|e| e.to_string())?;
            self.simulation.timers.lap(step::Phase::Output);
            if let Some(reason) = stop::reason(self.simulation.agreed_wishes)
                && !self.simulation.is_finished()
            {
                return Ok(End::Stopped(reason));
            }
        }
    }

    /// Whatever is due after a step that began at time `before` (s).
    fn write(&mut self, comm: &Comm, before: f64) -> Result<(), OutputError> {
        let finished = self.simulation.is_finished();
        let (now, step) = (self.simulation.state.time, self.simulation.state.step);
        let output = &self.simulation.case.output;
        let snapshot_due = Schedule::new(output.snapshot_every).is_due(before, now);
        let checkpoint_due = Schedule::new(output.checkpoint_every).is_due(before, now);
        if finished || step.is_multiple_of(output.history_every.max(1)) {
            self.simulation.diagnose(comm);
            self.write_row(comm)?;
        }
        if finished || snapshot_due {
            self.write_snapshot(comm)?;
        }
        if checkpoint_due && !finished {
            self.write_checkpoint(comm)?;
        }
        self.progress.show(&self.simulation);
        Ok(())
    }

    fn write_row(&mut self, comm: &Comm) -> Result<(), OutputError> {
        let load = report::load(comm, &self.simulation);
        let wall = self.start.elapsed().as_secs_f64();
        on_root(comm, || match &mut self.tables {
            Some(tables) => tables.write(&self.simulation, &load, wall),
            None => Ok(()),
        })
    }

    fn write_snapshot(&mut self, comm: &Comm) -> Result<(), OutputError> {
        let state = &self.simulation.state;
        let path = self.folder.snapshot(state.step);
        let meta = snapshot::Meta {
            case: &self.simulation.case,
            step: state.step,
            time: state.time,
            threads: rayon::current_num_threads(),
            wall_seconds: self.start.elapsed().as_secs_f64(),
        };
        let store = &self.simulation.store;
        snapshot::write(comm, &path, store, &meta, &self.quantities, &mut self.rows)?;
        on_root(comm, || {
            let name = RunFolder::snapshot_name(state.step);
            series::add(&self.folder.series(), &name, state.time)
        })?;
        let text = format!("snapshot {}", path.display());
        self.log(comm, &text);
        Ok(())
    }

    fn write_checkpoint(&mut self, comm: &Comm) -> Result<(), OutputError> {
        let state = &self.simulation.state;
        let text = serde_json::to_string(state).expect("plain numbers");
        let meta = checkpoint::Meta {
            step: state.step,
            time: state.time,
            state: &text,
            input: &self.simulation.case.resolved,
        };
        let keep = self.simulation.case.output.checkpoints_kept;
        let store = &self.simulation.store;
        let folder = self.folder.checkpoints();
        let path = checkpoint::write(comm, &folder, store, &meta, keep, &mut self.rows)?;
        let text = format!("checkpoint {}", path.display());
        self.log(comm, &text);
        Ok(())
    }

    /// The last checkpoint, `summary.json` and `status.json`; gives the exit code.
    fn close(mut self, comm: &Comm, phase: Phase, reason: Option<&str>, code: u8) -> u8 {
        self.progress.finish();
        let folder = self.folder;
        let closed = self.write_checkpoint(comm).and_then(|()| {
            let wall = self.start.elapsed().as_secs_f64();
            let summary = summary(comm, &self.simulation, wall);
            let state = &self.simulation.state;
            on_root(comm, || {
                write_json(&folder.summary(), &summary)?;
                folder.write_status(&Status {
                    state: phase,
                    step: state.step,
                    time: state.time,
                    reason: reason.map(str::to_owned),
                })
            })
        });
        if let Err(error) = closed {
            return fail(comm, folder, &error.to_string());
        }
        let state = &self.simulation.state;
        let why = reason.map_or(String::new(), |reason| format!(": {reason}"));
        let text = format!(
            "{}{why}, step {}, time {}, {:.1} s",
            phase.name(),
            state.step,
            report::seconds(state.time),
            self.start.elapsed().as_secs_f64()
        );
        if comm.is_root() {
            println!("{text}; results in {}", folder.path().display());
        }
        self.log(comm, &text);
        code
    }

    fn announce(&mut self, comm: &Comm, restarted: Option<&Path>) {
        let mut counts = [self.simulation.store.owned() as u64];
        comm.sum_u64(&mut counts);
        let from = restarted.map_or(String::new(), |path| format!(", from {}", path.display()));
        let text = format!(
            "{}: {} particles on {} ranks × {} threads ({}){from}",
            self.simulation.case.title,
            counts[0],
            comm.size(),
            rayon::current_num_threads(),
            crate::sph::dispatch::instructions().name(),
        );
        if comm.is_root() {
            println!("{text}");
        }
        self.log(comm, &text);
    }

    fn log(&mut self, comm: &Comm, text: &str) {
        if comm.is_root() {
            self.log.line(text);
        }
    }
}

/// Says once for all ranks why a run failed, and writes it into its folder.
pub fn fail(comm: &Comm, folder: &RunFolder, message: &str) -> u8 {
    if comm.is_root() {
        eprintln!("error: {message}");
        let last = folder.status().ok();
        // The message above is what counts; the folder may be what failed.
        let _ = folder.write_status(&Status {
            state: Phase::Failed,
            step: last
                .as_ref()
                .map_or(0, |s| s.step)
                .max(STEP.load(Ordering::Relaxed).saturating_sub(1)),
            time: last.map_or(0.0, |s| s.time),
            reason: Some(message.to_owned()),
        });
    }
    comm.barrier();
    1
}
