//! Sweeps: a case run at many points, a process for each run.
//!
//! A point is the values of the keys that vary. Its run has a folder of its own, named after them,
//! which alone gives the state of the point. So a sweep may be killed at any time and goes on where
//! it was, runs no point twice, and its table is the same as if nothing had happened.

mod answers;
mod bands;
mod chart;
mod condition;
mod converge;
mod definition;
mod forks;
mod logistic;
mod plan;
mod point;
mod queue;
mod richardson;
mod seeds;
mod shots;
mod spacings;
mod table;
mod values;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

pub use answers::{Answers, Row, rows_of};
pub use chart::{draw, draw_effects};
pub use condition::Condition;
pub use converge::Converged;
pub use definition::Definition;
pub use logistic::{Onset, onset};
pub use plan::WITHIN;
pub use queue::Launch;
pub use shots::{Shot, shots};
pub use values::Values;

use files::input::InputError;
use files::output::{OutputError, write_atomically};
use forks::{Beginning, Forks};
use model::readable::printable;
use plan::{Bisection, Known, Plan};
use point::Point;
use queue::{PointState, Running};
use table::Ended;

/// Time between looks at runs.
const PAUSE: Duration = Duration::from_millis(50);
/// Time between looks at runs of others.
const PAUSE_FOR_OTHERS: Duration = Duration::from_secs(2);
/// Exit code of a run that was asked to stop.
const STOPPED: i32 = 75;

/// Why a sweep ends early.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// Something that was typed is wrong.
    #[error("error: {0}")]
    Typed(String),
    /// The case of a point is wrong.
    #[error("{0}")]
    Case(#[from] InputError),
    /// A file cannot be read or written.
    #[error("error: {0}")]
    Output(#[from] OutputError),
}

/// A sweep in its folder.
#[derive(Debug)]
pub struct Sweep {
    definition: Definition,
    plan: Plan,
    /// The resolved case.
    case: toml::Table,
    launch: Launch,
    ends: BTreeMap<String, Ended>,
    /// Points whose runs were stopped softly.
    stopped: Vec<String>,
    forks: Forks,
}

/// What points have taken over from others.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Shared {
    /// Runs that went on from others.
    pub runs: usize,
    /// Steps that were not computed again.
    pub steps: u64,
    /// Steps of all runs.
    pub all: u64,
}

/// The numbers of points of a sweep that has ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Points that have an answer.
    pub answered: usize,
    /// Points whose runs failed.
    pub failed: usize,
    /// Points that are left open.
    pub open: usize,
}

impl Sweep {
    /// A sweep whose points are all valid.
    ///
    /// # Errors
    /// [`SweepError::Typed`], [`SweepError::Case`].
    pub fn new(definition: Definition, launch: Launch) -> Result<Self, SweepError> {
        let plan = definition.plan().map_err(SweepError::Typed)?;
        let case = definition.resolved()?;
        let sweep = Self {
            definition,
            plan,
            case,
            launch,
            ends: BTreeMap::new(),
            stopped: Vec::new(),
            forks: Forks::default(),
        };
        for point in sweep.points()? {
            sweep.definition.case_of(&point)?;
        }
        Ok(sweep)
    }

    /// The same sweep with its runs started in another way.
    #[must_use]
    pub fn with_launch(self, launch: Launch) -> Self {
        Self { launch, ..self }
    }

    /// The number of known points.
    ///
    /// # Errors
    /// [`SweepError::Typed`].
    pub fn count(&self) -> Result<usize, SweepError> {
        Ok(self.points()?.len())
    }

    fn points(&self) -> Result<Vec<Point>, SweepError> {
        let mut points = self.plan.points(&self.known());
        let scattered = self.definition.scattered();
        let of_all = |name: &str| {
            let mut keys = self.plan.keys.iter().zip(&scattered);
            keys.position(|(key, scattered)| {
                key == name && (*scattered || self.definition.converges)
            })
        };
        if let Some(k) = of_all("spacing") {
            for point in &mut points {
                let spacing = point.values[k].number;
                let (spacing, _) = spacing.ok_or_else(|| {
                    SweepError::Typed("a spacing must be a length, as in 0.1 mm".to_owned())
                })?;
                let settings = spacings::scaled(&self.case, spacing).map_err(SweepError::Typed)?;
                point.settings.extend(settings);
            }
        }
        if let Some(k) = of_all(seeds::KEY) {
            for point in &mut points {
                let own = format!("{}={}", seeds::KEY, point.values[k].text);
                point.settings.retain(|setting| *setting != own);
                let settings = seeds::of_all(&self.case, &point.values[k].text);
                point.settings.extend(settings.map_err(SweepError::Typed)?);
            }
        }
        Ok(points)
    }

