//! How far a run is: a bar on a terminal, now and then a line elsewhere.

use std::fmt;
use std::fs::File;
use std::io::IsTerminal;
use std::os::unix::process::parent_id;
use std::time::{Duration, Instant};

use console::Term;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use super::say::{say, seconds, warn};
use crate::model::RunControl;
use crate::step::RunState;

/// Time between two lines.
const LINE_EVERY: Duration = Duration::from_secs(10);
/// Draws a second, at most.
const DRAWS: u8 = 10;
/// Length of the bar in its own units.
const TICKS: u64 = 1000;

/// Progress of a run, told by rank 0.
pub struct Progress {
    tells: bool,
    bar: Option<ProgressBar>,
    control: RunControl,
    last: Instant,
}

impl Progress {
    /// For rank 0 where `tells`; others stay silent.
    pub fn new(tells: bool, control: &RunControl) -> Self {
        let bar = tells.then(terminal).flatten().map(|target| {
            // Within 80 columns: a longer line would wrap and be drawn over and over.
            let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}{left}");
            let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::with_draw_target(Some(TICKS), target).with_style(style.with_key(
                "left",
                |state: &ProgressState, to: &mut dyn fmt::Write| {
                    // Who writes to a line that is drawn anew cannot fail.
                    let _ = to.write_str(&left(state.eta()));
                },
            ))
        });
        Self {
            tells,
            bar,
            control: *control,
            last: Instant::now(),
        }
    }

    /// Shows where the run stands; gives a line for the log now and then.
    pub fn show(&mut self, state: &RunState) -> Option<String> {
        if let Some(bar) = &self.bar {
            bar.set_message(format!("step {}, {}", state.step, seconds(state.time)));
            bar.set_position(self.ticks(state));
        }
        if !self.tells || self.last.elapsed() < LINE_EVERY {
            return None;
        }
        self.last = Instant::now();
        let line = line(state);
        if self.bar.is_none() {
            say(&line);
        }
        Some(line)
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

    /// A warning, above the bar.
    pub fn warn(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| warn(text)),
            None if self.tells => warn(text),
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

/// The time that is left; nothing before the first steps have shown how fast they are.
fn left(eta: Duration) -> String {
    if eta.is_zero() {
        String::new()
    } else {
        format!("  {:#} left", HumanDuration(eta))
    }
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

/// The terminal that the user looks at. mpirun gives its ranks pipes in place of its own error
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
    use crate::step::Reason;

    fn state(step: u64, time: f64) -> RunState {
        RunState {
            step,
            time,
            last_dt: 1.5e-9,
            last_reason: Reason::Force,
            ..RunState::default()
        }
    }

    fn progress(tells: bool) -> Progress {
        let control = RunControl {
            end_time: 2e-7,
            max_steps: Some(100),
        };
        Progress::new(tells, &control)
    }

    #[test]
    fn a_line_comes_every_ten_seconds_from_rank_0() {
        for tells in [true, false] {
            let mut progress = progress(tells);
            assert_eq!(progress.show(&state(1, 0.0)), None);
            progress.last = Instant::now().checked_sub(LINE_EVERY).unwrap();
            let line = progress.show(&state(7, 1e-8));
            let expected = "step 7  t = 10 ns  dt = 1.5 ns (force)";
            assert_eq!(line.as_deref(), tells.then_some(expected));
            assert_eq!(progress.show(&state(8, 2e-8)), None);
        }
    }

    #[test]
    fn no_time_is_told_before_it_is_known() {
        assert_eq!(left(Duration::ZERO), "");
        assert_eq!(left(Duration::from_secs(30)), "  30s left");
    }

    #[test]
    fn a_run_ends_by_time_or_by_steps() {
        let progress = progress(false);
        assert_eq!(progress.ticks(&state(10, 1e-7)), TICKS / 2);
        assert_eq!(progress.ticks(&state(90, 1e-7)), TICKS * 9 / 10);
        assert_eq!(progress.ticks(&state(100, 3e-7)), TICKS);
    }
}
