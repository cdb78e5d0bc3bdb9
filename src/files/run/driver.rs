//! The run loop: steps, and output between them.

mod checkpoints;
mod measures;
mod snapshots;
mod status;

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Instant;

use super::departures::Departures;
use super::exit::EXIT_STOPPED;
use super::launch::{Launch, STEP, fail};
use super::load::load;
use super::notices::Notices;
use super::options::CommonArgs;
use super::output_time::OutputTime;
use super::progress::Progress;
use super::say::{counted, note, say, seconds};
use super::stop::{self, Watch};
use super::summary::{Clock, summary};
use super::tables::Tables;
use super::watched::Watched;
use super::{announce, census};
use crate::output::snapshot::Plan;
use crate::output::{
    Log, OutputError, Phase, RowSchedule, Rows, RunFolder, Schedule, agree, post_mortem, write_json,
};
use comm::Comm;
use engine::step::failure::{check_gain, post_mortem as post_mortem_of, remove_failed};
use engine::step::{self, Simulation, StepError, Timers, measurements};
use model::NumericalFailurePolicy;

/// A run in its folder, on one rank.
pub struct Driver<'a> {
    simulation: Simulation,
    folder: &'a RunFolder,
    until: Option<f64>,
    start: Instant,
    /// Seconds from the start of MPI to the first step, without output.
    set_up: f64,
    watch: Watch,
    plans: Vec<Plan>,
    rows: Rows,
    tables: Option<Tables>,
    log: Log,
    progress: Progress,
    notices: Notices,
    departures: Departures,
    watched: Watched,
    output_time: OutputTime,
    /// Post-mortems written.
    post_mortems: usize,
    /// Step of the last default snapshot.
    shown: Option<u64>,
}

/// Most post-mortems of a process: where particles are removed, the first ones are the most useful.
const POST_MORTEMS: usize = 10;

/// The end of the loop.
enum End {
    Finished,
    Until,
    Stopped(&'static str),
}

impl<'a> Driver<'a> {
    /// Opens the tables, reports the start (with `warnings` about the case), and writes the first
    /// snapshot of a run that does not continue from a checkpoint. Collective.
    ///
    /// # Errors
    /// The same on all ranks.
    pub fn begin(
        launch: &Launch,
        args: &CommonArgs,
        mut simulation: Simulation,
        folder: &'a RunFolder,
        restarted: Option<&Path>,
        warnings: &[String],
    ) -> Result<Self, OutputError> {
        let comm = launch.comm;
        let set_up = launch.ready.elapsed().as_secs_f64();
        simulation.step_control.poison = args.poison;
        // Time of set-up belongs to no step.
        simulation.timers = Timers::default();
        let plans = Plan::all(&simulation.case, &simulation.particles)?;
        let mut tables = None;
        folder.on_root(comm, || {
            let resume = restarted.is_some().then_some(&simulation.state);
            tables = Some(Tables::open(folder, &simulation, resume)?);
            folder.forget_stop(launch.began)
        })?;
        let stop = comm.is_root().then(|| folder.stop());
        let mut driver = Self {
            until: args.until,
            start: launch.start,
            set_up,
            watch: Watch::new(launch.signals.clone(), stop, launch.start, args.walltime),
            plans,
            rows: Rows::new(simulation.case.output.sharing),
            tables,
            log: Log::new(&folder.log(), comm.rank()),
            progress: Progress::of(comm.is_root(), &simulation.case),
            departures: Departures::new(&simulation),
            watched: Watched::begin(comm, folder, &simulation, restarted.is_some()),
            simulation,
            folder,
            notices: Notices::default(),
            output_time: OutputTime::default(),
            post_mortems: 0,
            shown: None,
        };
        let every = driver.simulation.case.output.checkpoint_every_wall;
        if comm.is_root() {
            driver.watch.ask_every(every);
        }
        announce::say_all(
            comm,
            &driver.simulation,
            &mut driver.log,
            restarted,
            set_up,
            warnings,
        );
        if restarted.is_none() {
            let begun = Instant::now();
            driver.write_row(comm, true)?;
            driver.write_measures(comm, 0.0)?;
            let census_due = driver.simulation.case.fragments.is_some();
            driver.write_snapshots(comm, None, census_due)?;
            driver.output_time.add(begun);
        }
        Ok(driver)
    }

