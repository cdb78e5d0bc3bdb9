//! `whipple fork`: a run with other constants of failure, from where they begin to matter.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::replay::{RankArgs, default_folder};
use super::{restart, run};
use comm::Comm;
use files::input;
use files::output::checkpoint;
use files::output::{OutputError, RunFolder, from_root, read_small};
use files::run::launch::{Launch, same_case, same_options, warn, with_ranks};
use files::run::resume::state_of;
use files::run::say::{self, say, seconds};
use model::Case;
use model::readable::one_line;
use particles::ParticleStore;

/// Run a case again with other constants of failure, from where they begin to matter
///
/// Constants of failure change nothing before matter of their material is damaged. So the new run takes
/// over what the earlier one had written up to its newest checkpoint at which that matter is whole, and
/// goes on from there. It is the run from the start with these constants, to the last bit. Where the earlier
/// run has no such checkpoint, the case begins anew.
///
/// A limit of tension at which matter fails at once may become larger: a smaller one may have been reached. The limit
/// of spall of matter that softens, flaws of Grady and Kipp and cracks along directions have had effects before
/// there is damage: take `whipple run`. What a restart may change acts from the checkpoint on.
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
    path: OsString,
    step: u64,
    time: f64,
}

fn go(launch: &Launch, args: &ForkArgs) -> Result<u8, String> {
    let comm = launch.comm;
    let told = |error: OutputError| format!("error: {error}");
    let (all, text) = from_root(comm, || checkpoints(&args.run)).map_err(told)?;
    let common = args.ranks.until(None);
    // Threads store what is read.
    launch.start_threads(common.threads);
    let name = RunFolder::at(&args.run).case().display().to_string();
    Changed::of(comm, &name, &text, &args.set)?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| default_folder("runs", &args.run, "-fork"));
    let canonical = |path: &Path| path.canonicalize().ok();
    let is_own = from_root(comm, || {
        let run = canonical(&args.run);
        Ok(run.is_some() && canonical(&out) == run)
    });
    if is_own.map_err(told)? {
        return Err("error: a fork needs a folder of its own: give another --out".to_owned());
    }
    // Once damaged, matter stays so: in this order damaged checkpoints stand before whole ones.
    let (mut end, mut damaged) = (all.len(), 0);
    let mut from = None;
    while damaged < end {
        let middle = usize::midpoint(damaged, end);
        match case_if_whole(comm, Path::new(&all[middle].path), &args.set)? {
            Some(resolved) => {
                end = middle;
                from = Some((&all[middle], resolved));
            }
            None => damaged = middle + 1,
        }
    }
    let run = args.run.display();
    let text = match &from {
        Some((from, _)) => format!(
            "goes on from step {} of {run}, at {}: nothing that is changed has mattered before",
            from.step,
            seconds(from.time)
        ),
        None => {
            format!("begins anew: {run} has no checkpoint from before what is changed matters")
        }
    };
    if comm.is_root() {
        say(&text);
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
            let missing =
                folder.adopt(&RunFolder::at(&args.run), Path::new(&from.path), &resolved)?;
            if !missing.is_empty() {
                say::warn(&format!(
                    "warning: {run} lacks results from before: {}",
                    one_line(&missing.join(", "))
                ));
            }
            Ok(())
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

/// The checkpoints that a run has written itself, newest first, and the text of its case.
fn checkpoints(run: &Path) -> Result<(Vec<Found>, String), OutputError> {
    if !RunFolder::is_run(run) {
        let path = run.to_owned();
        return Err(OutputError::OutsideRun { path });
    }
    let folder = RunFolder::at(run);
    let case = folder.case();
    let text = String::from_utf8(read_small(&case)?);
    let text = text.map_err(|error| OutputError::damaged(&case, error.to_string()))?;
    // What a fork has taken over has the input of the other run.
    let first = folder.forked()?.map_or(0, |forked| forked.step + 1);
    let found = folder.checkpoint_folders()?.into_iter().filter_map(|path| {
        let manifest = checkpoint::manifest(&path).ok()?;
        let (step, time) = (manifest.step, manifest.time);
        let path = path.into();
        (step >= first).then_some(Found { path, step, time })
    });
    Ok((found.collect(), text))
}

/// A case, the same with changes, and the materials by which they differ.
struct Changed {
    own: Case,
    other: Case,
    apart: Vec<usize>,
}

impl Changed {
    /// Of a text. Collective.
    ///
    /// # Errors
    /// The whole message, if a key is changed that matters at once.
    fn of(comm: &Comm, name: &str, text: &str, set: &[String]) -> Result<Self, String> {
        let parse = |set: &[String]| {
            same_case(comm, input::parse(name, text, set)).map_err(|error| error.to_string())
        };
        let (own, other) = (parse(&[])?, parse(set)?);
        let [a, b] = [&own, &other].map(input::Compared::of);
        let apart = a.apart_once_damaged(&b).map_err(|key| {
            format!(
                "error: {key} may matter from the start\n  help: a fork changes constants of failure that damage alone brings in, \
                 and takes larger limits of tension: run the case anew"
            )
        })?;
        Ok(Self { own, other, apart })
    }
}

/// The resolved input with the changes, if nothing that is changed has mattered up to a checkpoint. One whose file is damaged tells nothing
/// of that. Collective.
///
/// # Errors
/// The whole message, if a key is changed that matters at once.
fn case_if_whole(comm: &Comm, path: &Path, set: &[String]) -> Result<Option<String>, String> {
    let mut particles = ParticleStore::default();
    let read = checkpoint::read(comm, path, &mut particles);
    // All ranks know of an error, one of them what it is.
    let is_damaged = comm.any(read.as_ref().is_err_and(OutputError::is_damage));
    let restored = match read {
        Err(_) if is_damaged => return Ok(None),
        Err(error) => return Err(format!("error: {error}")),
        Ok(restored) => restored,
    };
    let name = format!("{}: the saved input", path.display());
    let Changed { own, other, apart } = Changed::of(comm, &name, &restored.input, set)?;
    let state =
        state_of(&restored).map_err(|error| format!("error: {}: {error}", path.display()))?;
    // The end of a case cuts its last step, and what has left tells nothing of its damage.
    let ends = [own.run.end_time, other.run.end_time];
    let is_cut = ends[0].to_bits() != ends[1].to_bits() && state.time >= ends[0].min(ends[1]);
    if is_cut || !state.removed.is_empty() || !state.departed.is_empty() {
        return Ok(None);
    }
    let is_used = |i: usize| {
        let of = |field: &[f64]| field.get(i).is_some_and(|damage| *damage != 0.0);
        // What is frozen has forgotten its damage.
        let is_damaged = of(&particles.damage)
            || of(&particles.failure_onset)
            || particles.frozen.get(i).is_some_and(|frozen| *frozen != 0);
        let body = own.bodies.get(particles.body[i] as usize);
        is_damaged && body.is_none_or(|body| apart.contains(&body.material))
    };
    let any = (0..particles.owned()).any(is_used);
    Ok((!comm.any(any)).then_some(other.resolved))
}