    /// The conditions of points whose runs have ended; a point without an answer is among them.
    fn known(&self) -> Known {
        let condition = self.plan.bisected.as_ref().map(|b| &b.condition);
        let ends = self.ends.iter().map(|(name, ended)| {
            let holds = match (ended, condition) {
                (Ended::Answered(answers), Some(condition)) => condition.holds(answers).ok(),
                _ => None,
            };
            (name.clone(), holds)
        });
        ends.collect()
    }

    /// Runs the points that have not been run, `jobs` runs at once, and keeps the tables up to
    /// date; passes each event to `report` as a line.
    ///
    /// # Errors
    /// [`SweepError::Output`].
    pub fn run(&mut self, jobs: usize, mut report: impl FnMut(&str)) -> Result<Tally, SweepError> {
        let mut running: Vec<Running> = Vec::new();
        let mut looked: Option<Instant> = None;
        loop {
            let points = self.points()?;
            let mut changed = false;
            let mut waits = !running.is_empty();
            let looks = looked.is_none_or(|looked| looked.elapsed() >= PAUSE_FOR_OTHERS);
            for (at, point) in points.iter().enumerate() {
                let is_running = running.iter().any(|run| run.name == point.name);
                if is_running || self.is_over(point) || !(looks || running.len() < jobs) {
                    continue;
                }
                match self.launch.state(point) {
                    PointState::Open if running.len() < jobs => {
                        waits = true;
                        let (keys, launch) = (&self.plan.keys, &self.launch);
                        let beginning = self.forks.beginning(
                            &self.definition,
                            keys,
                            (&points, at),
                            (&self.ends, &self.stopped),
                            |point| launch.checkpoints(point),
                        )?;
                        if beginning != Beginning::Later {
                            report(&format!("{}: runs", point.label(keys)));
                            running.push(self.launch.start(point, &beginning)?);
                        }
                    }
                    PointState::Open | PointState::Held => waits = true,
                    end => changed |= self.end(point, end, &mut report)?,
                }
            }
            if looks {
                looked = Some(Instant::now());
            }
            changed |= self.collect(&points, &mut running, &mut report)?;
            if changed {
                self.write()?;
                self.forget_checkpoints(&points)?;
            } else if waits {
                std::thread::sleep(PAUSE);
            } else {
                self.write()?;
                return self.tally();
            }
        }
    }

    /// Removes the checkpoints that runs have kept for others, where these are over.
    fn forget_checkpoints(&mut self, points: &[Point]) -> Result<(), SweepError> {
        let (ends, stopped) = (&self.ends, &self.stopped);
        let is_over = |point: &Point| is_over(ends, stopped, point);
        for (at, point) in points.iter().enumerate() {
            let (definition, keys) = (&self.definition, &self.plan.keys);
            if let Some(kept) = (self.forks).needed(definition, keys, (points, at), is_over)? {
                self.launch.keep_checkpoints(point, kept)?;
            }
        }
        Ok(())
    }

    /// What points have taken over from others.
    ///
    /// # Errors
    /// [`SweepError`].
    pub fn shared(&self) -> Result<Shared, SweepError> {
        let mut shared = Shared::default();
        for point in self.points()? {
            let run = self.launch.run_folder(&point);
            if !matches!(self.ends.get(&point.name), Some(Ended::Answered(_))) {
                continue;
            }
            shared.all += run.status()?.step;
            if let Ok(Some(forked)) = run.forked() {
                shared.runs += 1;
                shared.steps += forked.step;
            }
        }
        Ok(shared)
    }

    /// Runs one point, by its number from 1 on, in this order of the table; for arrays of a scheduler.
    ///
    /// # Errors
    /// [`SweepError::Typed`] if there is no such point, [`SweepError::Output`].
    pub fn run_one(
        &mut self,
        number: usize,
        mut report: impl FnMut(&str),
    ) -> Result<bool, SweepError> {
        let points = self.points()?;
        let Some(point) = number.checked_sub(1).and_then(|n| points.get(n)) else {
            let title = format!("there is no point {number}: the sweep has {}", points.len());
            return Err(SweepError::Typed(title));
        };
        if self.launch.state(point) == PointState::Open {
            report(&format!("{}: runs", point.label(&self.plan.keys)));
            let from_start = Beginning::Start(Vec::new());
            let mut running = vec![self.launch.start(point, &from_start)?];
            while !running.is_empty() {
                self.collect(&points, &mut running, &mut report)?;
                std::thread::sleep(PAUSE);
            }
        }
        Ok(self.launch.state(point) == PointState::Finished)
    }

    fn is_over(&self, point: &Point) -> bool {
        is_over(&self.ends, &self.stopped, point)
    }

