//! `whipple watch`: how a run goes on, in a terminal.

mod frame;

use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use console::Term;

use super::results::{running, status_and_presence};
use files::output::{OutputError, Phase, Presence, RunFolder, Status};
use files::run::exit::{EXIT_FAILED, EXIT_INPUT, EXIT_STOPPED};
use files::run::say::{self, warn};
use frame::frame;
use model::readable::one_line;

/// Watch a run: how far it is, its energies, its ranks, the time left
///
/// Reads the run's status.json, which the run writes every few seconds, so it works on any machine that
/// sees the folder. Draws in place until the run ends, and ends with the run's own exit code: 0
/// finished, 1 failed, killed or lost, 75 stopped with a checkpoint; with 2 if there is no run.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple watch runs/impact
  whipple watch runs/impact --once        once; exit code 0 while the run goes on
  ssh cluster whipple watch runs/impact --every 10")]
pub struct WatchArgs {
    /// Run folder
    #[arg(value_name = "RUN")]
    run: PathBuf,

    /// Print once how the run stands, and end
    #[arg(long)]
    once: bool,

    /// Seconds between two looks
    #[arg(long, value_name = "SECONDS", default_value_t = 2)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=3600))]
    every: u32,
}

/// Columns if the terminal does not give any.
const WIDTH: usize = 80;

/// Runs the command; returns the exit code.
pub fn run(args: &WatchArgs) -> u8 {
    let folder = RunFolder::at(&args.run);
    let (mut drawn, mut before) = (0, None);
    loop {
        let seen = match look(&folder) {
            Ok(seen) => seen,
            Err(error) => {
                warn(&format!("error: {error}"));
                return EXIT_INPUT;
            }
        };
        let terminal = std::io::stdout().is_terminal();
        // Into a file or a pipe only what is new goes.
        if terminal || before.as_ref() != Some(&seen.status) {
            let lines = frame(&seen, if terminal { width() } else { WIDTH });
            draw(&lines, if terminal { drawn } else { 0 });
            drawn = lines.len();
        }
        match seen.code {
            Some(code) => return code,
            None if args.once => return 0,
            None => {}
        }
        before = Some(seen.status);
        std::thread::sleep(Duration::from_secs(args.every.into()));
    }
}

/// The state of a run, as read.
struct Seen {
    status: Status,
    /// The state in words.
    state: String,
    /// Seconds since its status was written, if known.
    age: Option<f64>,
    /// Exit code of the run, if it is over.
    code: Option<u8>,
}

/// Looks at a run.
fn look(folder: &RunFolder) -> Result<Seen, OutputError> {
    let (status, presence) = status_and_presence(folder, is_late)?;
    let name = one_line(&folder.path().display().to_string()).into_owned();
    let reason = status.reason.as_deref().unwrap_or_default();
    let reason = if reason.is_empty() {
        String::new()
    } else {
        format!(" ({})", one_line(reason))
    };
    let code = status.exit_code;
    let (state, code) = match status.state {
        Phase::Running => match &presence {
            Some(presence) => {
                let lost = matches!(presence, Presence::Nobody(_));
                (running(presence), lost.then_some(EXIT_FAILED))
            }
            None => ("running".to_owned(), None),
        },
        Phase::Finished => ("finished".to_owned(), Some(code.unwrap_or(0))),
        Phase::Stopped => (
            format!("stopped{reason}"),
            Some(code.unwrap_or(EXIT_STOPPED)),
        ),
        Phase::Failed => (format!("failed{reason}"), Some(code.unwrap_or(EXIT_FAILED))),
    };
    Ok(Seen {
        state: format!("{name}: {state}"),
        age: age(&status),
        status,
        code,
    })
}

/// Seconds since a status was written, if known.
fn age(status: &Status) -> Option<f64> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).ok()?;
    let written = Duration::from_secs(status.outlook.as_ref()?.written);
    now.checked_sub(written).map(|age| age.as_secs_f64())
}

/// `true` if the status of a run is older than that of a sound run would be.
fn is_late(status: &Status) -> bool {
    const PATIENCE: f64 = 5.0;
    let step = status.outlook.as_ref().map_or(0.0, |o| o.seconds_per_step);
    age(status).is_none_or(|age| age > PATIENCE + 3.0 * step)
}

/// Columns of the terminal.
fn width() -> usize {
    usize::from(Term::stdout().size().1).max(20)
}

/// Draws lines over so many that were drawn before.
fn draw(lines: &[String], over: usize) {
    let (back, erase) = match over {
        0 => (String::new(), ""),
        _ => (format!("\x1b[{over}A"), "\x1b[2K"),
    };
    let lines = lines.iter().map(|line| format!("{erase}{line}\n"));
    // If there are fewer than before, the rest is erased.
    let rest = if over > 0 { "\x1b[J" } else { "" };
    let text = format!("{back}{}{rest}", lines.collect::<String>());
    say::print(&text);
}
