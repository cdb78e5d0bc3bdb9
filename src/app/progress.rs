//! How far a run is: a bar on a terminal, now and then a line elsewhere.

use std::fs::File;
use std::io::{IsTerminal, Write};
use std::os::unix::process::parent_id;
use std::time::{Duration, Instant};

use console::Term;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::report::seconds;
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
            let style = "{bar:30} {percent:>3} %  {msg}  {eta} left";
            let style = ProgressStyle::with_template(style);
            ProgressBar::with_draw_target(Some(TICKS), target)
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
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
            bar.set_position(self.ticks(state));
            bar.set_message(format!("step {}, {}", state.step, seconds(state.time)));
        }
        if !self.tells || self.last.elapsed() < LINE_EVERY {
            return None;
        }
        self.last = Instant::now();
        let line = line(state);
        if self.bar.is_none() {
            println!("{line}");
            let _ = std::io::stdout().flush();
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

    /// Clears the bar.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn line(state: &RunState) -> String {
    format!(
        "step {}  t = {}  dt = {:.3e} s ({})",
        state.step,
        seconds(state.time),
        state.last_dt,
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
