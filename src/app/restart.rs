//! `whipple restart`: go on from a checkpoint, on any number of ranks.

use std::path::{Path, PathBuf};

use super::driver::{Driver, fail};
use super::launch::{Launch, complain, with_ranks};
use super::report::seconds;
use super::run::CommonArgs;
use super::say::say;
use crate::comm::Comm;
use crate::input;
use crate::model::Case;
use crate::output::checkpoint::{self, MANIFEST, Restored};
use crate::output::{OutputError, Phase, RunFolder, on_root, snapshot};
use crate::particles::ParticleStore;
use crate::step::{Reason, RunState, Simulation};

/// Go on from a checkpoint, on any number of ranks
///
/// Results go on as if there had been no stop, to the last bit. What the run had written after the
/// checkpoint is dropped and written anew. Exit codes are those of `run`; with nothing left to do,
/// it says so and exits with 0.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  mpirun -n 4 whipple restart runs/quarter-impact
  mpirun -n 4 whipple restart runs/quarter-impact --set run.end_time=0.3us
  mpirun -n 4 whipple restart runs/fine/checkpoints/step-00000100 --out runs/branch")]
pub struct RestartArgs {
    /// Run folder (its newest whole checkpoint is taken), or one checkpoint's folder
    #[arg(value_name = "RUN_OR_CHECKPOINT")]
    from: PathBuf,

    /// Folder of the results [default: the run's own]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Change a value of `run`, `output`, `domain` or `trouble`, as in `run.end_time=0.3us`; may be
    /// given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    set: Vec<String>,

    #[command(flatten)]
    common: CommonArgs,

    /// Replace an earlier run in the folder that --out names
    #[arg(short, long)]
    force: bool,
}

/// Runs the command; returns the exit code.
pub fn run(args: &RestartArgs) -> u8 {
    with_ranks(|launch| {
        let comm = launch.comm;
        if let Err(error) = input::output_and_run_only(&args.set) {
            return complain(comm, &error.to_string());
        }
        let found = find(comm, &args.from).and_then(|found| {
            // The store of particles has work for them as soon as a checkpoint is read.
            launch.start_threads(&args.common);
            read(comm, &args.from, found)
        });
        match found {
            Ok(found) => resume(launch, args, found),
            Err(error) => complain(comm, &format!("error: {error}")),
        }
    })
}

/// A checkpoint that could be read, and why newer ones could not.
struct Found {
    checkpoint: PathBuf,
    store: ParticleStore,
    restored: Restored,
    passed_over: Vec<String>,
}

/// The checkpoints that the user may mean, newest first, found by rank 0 for all.
fn find(comm: &Comm, from: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let mut found = Vec::new();
    on_root(comm, || {
        let paths = if RunFolder::is_run(from) {
            RunFolder::at(from).checkpoint_folders()?
        } else if from.join(MANIFEST).is_file() {
            vec![from.to_owned()]
        } else {
            std::fs::metadata(from).map_err(OutputError::io("restart", from))?;
            return Err(OutputError::OutsideRun {
                path: from.to_owned(),
            });
        };
        let names: Vec<_> = paths.iter().map(|path| path.to_string_lossy()).collect();
        found = names.join("\0").into_bytes();
        Ok(())
    })?;
    comm.broadcast(&mut found);
    let names = String::from_utf8_lossy(&found).into_owned();
    let names = names.split('\0').filter(|name| !name.is_empty());
    Ok(names.map(PathBuf::from).collect())
}

/// Reads the newest checkpoint that is whole, unless that has another format. Collective.
fn read(comm: &Comm, from: &Path, paths: Vec<PathBuf>) -> Result<Found, OutputError> {
    let mut passed_over = Vec::new();
    if comm.is_root() && RunFolder::is_run(from) {
        let broken = checkpoint::list_broken(&RunFolder::at(from).checkpoints());
        let tell = |path: PathBuf| format!("{} has no {MANIFEST}", path.display());
        passed_over.extend(broken.unwrap_or_default().into_iter().map(tell));
    }
    for checkpoint in paths {
        let mut store = ParticleStore::default();
        match checkpoint::read(comm, &checkpoint, &mut store) {
            Ok(restored) => {
                return Ok(Found {
                    checkpoint,
                    store,
                    restored,
                    passed_over,
                });
            }
            // One of another program's format is no damage: older ones would undo its work.
            Err(error @ OutputError::Format { .. }) => return Err(error),
            Err(error) if checkpoint == from => return Err(error),
            Err(error) => passed_over.push(error.to_string()),
        }
    }
    Err(OutputError::NoCheckpoint {
        path: from.to_owned(),
        passed_over,
    })
}