    /// Takes in a point whose folder says that its run has ended.
    fn end(
        &mut self,
        point: &Point,
        state: PointState,
        report: &mut impl FnMut(&str),
    ) -> Result<bool, SweepError> {
        let ended = match state {
            PointState::Finished => {
                Ended::Answered(answers::of_run(&self.launch.run_folder(point))?)
            }
            PointState::Failed(why) => Ended::Failed(why),
            PointState::Open | PointState::Held => return Ok(false),
        };
        let what = match (&ended, &self.plan.bisected) {
            (Ended::Answered(answers), Some(bisected)) => match bisected.condition.holds(answers) {
                Ok(true) => "the condition holds".to_owned(),
                Ok(false) => "the condition does not hold".to_owned(),
                Err(why) => why,
            },
            (Ended::Answered(_), None) => "finished".to_owned(),
            (Ended::Failed(why), _) => format!("failed: {why}"),
        };
        report(&format!(
            "{}: {}",
            point.label(&self.plan.keys),
            printable(&what)
        ));
        self.ends.insert(point.name.clone(), ended);
        Ok(true)
    }

    /// Takes in processes that have ended.
    fn collect(
        &mut self,
        points: &[Point],
        running: &mut Vec<Running>,
        report: &mut impl FnMut(&str),
    ) -> Result<bool, SweepError> {
        let mut changed = false;
        let mut k = 0;
        while k < running.len() {
            let code = running[k].ended();
            let code = code.map_err(OutputError::io("wait for", Path::new("a run")))?;
            let Some(code) = code else {
                k += 1;
                continue;
            };
            let name = running.swap_remove(k).name;
            let Some(point) = points.iter().find(|point| point.name == name) else {
                continue;
            };
            if code == STOPPED {
                report(&format!("{}: was stopped", point.label(&self.plan.keys)));
                self.stopped.push(name);
                continue;
            }
            let state = match self.launch.state(point) {
                PointState::Finished if code == 0 => PointState::Finished,
                PointState::Failed(why) if !why.is_empty() => PointState::Failed(why),
                _ => PointState::Failed(format!("exit code {code}, see {name}.log")),
            };
            changed |= self.end(point, state, report)?;
        }
        Ok(changed)
    }

    /// All points with what is known of them.
    fn rows(&self) -> Result<Vec<(Point, Option<Ended>)>, SweepError> {
        let points = self.points()?.into_iter();
        let rows = points.map(|point| {
            let ended = self.ends.get(&point.name).cloned();
            (point, ended)
        });
        Ok(rows.collect())
    }

    /// Writes `sweep.csv`, of a bisection `limits.csv`, and where keys are scattered `bands.csv` and `effects.csv`.
    fn write(&self) -> Result<(), SweepError> {
        let folder = &self.definition.folder;
        let points = table::points(&self.plan.keys, &self.rows()?, &self.definition.answers);
        write_atomically(&folder.join("sweep.csv"), &points.text())?;
        let limits = table::limits(&self.plan, &self.bisections());
        if let Some(limits) = &limits {
            write_atomically(&folder.join("limits.csv"), &limits.text())?;
        }
        let mut scattered = self.definition.scattered();
        if !scattered.contains(&true) {
            return Ok(());
        }
        // A row of limits has no column of the key that is bisected, and ends with a state; one of points has its run and its
        // state before answers.
        let (sheet, answers) = match &limits {
            Some(limits) => {
                scattered.pop();
                (limits, scattered.len())
            }
            None => (&points, scattered.len() + 2),
        };
        let layout = bands::Layout { scattered, answers };
        write_atomically(
            &folder.join("bands.csv"),
            &bands::bands(sheet, &layout).text(),
        )?;
        write_atomically(
            &folder.join("effects.csv"),
            &bands::effects(sheet, &layout).text(),
        )?;
        Ok(())
    }

    fn bisections(&self) -> Vec<(Vec<values::Value>, Bisection)> {
        let known = self.known();
        let all = self.plan.combinations().into_iter().map(|values| {
            let bisection = self.plan.bisection(&values, &known);
            (values, bisection)
        });
        all.collect()
    }

    fn tally(&self) -> Result<Tally, SweepError> {
        let mut tally = Tally::default();
        for (_, ended) in self.rows()? {
            match ended {
                Some(Ended::Answered(_)) => tally.answered += 1,
                Some(Ended::Failed(_)) => tally.failed += 1,
                None => tally.open += 1,
            }
        }
        Ok(tally)
    }
}

/// True if the run of a point has ended, or was stopped.
fn is_over(ends: &BTreeMap<String, Ended>, stopped: &[String], point: &Point) -> bool {
    ends.contains_key(&point.name) || stopped.contains(&point.name)
}
