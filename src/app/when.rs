//! `whipple when`: the first step at which a condition holds.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::plot;
use super::replay::{Part, RankArgs, default_folder};
use desk::sweep::{Condition, Row, rows_of};
use files::output::{OutputError, RunFolder, from_root};
use files::run::exit::{EXIT_FAILED, EXIT_INPUT};
use files::run::launch::{Launch, same_options, warn, with_ranks};
use files::run::say::{say, seconds};

/// Find the first step at which a condition holds, and draw it
///
/// The tables of the run tell between which rows the condition begins to hold. That part alone is
/// computed again, with rows at each step, and must agree with the run to the last bit. The
/// snapshot of the step found is in the folder `step` of the results.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple when \"failed wall\" runs/shield
  whipple when \"measures.wall.hole_diameter>0\" runs/shield
  mpirun -n 4 whipple when \"history.interpenetrated>0\" runs/impact

A condition compares an answer, as those of `whipple sweep --bisect` do: TABLE.COLUMN, or TABLE.NAME.COLUMN of
tables with several rows of a time; or it is `failed` or `failed PLATE`.

Exit codes: 0 it is found; 1 it holds at no row, or the part is not the run's;
2 wrong input; 75 stopped softly.")]
pub struct WhenArgs {
    /// The condition
    #[arg(value_name = "CONDITION")]
    condition: String,

    /// Run folder
    #[arg(value_name = "RUN")]
    run: PathBuf,

    /// Folder of the results [default: replays/NAME-when, after the run's folder]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace an earlier run in the folder of the results
    #[arg(short, long)]
    force: bool,

    #[command(flatten)]
    ranks: RankArgs,
}

/// Legs in which the part is computed where the condition begins to hold.
const LEGS: u32 = 8;

/// Where a condition begins to hold.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
enum Begins {
    /// At no row.
    Never,
    /// At the first row.
    Always,
    /// Between two times (s).
    Between([f64; 2]),
}

/// Runs the command; returns the exit code.
pub fn run(args: &WhenArgs) -> u8 {
    args.ranks.until(None).verbosity().begin();
    with_ranks(|launch| {
        let comm = launch.comm;
        if let Err(error) = same_options(comm, args) {
            return warn(comm, &format!("error: {error}"));
        }
        let condition = match Condition::parse(&args.condition) {
            Ok(condition) => condition,
            Err(message) => return warn(comm, &format!("error: {message}")),
        };
        match find(launch, args, &condition) {
            Ok(code) => code,
            Err(error) => warn(comm, &format!("error: {error}")),
        }
    })
}

/// Finds the step in the run, then in the part that is computed again, and shows it; returns the exit code. Collective.
fn find(launch: &Launch, args: &WhenArgs, condition: &Condition) -> Result<u8, OutputError> {
    let comm = launch.comm;
    let tell = |text: &str| {
        if comm.is_root() {
            say(text);
        }
        comm.barrier();
    };
    let text = &args.condition;
    let [before, after] = match from_root(comm, || begins(&args.run, condition))? {
        Begins::Between(times) => times,
        Begins::Always => {
            tell(&format!("`{text}` holds from the first row on"));
            return Ok(0);
        }
        Begins::Never => {
            tell(&format!(
                "`{text}` holds at no row of {}",
                args.run.display()
            ));
            return Ok(EXIT_FAILED);
        }
    };
    let out = args.out.clone();
    let out = out.unwrap_or_else(|| default_folder("replays", &args.run, "-when"));
    let each_step = [
        "output.history_every=1".to_owned(),
        // Due at each step.
        "measure.every=1e-30 s".to_owned(),
    ];
    let part = Part {
        run: &args.run,
        from: before,
        to: Some(after),
        out: &out,
        set: &each_step,
        ranks: &args.ranks,
        force: args.force,
    };
    // In legs, the last of which is that in which it begins to hold.
    let mut found = None;
    for leg in 1..=LEGS {
        let to = Some(before + (after - before) * f64::from(leg) / f64::from(LEGS));
        let to = if leg == LEGS { Some(after) } else { to };
        let code = match leg {
            1 => Part { to, ..part }.compute(launch),
            _ => part.further(launch, to),
        };
        if code != 0 {
            return Ok(code);
        }
        if let Begins::Between(times) = from_root(comm, || begins(&out, condition))? {
            found = Some(times);
            break;
        }
    }
    let code = part.verify(comm);
    if code != 0 {
        return Ok(code);
    }
    let Some([last, first]) = found else {
        tell(&format!(
            "`{text}` holds at no step between {} and {}, but for the row of the run: a table that has no row at each \
             step tells it",
            seconds(before),
            seconds(after)
        ));
        return Ok(EXIT_FAILED);
    };
    // What stops at the step has a snapshot of it.
    let is_last = from_root(comm, || Ok(RunFolder::at(&out).status()?.time <= first))?;
    let folder = if is_last {
        out.clone()
    } else {
        out.join("step")
    };
    if !is_last {
        let step = Part {
            run: &out,
            from: first,
            to: Some(first),
            out: &folder,
            set: &[],
            ..part
        };
        let code = step.compute(launch);
        if code != 0 {
            return Ok(code);
        }
    }
    let drawn = from_root(comm, || show(args, &out, &folder, [last, first]))?;
    comm.barrier();
    Ok(if drawn { 0 } else { EXIT_INPUT })
}

/// Where a condition begins to hold, by the rows of a run.
fn begins(run: &Path, condition: &Condition) -> Result<Begins, OutputError> {
    let rows = rows_of(&RunFolder::at(run), condition.table())?;
    // What cannot be told yet, such as the verdict on a plate that moves, does not hold.
    let holds = |row: &Row| condition.holds(&row.answers).unwrap_or(false);
    if let Some(Row { answers, .. }) = rows.first()
        && !rows.iter().any(holds)
        && let Err(message) = condition.holds(answers)
        && condition.is_unknown(answers)
    {
        return Err(OutputError::OtherRank(message));
    }
    Ok(match rows.iter().position(holds) {
        None => Begins::Never,
        Some(0) => Begins::Always,
        Some(k) => Begins::Between([rows[k - 1].time, rows[k].time]),
    })
}

/// Tells the step and the rows before it, and draws it; returns true if it could be drawn.
fn show(
    args: &WhenArgs,
    out: &Path,
    folder: &Path,
    [last, first]: [f64; 2],
) -> Result<bool, OutputError> {
    let (of_run, of_step) = (RunFolder::at(&args.run), RunFolder::at(folder));
    let (all, step) = (of_run.status()?.step, of_step.status()?.step);
    say(&format!(
        "`{}` holds from step {step} on, at {}; the step before, at {}, it does not (the run has {all} steps)",
        args.condition,
        seconds(first),
        seconds(last)
    ));
    let picture = folder.join("picture.png");
    let words = [
        folder.as_os_str().to_owned(),
        "--out".into(),
        picture.clone().into_os_string(),
    ];
    let drawn = plot::by_words(words);
    match drawn {
        Ok(()) => say(&format!(
            "rows of each step in {}, the snapshot and {} in {}",
            out.display(),
            picture.file_name().unwrap_or_default().display(),
            folder.display()
        )),
        Err(ref message) => files::run::say::warn(&format!("error: {message}")),
    }
    Ok(drawn.is_ok())
}
