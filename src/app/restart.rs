//! `whipple restart`: go on from a checkpoint, on any number of ranks.

use std::path::{Path, PathBuf};

use super::driver::{self, Driver, Options};
use super::run::{CommonArgs, complain, with_ranks};
use crate::comm::Comm;
use crate::input;
use crate::output::checkpoint::{self, Restored};
use crate::output::{OutputError, RunFolder, on_root};
use crate::particles::ParticleStore;
use crate::step::{RunState, Simulation};

/// Go on from a checkpoint, on any number of ranks
///
/// Results go on as if there had been no stop, to the last bit.
#[derive(Debug, clap::Args)]
pub struct RestartArgs {
    /// Run folder (its newest checkpoint is taken), or one checkpoint's folder
    #[arg(value_name = "RUN_OR_CHECKPOINT")]
    from: PathBuf,

    /// Folder of the results [default: the run's own]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Change a value of run, output or domain, as in run.end_time=0.3us
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
    with_ranks(&args.common, |comm, options| {
        if let Err(error) = input::output_and_run_only(&args.set) {
            return complain(comm, &error.to_string());
        }
        match find(comm, &args.from) {
            Ok(checkpoint) => resume(comm, args, &checkpoint, options),
            Err(error) => complain(comm, &format!("error: {error}")),
        }
    })
}

/// The checkpoint that the user means, found by rank 0 for all.
fn find(comm: &Comm, from: &Path) -> Result<PathBuf, OutputError> {
    let mut found = Vec::new();
    on_root(comm, || {
        let path = if RunFolder::is_run(from) {
            RunFolder::at(from)
                .newest_checkpoint()?
                .ok_or_else(|| OutputError::NoCheckpoint {
                    path: from.to_owned(),
                })?
        } else {
            from.to_owned()
        };
        found = path.to_string_lossy().into_owned().into_bytes();
        Ok(())
    })?;
    comm.broadcast(&mut found);
    Ok(PathBuf::from(String::from_utf8_lossy(&found).into_owned()))
}

fn resume(comm: &Comm, args: &RestartArgs, checkpoint: &Path, options: &Options) -> u8 {
    let mut store = ParticleStore::default();
    let restored = match checkpoint::read(comm, checkpoint, &mut store) {
        Ok(restored) => restored,
        Err(error) => return complain(comm, &format!("error: {error}")),
    };
    let name = format!("{}: the saved input", checkpoint.display());
    let case = match input::parse(&name, &restored.input, &args.set) {
        Ok(case) => case,
        Err(error) => return complain(comm, &error.to_string()),
    };
    let Ok(state) = serde_json::from_str::<RunState>(&restored.state) else {
        let message = "the saved state is not one that this version of the program can read";
        return complain(comm, &format!("error: {}: {message}", checkpoint.display()));
    };
    let folder = match make_folder(comm, args, checkpoint, &case.resolved, &restored) {
        Ok(folder) => folder,
        Err(error) => return complain(comm, &format!("error: {error}")),
    };
    let simulation = match Simulation::resume(case, comm, state, store) {
        Ok(simulation) => simulation,
        Err(error) => return driver::fail(comm, &folder, &error.to_string()),
    };
    match Driver::begin(comm, simulation, &folder, options, Some(checkpoint)) {
        Ok(driver) => driver.run(comm),
        Err(error) => driver::fail(comm, &folder, &error.to_string()),
    }
}

fn make_folder(
    comm: &Comm,
    args: &RestartArgs,
    checkpoint: &Path,
    resolved: &str,
    restored: &Restored,
) -> Result<RunFolder, OutputError> {
    match (&args.out, RunFolder::of_checkpoint(checkpoint)) {
        (Some(out), _) => RunFolder::create(comm, out, resolved, args.force),
        (None, Some(run)) => {
            RunFolder::resume(comm, run.path(), resolved, restored.step, restored.time)
        }
        (None, None) => Err(OutputError::OutsideRun {
            path: checkpoint.to_owned(),
        }),
    }
}
