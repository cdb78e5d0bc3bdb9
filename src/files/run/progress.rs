//! Progress of a run: a bar on a terminal, a line every ten seconds elsewhere.

use std::fs::File;
use std::io::IsTerminal;
use std::os::unix::process::parent_id;
use std::time::{Duration, Instant};

use console::Term;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Map, Value};

use super::say::{report, say, seconds, warn};
use super::verbosity::Verbosity;
use crate::preflight::expected_step;
use engine::step::RunState;
use model::{Case, RunControl};

/// Time between two lines.
const LINE_EVERY: Duration = Duration::from_secs(10);
/// Draws a second, at most.
const DRAWS: u8 = 10;
/// Fraction of a run before its own steps predict those to come.
const START: f64 = 0.01;
/// Length of the bar in its own units.
const TICKS: u64 = 1000;

/// Progress of a run, which rank 0 prints.
pub struct Progress {
    prints: bool,
    bar: Option<ProgressBar>,
    control: RunControl,
    /// Predicted time step (s).
    expected: Option<f64>,
    /// The first state: clock time, step and time (s).
    begun: Option<(Instant, u64, f64)>,
    last: Instant,
    /// The time left at the last update.
    left: Option<Duration>,
}

impl Progress {
    /// Of a case; only the rank that `prints`, rank 0, writes anything.
    pub fn of(prints: bool, case: &Case) -> Self {
        Self::new(prints, &case.run, expected_step(case))
    }

    /// At the start of a run its steps are taken to be `expected` (s).
    fn new(prints: bool, control: &RunControl, expected: Option<f64>) -> Self {
        let draws = prints && Verbosity::now() == Verbosity::default();
        let bar = draws.then(terminal).flatten().map(|target| {
            // Within 80 columns: a longer line would wrap and be drawn over and over.
            let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}");
            let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::with_draw_target(Some(TICKS), target).with_style(style)
        });
        Self {
            prints,
            bar,
            control: *control,
            expected,
            begun: None,
            last: Instant::now(),
            left: None,
        }
    }

    /// Shows the progress; returns a line for the log every ten seconds.
    pub fn show(&mut self, state: &RunState) -> Option<String> {
        self.left = self.left(state);
        let left = left(self.left);
        if let Some(bar) = &self.bar {
            let text = format!("step {}, {}{left}", state.step, seconds(state.time));
            bar.set_message(text);
            bar.set_position(self.ticks(state));
        }
        if !self.prints || self.last.elapsed() < LINE_EVERY {
            return None;
        }
        self.last = Instant::now();
        let line = format!("{}{left}", line(state));
        if self.bar.is_none() {
            report(&line, &self.fields(state));
        }
        Some(line)
    }

    /// The time left: the mean time of the steps so far, for each of those to come.
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    fn left(&mut self, state: &RunState) -> Option<Duration> {
        let now = (Instant::now(), state.step, state.time);
        let (begun, step, time) = *self.begun.get_or_insert(now);
        let (steps, way) = ((state.step - step) as f64, state.time - time);
        let to_come = self.control.end_time - state.time;
        // Steps of the start do not predict those to come.
        let is_start = way < START * (way + to_come);
        let each = self.expected.filter(|_| is_start).unwrap_or(way / steps);
        let most = self
            .control
            .max_steps
            .map_or(f64::INFINITY, |most| most.saturating_sub(state.step) as f64);
        let seconds = begun.elapsed().as_secs_f64() / steps * (to_come / each).min(most);
        Duration::try_from_secs_f64(seconds).ok()
    }

    /// The values in a line.
    fn fields(&self, state: &RunState) -> Map<String, Value> {
        [
            ("step", state.step.into()),
            ("time_s", state.time.into()),
            ("dt_s", state.last_dt.into()),
            ("dt_reason", state.last_reason.name().into()),
            ("end_time_s", self.control.end_time.into()),
            ("left_s", self.left.map(|left| left.as_secs_f64()).into()),
        ]
        .map(|(name, value): (&str, Value)| (name.to_owned(), value))
        .into_iter()
        .collect()
    }

    /// The time left when it was last shown.
    pub fn time_left(&self) -> Option<Duration> {
        self.left
    }

    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "for people, and clamped"
    )]
    fn ticks(&self, state: &RunState) -> u64 {
        let steps = self.control.max_steps.unwrap_or(u64::MAX) as f64;
        let done = (state.time / self.control.end_time).max(state.step as f64 / steps);
        (done.clamp(0.0, 1.0) * TICKS as f64) as u64
    }

    /// Prints a line above the bar.
    pub fn say(&self, line: &str) {
        self.above(|| say(line));
    }

    /// Prints a warning above the bar.
    pub fn warn(&self, text: &str) {
        self.above(|| warn(text));
    }

    fn above(&self, print: impl FnOnce()) {
        match &self.bar {
            Some(bar) => bar.suspend(print),
            None if self.prints => print(),
            None => {}
        }
    }

    /// Clears the bar.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// The time left, in words; nothing before it is known.