    /// Steps to the end of the case or to a stop; returns the exit code. Collective.
    pub fn run(mut self, comm: &Comm) -> u8 {
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
                self.record(comm, &format!("failed: {message}"));
                if self.folder.check().is_ok() {
                    let _ = self.tables.as_mut().map(Tables::write_records);
                }
                let state = &self.simulation.state;
                fail(comm, self.folder, &message, state.step, state.time)
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
            self.simulation.step_control.requests = self.watch.requests();
            #[cfg(debug_assertions)]
            super::fault::strike(
                comm.rank(),
                &mut self.simulation,
                &self.folder.checkpoints(),
            );
            let before = self.simulation.state.time;
            if let Err(error) = self.simulation.advance(comm) {
                self.handle_failure(comm, error)?;
            }
            let begun = Instant::now();
            self.write(comm, before).map_err(|e| e.to_string())?;
            self.output_time.add(begun);
            if let Err(error) = check_gain(&self.simulation, comm) {
                self.handle_failure(comm, error)?;
            }
            self.simulation.timers.lap(step::Phase::Output);
            if let Some(reason) = stop::reason(self.simulation.step_control.agreed_requests)
                && !self.simulation.is_finished()
            {
                return Ok(End::Stopped(reason));
            }
        }
    }

    /// Writes a post-mortem of a numerical failure, then follows the policy of the case: the end, or removal of
    /// particles until there is no failure.
    fn handle_failure(&mut self, comm: &Comm, mut error: StepError) -> Result<(), String> {
        loop {
            let StepError::Failure { step, id, kind, .. } = error else {
                return Err(error.to_string());
            };
            let stem = self.folder.post_mortem(step);
            let mut text = error.to_string();
            if self.post_mortems < POST_MORTEMS {
                self.post_mortems += 1;
                let about = post_mortem_of(&mut self.simulation, comm, id);
                let simulation = &self.simulation;
                let there = self.folder.on_root(comm, || {
                    let mut files = ["txt", "h5"]
                        .map(|ending| stem.with_extension(ending))
                        .into_iter();
                    files.try_for_each(|path| self.folder.list(&path))
                });
                let written = there.and_then(|()| match about {
                    None => Ok(()),
                    Some(about) => post_mortem::write(
                        &stem,
                        &text,
                        &simulation.case,
                        &simulation.particles,
                        &about,
                    ),
                });
                text = match agree(comm, written) {
                    Ok(()) => format!("{text}; see {}.txt", stem.display()),
                    Err(refused) => format!("{text}; {refused}"),
                };
            }
            let done = match self.simulation.case.numerical_limits.policy {
                NumericalFailurePolicy::Stop => return Err(text),
                NumericalFailurePolicy::Remove => "removed",
                NumericalFailurePolicy::Freeze => "froze",
            };
            if kind.is_of_all() {
                return Err(text);
            }
            match remove_failed(&mut self.simulation, comm) {
                Ok(count) => {
                    self.log(
                        comm,
                        &format!("{done} {}: {text}", counted(count, "particle")),
                    );
                    return Ok(());
                }
                Err(next) => {
                    self.log(comm, &format!("{done} particles: {text}"));
                    error = next;
                }
            }
        }
    }

    /// Writes all output due after a step that began at time `before` (s).
    fn write(&mut self, comm: &Comm, before: f64) -> Result<(), OutputError> {
        self.write_measures(comm, before)?;
        for text in self.departures.notices(&self.simulation) {
            self.log(comm, &text);
        }
        if let Some(text) = self.notices.decomposition(comm, &self.simulation) {
            self.record(comm, &text);
            self.progress.say(&text);
        }
        let finished = self.simulation.is_finished();
        let (now, step) = (self.simulation.state.time, self.simulation.state.step);
        let output = &self.simulation.case.output;
        let mut due = self.plans.iter().map(|plan| plan.is_due(before, now));
        let default_due = due.next().unwrap_or_default();
        let snapshot_due = default_due || due.any(|due| due);
        let checkpoint_due = Schedule::new(output.checkpoint_every).is_due(before, now)
            || output
                .checkpoint_every_steps
                .is_some_and(|n| step.is_multiple_of(n))
            || stop::wants_checkpoint(self.simulation.step_control.agreed_requests);
        let rows = RowSchedule::of(&self.simulation.case);
        if finished || rows.sums_are_due(step, before, now) {
            measurements::diagnose(&mut self.simulation, comm);
        }
        if finished || rows.is_due(step, before, now) {
            let of_bodies = finished || rows.bodies_are_due(step, before, now);
            self.write_row(comm, of_bodies)?;
        }
        let options = self.simulation.case.fragments;
        let census_due = options.is_some_and(|options| {
            finished || census::is_due(&options, [before, now], default_due)
        });
        if finished || snapshot_due {
            let step = (!finished).then_some([before, now]);
            self.write_snapshots(comm, step, census_due)?;
        } else if census_due {
            self.find_fragments(comm, true)?;
        }
        // A stop writes its own.
        let stops = stop::reason(self.simulation.step_control.agreed_requests).is_some();
        if checkpoint_due && !finished && !stops {
            self.write_checkpoint(comm, false)?;
        }
        if snapshot_due || checkpoint_due {
            self.folder.on_root(comm, || self.write_running())?;
        }
        if let Some(line) = self.progress.show(&self.simulation.state) {
            self.record(comm, &line);
        }
        self.renew_status(comm);
        Ok(())
    }