fn resume(launch: &Launch, args: &RestartArgs, found: Found) -> u8 {
    let comm = launch.comm;
    let (checkpoint, restored) = (&found.checkpoint, &found.restored);
    let name = format!("{}: the saved input", checkpoint.display());
    let case = match input::parse(&name, &restored.input, &args.set) {
        Ok(case) => case,
        Err(error) => return complain(comm, &error.to_string()),
    };
    if let Err(error) = snapshot::quantities(&case.output.fields) {
        return complain(comm, &format!("error: {error}"));
    }
    if let Some(message) = args.common.shortage(comm, &case) {
        return complain(comm, &message);
    }
    let Ok(state) = serde_json::from_str::<RunState>(&restored.state) else {
        let message = "the saved state is not one that this version of the program can read";
        return complain(comm, &format!("error: {}: {message}", checkpoint.display()));
    };
    let closed = comm.any(comm.is_root() && is_closed(checkpoint));
    if closed && let Some(reason) = nothing_to_do(&case, &state, args.common.until) {
        if comm.is_root() {
            say(&format!(
                "nothing to do: {} is at {reason}",
                checkpoint.display()
            ));
        }
        comm.barrier();
        return 0;
    }
    let folder = match make_folder(comm, args, checkpoint, &case.resolved, restored) {
        Ok(folder) => folder,
        Err(error) => return complain(comm, &format!("error: {error}")),
    };
    go_on(launch, args, case, state, found, &folder)
}

fn go_on(
    launch: &Launch,
    args: &RestartArgs,
    case: Case,
    state: RunState,
    found: Found,
    folder: &RunFolder,
) -> u8 {
    let comm = launch.comm;
    let (step, time) = (state.step, state.time);
    let passed = found.passed_over.iter();
    let mut warnings: Vec<String> = passed.map(|why| format!("passed over: {why}")).collect();
    if state.last_reason == Reason::End {
        warnings.push(format!(
            "step {step} was shortened to end at {}, so that a run with the later end from its \
             start would differ in the last digits",
            seconds(time)
        ));
    }
    let simulation = match Simulation::resume(case, comm, state, found.store) {
        Ok(simulation) => simulation,
        Err(error) => return fail(comm, folder, &error.to_string(), step, time),
    };
    match Driver::begin(
        launch,
        &args.common,
        simulation,
        folder,
        Some(&found.checkpoint),
        &warnings,
    ) {
        Ok(driver) => driver.run(comm),
        Err(error) => fail(comm, folder, &error.to_string(), step, time),
    }
}

/// Whether the run of a checkpoint was left in good order, with its summary and status.
fn is_closed(checkpoint: &Path) -> bool {
    let status = RunFolder::of_checkpoint(checkpoint).and_then(|run| run.status().ok());
    status.is_some_and(|status| matches!(status.state, Phase::Finished | Phase::Stopped))
}

/// Where a run stands that has no step left to do.
fn nothing_to_do(case: &Case, state: &RunState, until: Option<f64>) -> Option<String> {
    let (step, time) = (state.step, state.time);
    let (control, now) = (&case.run, seconds(time));
    if time >= control.end_time {
        let end = seconds(control.end_time);
        Some(format!(
            "{now} and the case ends at {end}; --set run.end_time=TIME moves the end"
        ))
    } else if control.max_steps.is_some_and(|most| step >= most) {
        Some(format!(
            "step {step}, the last of run.max_steps; --set run.max_steps=N allows more"
        ))
    } else if until.is_some_and(|until| time >= until) {
        Some(format!("{now}, not before the time of --until"))
    } else {
        None
    }
}

/// The folder that the run goes on in: its own, or a new one.
fn make_folder(
    comm: &Comm,
    args: &RestartArgs,
    checkpoint: &Path,
    resolved: &str,
    restored: &Restored,
) -> Result<RunFolder, OutputError> {
    let own = RunFolder::of_checkpoint(checkpoint);
    let place = own.as_ref().and_then(|run| run.path().canonicalize().ok());
    let other = |out: &&PathBuf| place.is_none() || out.canonicalize().ok() != place;
    match (args.out.as_ref().filter(other), own) {
        (Some(out), _) => RunFolder::create(comm, out, resolved, args.force),
        (None, Some(run)) => {
            RunFolder::resume(comm, run.path(), resolved, restored.step, restored.time)
        }
        (None, None) => Err(OutputError::OutsideRun {
            path: checkpoint.to_owned(),
        }),
    }
}