fn left(time: Option<Duration>) -> String {
    time.map_or(String::new(), |time| {
        format!("  {:#} left", HumanDuration(time))
    })
}

fn line(state: &RunState) -> String {
    format!(
        "step {}  t = {}  dt = {} ({})",
        state.step,
        seconds(state.time),
        seconds(state.last_dt),
        state.last_reason.name()
    )
}

/// The terminal of the user. mpirun gives its ranks pipes in place of its own error
/// stream, so the bar goes straight to where that leads.
fn terminal() -> Option<ProgressDrawTarget> {
    if std::io::stderr().is_terminal() {
        return Some(ProgressDrawTarget::stderr_with_hz(DRAWS));
    }
    std::env::var_os("OMPI_COMM_WORLD_RANK")?;
    let path = format!("/proc/{}/fd/2", parent_id());
    let open = || File::options().read(true).write(true).open(&path).ok();
    let (input, output) = (open()?, open()?);
    output
        .is_terminal()
        .then(|| ProgressDrawTarget::term(Term::read_write_pair(input, output), DRAWS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::step::Reason;

    fn state(step: u64, time: f64) -> RunState {
        RunState {
            step,
            time,
            last_dt: 1.5e-9,
            last_reason: Reason::Force,
            ..RunState::default()
        }
    }

    fn progress(prints: bool) -> Progress {
        let control = RunControl {
            end_time: 2e-7,
            max_steps: Some(100),
        };
        Progress::new(prints, &control, Some(1e-9))
    }

    #[test]
    fn a_line_comes_every_ten_seconds_from_rank_0() {
        for prints in [true, false] {
            let mut progress = progress(prints);
            assert_eq!(progress.show(&state(1, 0.0)), None);
            progress.last = Instant::now().checked_sub(LINE_EVERY).unwrap();
            progress.begun = None;
            let line = progress.show(&state(7, 1e-8));
            let expected = "step 7  t = 10 ns  dt = 1.5 ns (force)";
            assert_eq!(line.as_deref(), prints.then_some(expected));
            assert_eq!(progress.show(&state(8, 2e-8)), None);
        }
    }

    #[test]
    fn no_time_is_told_before_it_is_known() {
        let mut progress = progress(false);
        assert_eq!(left(progress.left(&state(4, 0.0))), "");
        assert_eq!(left(Some(Duration::from_secs(30))), "  30s left");
    }

    /// Steps of the start are taken to be as long as predicted; later ones predict themselves.
    #[test]
    fn the_time_that_is_left_is_told_from_the_second_step_on() {
        let mut progress = progress(false);
        progress.control.max_steps = None;
        let begun = Instant::now().checked_sub(Duration::from_secs(20)).unwrap();
        progress.begun = Some((begun, 0, 0.0));
        let mut left = |state| progress.left(&state).unwrap().as_secs_f64();
        // 200 steps of 1 ns, ten in 20 s.
        assert!((left(state(10, 1e-9)) - 398.0).abs() < 5.0);
        // 5 ns each so far: 20 of 40 are left.
        assert!((left(state(20, 1e-7)) - 20.0).abs() < 1.0);
        progress.control.max_steps = Some(25);
        let left = progress.left(&state(20, 1e-7)).unwrap().as_secs_f64();
        assert!((left - 5.0).abs() < 1.0);
    }

    #[test]
    fn a_run_ends_by_time_or_by_steps() {
        let progress = progress(false);
        assert_eq!(progress.ticks(&state(10, 1e-7)), TICKS / 2);
        assert_eq!(progress.ticks(&state(90, 1e-7)), TICKS * 9 / 10);
        assert_eq!(progress.ticks(&state(100, 3e-7)), TICKS);
    }
}