    /// Writes a row of each table, that of bodies if `of_bodies`.
    fn write_row(&mut self, comm: &Comm, of_bodies: bool) -> Result<(), OutputError> {
        self.write_crossings(comm)?;
        let load = load(comm, &self.simulation);
        let bodies = if of_bodies && self.simulation.case.measure.bodies {
            measurements::bodies(&mut self.simulation, comm)
        } else {
            Vec::new()
        };
        let wall = self.start.elapsed().as_secs_f64();
        let whole = comm
            .is_root()
            .then(|| measurements::whole(&self.simulation));
        if let Some(whole) = &whole {
            self.watched.row(whole, &load);
        }
        self.folder
            .on_root(comm, || match (&mut self.tables, &whole) {
                (Some(tables), Some(whole)) => {
                    tables.write(&self.simulation, whole, &bodies, &load, wall)
                }
                _ => Ok(()),
            })?;
        self.simulation.state.begin_interval();
        if let Some(text) = self.notices.notice(&self.simulation) {
            self.record(comm, &text);
            self.progress.warn(&text);
        }
        Ok(())
    }

    /// Writes the snapshot of a stop, the last checkpoint, `summary.json` and `status.json`; returns the exit code.
    fn close(mut self, comm: &Comm, phase: Phase, reason: Option<&str>, code: u8) -> u8 {
        self.progress.finish();
        let folder = self.folder;
        let begun = Instant::now();
        let mut output = String::new();
        // A stopped run shows where it is.
        let stop = phase == Phase::Stopped && self.shown != Some(self.simulation.state.step);
        // Before the checkpoint, which takes the halo that a snapshot reads.
        let shown = if stop { self.write_stop(comm) } else { Ok(()) };
        let closed = self.write_checkpoint(comm, stop).and(shown).and_then(|()| {
            self.output_time.add(begun);
            let clock = Clock {
                wall: self.start.elapsed().as_secs_f64(),
                set_up: self.set_up,
                output: self.output_time.seconds(comm),
            };
            output = clock.output.line(clock.wall);
            let summary = summary(comm, &self.simulation, &clock);
            folder.on_root(comm, || {
                write_json(&folder.summary(), &summary)?;
                self.write_status(phase, Some((reason, code)))
            })
        });
        let state = &self.simulation.state;
        if let Err(error) = closed {
            return fail(comm, folder, &error.to_string(), state.step, state.time);
        }
        let why = reason.map_or(String::new(), |reason| format!(" ({reason})"));
        let text = format!(
            "{}{why} at step {}, time {}, after {:.1} s",
            phase.name(),
            state.step,
            seconds(state.time),
            self.start.elapsed().as_secs_f64()
        );
        if comm.is_root() {
            say(&format!("{text}; results in {}", folder.path().display()));
        }
        self.log(comm, &output);
        self.record(comm, &text);
        code
    }

    /// Writes a line of the log, which is printed in JSON output only.
    fn log(&mut self, comm: &Comm, text: &str) {
        self.record(comm, text);
        if comm.is_root() {
            note(text);
        }
    }

    /// Writes a line of the log only.
    fn record(&mut self, comm: &Comm, text: &str) {
        if comm.is_root() {
            self.log.line(text);
        }
    }
}
