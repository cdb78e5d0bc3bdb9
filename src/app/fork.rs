//! `whipple fork`: a run with other constants of failure, from where they begin to matter.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::replay::RankArgs;
use super::{restart, run};
use comm::Comm;
use files::input;
use files::output::checkpoint;
use files::output::{OutputError, RunFolder, from_root};
use files::run::launch::{Launch, same_options, warn, with_ranks};
use files::run::say::{say, seconds};
use particles::ParticleStore;

/// Run a case again with other constants of failure, from where they begin to matter
///
/// Constants of failure change nothing before matter of their material is damaged. So the new run takes
/// over what the earlier one had written up to its newest checkpoint at which that matter is whole, and
/// goes on from there. It is the run from the start with these constants, to the last bit. Where the earlier
/// run has no such checkpoint, the case begins anew.
///
/// A limit of tension can be raised, since a lower one may have been reached. Flaws of Grady and Kipp and cracks
/// along directions have had effects before there is damage: such cases begin anew with `whipple run`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple fork runs/shield --set material.wall.failure.spall.pressure=\"-1.6 GPa\" --out runs/strong
  mpirun -n 4 whipple fork runs/shield --set material.wall.failure.johnson_cook.d1=0.2

`whipple sweep` forks by itself.

Exit codes are those of `run`.")]
pub struct ForkArgs {
    /// Run folder
    #[arg(value_name = "RUN")]
    run: PathBuf,

    /// Change a constant of failure, or what a restart may change, as in
    /// material.wall.failure.spall.pressure=-1.6GPa; may be given many times
    #[arg(short, long, value_name = "KEY=VALUE", required = true)]
    set: Vec<String>,

    /// Folder of the results [default: runs/NAME-fork, after the run's folder]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace an earlier run in the folder of the results
    #[arg(short, long)]
    force: bool,

    #[command(flatten)]
    ranks: RankArgs,
}

/// Runs the command; returns the exit code.
pub fn run(args: &ForkArgs) -> u8 {
    args.ranks.until(None).verbosity().begin();
    with_ranks(|launch| {
        let comm = launch.comm;
        if let Err(error) = same_options(comm, args) {
            return warn(comm, &format!("error: {error}"));
        }
        go(launch, args).unwrap_or_else(|message| warn(comm, &message))
    })
}

/// A checkpoint of the run, with its step and time (s).
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Found {
    path: PathBuf,
    step: u64,
    time: f64,
}

fn go(launch: &Launch, args: &ForkArgs) -> Result<u8, String> {
    let comm = launch.comm;
    let told = |error: OutputError| format!("error: {error}");
    let all = from_root(comm, || checkpoints(&args.run)).map_err(told)?;
    let common = args.ranks.until(None);
    // Threads store what is read.
    launch.start_threads(common.threads);
    // Once damaged, matter stays so: newer checkpoints that are whole lie before older ones that are not.
    let (mut end, mut damaged) = (all.len(), 0);
    let mut from = None;
    while damaged < end {
        let middle = usize::midpoint(damaged, end);
        match case_if_whole(comm, &all[middle].path, &args.set)? {
            Some(resolved) => {
                end = middle;
                from = Some((&all[middle], resolved));
            }
            None => damaged = middle + 1,
        }
    }
    let out = args.out.clone().unwrap_or_else(|| {
        let mut name = args.run.file_name().unwrap_or_default().to_owned();
        name.push("-fork");
        Path::new("runs").join(name)
    });
    if comm.is_root() {
        match &from {
            Some((from, _)) => say(&format!(
                "goes on from step {} of {}, at {}: nothing that is changed has mattered before",
                from.step,
                args.run.display(),
                seconds(from.time)
            )),
            None => say(&format!(
                "begins anew: what is changed matters before the first checkpoint of {}",
                args.run.display()
            )),
        }
    }
    comm.barrier();
    let Some((from, resolved)) = from else {
        let args = run::RunArgs {
            case: RunFolder::at(&args.run).case(),
            out: Some(out),
            set: args.set.clone(),
            common,
            force: args.force,
        };
        return Ok(run::go(launch, &args));
    };
    {
        let mut folder = RunFolder::at(&out);
        folder.take_new(comm, args.force, false).map_err(told)?;
        let adopted = from_root(comm, || {
            folder.adopt(&RunFolder::at(&args.run), &from.path, &resolved)
        });
        adopted.map_err(told)?;
    }
    let again = restart::RestartArgs {
        from: out,
        out: None,
        set: args.set.clone(),
        accept_case: false,
        strict: false,
        common,
        force: false,
    };
    Ok(restart::with_any_keys(launch, &again))
}

/// The checkpoints of a run, newest first.
fn checkpoints(run: &Path) -> Result<Vec<Found>, OutputError> {
    if !RunFolder::is_run(run) {
        let path = run.to_owned();
        return Err(OutputError::OutsideRun { path });
    }
    let all = RunFolder::at(run).checkpoint_folders()?.into_iter();
    let read = all.map(|path| {
        let manifest = checkpoint::manifest(&path)?;
        let (step, time) = (manifest.step, manifest.time);
        Ok(Found { path, step, time })
    });
    read.collect()
}

/// The resolved input with the changes, if nothing that is changed has mattered up to a checkpoint. One whose file is damaged tells nothing
/// of that. Collective.
///
/// # Errors
/// The whole message, if a key is changed that matters at once.
fn case_if_whole(comm: &Comm, path: &Path, set: &[String]) -> Result<Option<String>, String> {
    let mut particles = ParticleStore::default();
    let restored = match checkpoint::read(comm, path, &mut particles) {
        Ok(restored) => restored,
        Err(error) if error.is_damage() => return Ok(None),
        Err(error) => return Err(format!("error: {error}")),
    };
    let name = format!("{}: the saved input", path.display());
    let parse =
        |set: &[String]| input::parse(&name, &restored.input, set).map_err(|e| e.to_string());
    let (own, other) = (parse(&[])?, parse(set)?);
    let apart = input::apart_once_damaged(&own, &other).map_err(|key| {
        format!(
            "error: {key} may matter from the start\n  help: a fork changes constants of failure that damage alone brings in, \
             and raises limits of tension: run the case anew"
        )
    })?;
    let is_of = |i: usize| apart.contains(&own.bodies[particles.body[i] as usize].material);
    let is_damaged = |i: usize| {
        let of = |field: &[f64]| field.get(i).is_some_and(|damage| *damage != 0.0);
        of(&particles.damage) || of(&particles.failure_onset)
    };
    let any = (0..particles.owned()).any(|i| is_damaged(i) && is_of(i));
    Ok((!comm.any(any)).then_some(other.resolved))
}
