//! `whipple restart`: go on from a checkpoint, on any number of ranks.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use comm::Comm;
use engine::step::RunState;
use files::input;
use files::output::checkpoint::{self, MANIFEST, Restored};
use files::output::{OutputError, Phase, RunFolder, from_root, snapshot};
use files::run::CommonArgs;
use files::run::launch::{Launch, same_options, warn, with_ranks};
use files::run::resume::{Origin, go_on, nothing_to_do, state_of};
use files::run::saved_case;
use files::run::say::say;
use particles::ParticleStore;

/// Go on from a checkpoint, on any number of ranks
///
/// Results go on as if there had been no stop, to the last bit. What the run had written after the
/// checkpoint is written anew; it is set aside until there is a new checkpoint. Exit codes are
/// those of `run`; with nothing left to do, it says so and exits with 0.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  mpirun -n 4 whipple restart runs/quarter-impact
  mpirun -n 4 whipple restart runs/quarter-impact --set run.end_time=0.3us
  mpirun -n 4 whipple restart runs/fine/checkpoints/step-00000100 \\
      --out runs/branch")]
pub struct RestartArgs {
    /// Run folder (its newest whole checkpoint is taken), or one checkpoint's folder
    #[arg(value_name = "RUN_OR_CHECKPOINT")]
    pub(super) from: PathBuf,

    /// Folder of the results [default: the run's own]
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,

    /// Change a value of `run`, `output`, `domain` or `numerical_limits`, as in `run.end_time=0.3us`; may be
    /// given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,

    /// Go on with the run's case.toml where it was edited, in `run`, `output`, `domain` or
    /// `numerical_limits`
    #[arg(long)]
    pub(super) accept_case: bool,

    /// Refuse to go on if results that the checkpoint stands on are lost or changed
    #[arg(long)]
    pub(super) strict: bool,

    #[command(flatten)]
    pub(super) common: CommonArgs,

    /// Replace an earlier run in the folder that --out names
    #[arg(short, long)]
    pub(super) force: bool,
}

/// Runs the command; returns the exit code.
pub fn run(args: &RestartArgs) -> u8 {
    args.common.verbosity().begin();
    with_ranks(|launch| go(launch, args))
}

/// Goes on on ranks that have started; returns the exit code. Collective.
pub(super) fn go(launch: &Launch, args: &RestartArgs) -> u8 {
    if let Err(error) = input::output_and_run_only(&args.set) {
        return warn(launch.comm, &error.to_string());
    }
    with_any_keys(launch, args)
}

/// The same with keys that have had no effect so far; returns the exit code. Collective.
pub(super) fn with_any_keys(launch: &Launch, args: &RestartArgs) -> u8 {
    let comm = launch.comm;
    if let Err(error) = same_options(comm, args) {
        return warn(comm, &format!("error: {error}"));
    }
    let refused = |error: OutputError| warn(comm, &format!("error: {error}"));
    let mut named = match locate(comm, args) {
        Ok(named) => named,
        Err(error) => return refused(error),
    };
    // Held to the end: nobody else may change what is read.
    let warnings = match named.take(comm, args) {
        Ok(warnings) => warnings,
        Err(error) => return refused(error),
    };
    let listed = find(comm, &named).map_err(|error| refusal(&error));
    let loaded = listed.and_then(|(paths, passed_over)| {
        // The store of particles has work for them as soon as a checkpoint is read.
        launch.start_threads(args.common.threads);
        read(comm, &args.from, named, paths, passed_over)
    });
    let ended = loaded.and_then(|loaded| resume(launch, args, loaded, warnings));
    ended.unwrap_or_else(|message| warn(comm, &message))
}

/// The paths that the command line names.
struct Named {
    /// One checkpoint, instead of the newest of the run.
    checkpoint: Option<PathBuf>,
    /// The run that has the checkpoint, if any.
    run: Option<RunFolder>,
    /// The folder in which the run goes on: that one or another.
    folder: RunFolder,
    own: bool,
}

/// The paths that the command line names, as rank 0 sees them. Collective.
fn locate(comm: &Comm, args: &RestartArgs) -> Result<Named, OutputError> {
    let from = &args.from;
    let outside = || OutputError::OutsideRun { path: from.clone() };
    let (run, own) = from_root(comm, || {
        let run = if RunFolder::is_run(from) {
            Some(RunFolder::at(from))
        } else if from.join(MANIFEST).is_file() {
            RunFolder::of_checkpoint(from)
        } else {
            std::fs::metadata(from).map_err(OutputError::io("restart", from))?;
            return Err(outside());
        };
        let canonical = |path: &Path| path.canonicalize().ok();
        let run = run.map(|run| run.path().as_os_str().to_owned());
        let own = run.as_ref().map(|run| {
            let mut out = args.out.iter();
            out.all(|out| canonical(out).is_some_and(|out| canonical(Path::new(run)) == Some(out)))
        });
        Ok((run, own.unwrap_or(false)))
    })?;
    let run = run.map(|path| RunFolder::at(Path::new(&path)));
    let folder = match (&run, &args.out) {
        (Some(run), _) if own => run.clone(),
        (_, Some(out)) => RunFolder::at(out),
        _ => return Err(outside()),
    };
    let whole = run.as_ref().is_some_and(|run| run.path() == from);
    Ok(Named {
        checkpoint: (!whole).then(|| from.clone()),
        run,
        folder,
        own,
    })
}

impl Named {
    /// Takes the folder of the results. Collective.
    fn take(&mut self, comm: &Comm, args: &RestartArgs) -> Result<Vec<String>, OutputError> {
        let ignore = args.common.ignore_lock;
        if self.own {
            self.folder.take(comm, ignore)
        } else {
            self.folder.take_new(comm, args.force, ignore)
        }
    }
}

/// A checkpoint that is none, and why.
#[derive(serde::Serialize, serde::Deserialize)]
struct PassedOver {
    path: OsString,
    why: String,
}

/// The checkpoints that the user may mean, newest first, and those that lack a manifest, as rank 0
/// sees them.
fn find(comm: &Comm, named: &Named) -> Result<(Vec<OsString>, Vec<PassedOver>), OutputError> {
    from_root(comm, || {
        if let Some(checkpoint) = &named.checkpoint {
            return Ok((vec![checkpoint.clone().into()], Vec::new()));
        }
        let Some(run) = &named.run else {
            return Ok((Vec::new(), Vec::new()));
        };
        let all = run.checkpoint_folders()?;
        let broken = checkpoint::list_broken(&run.checkpoints())?;
        let passed_over = |path: PathBuf| PassedOver {
            why: format!("{} has no {MANIFEST}", path.display()),
            path: path.into(),
        };
        let all = all.into_iter().map(OsString::from).collect();
        Ok((all, broken.into_iter().map(passed_over).collect()))
    })
}

/// A checkpoint that could be read, where it goes on, and why newer ones were passed over.
struct LoadedCheckpoint {
    named: Named,
    checkpoint: PathBuf,
    particles: ParticleStore,
    restored: Restored,
    passed_over: Vec<PassedOver>,
}

/// Reads the newest checkpoint that is whole. Damaged ones are passed over; one that cannot be read
/// now, or that another version wrote, is no reason to undo its work from an older one. Collective.
///
/// # Errors
/// The whole message.
fn read(
    comm: &Comm,
    from: &Path,
    named: Named,
    paths: Vec<OsString>,
    mut passed_over: Vec<PassedOver>,
) -> Result<LoadedCheckpoint, String> {
    for path in paths {
        let checkpoint = PathBuf::from(&path);
        let mut particles = ParticleStore::default();
        let error = match checkpoint::read(comm, &checkpoint, &mut particles) {
            Ok(restored) => {
                return Ok(LoadedCheckpoint {
                    named,
                    checkpoint,
                    particles,
                    restored,
                    passed_over,
                });
            }
            Err(error) => error,
        };
        let damaged = comm.any(error.is_damage());
        if !damaged || named.checkpoint.is_some() {
            return Err(refusal(&error));
        }
        let why = error.to_string();
        passed_over.push(PassedOver { path, why });
    }
    let error = OutputError::NoCheckpoint {
        path: from.to_owned(),
        passed_over: passed_over.into_iter().map(|passed| passed.why).collect(),
    };
    Err(format!("error: {error}"))
}

/// The message for an error that ends the command.
fn refusal(error: &OutputError) -> String {
    let explained = error.is_damage() || error.is_other_version();
    let hint = if explained {
        ""
    } else {
        "; nothing is changed: restart when it can be read, or name an older checkpoint"
    };
    format!("error: {error}{hint}")
}

/// Goes on from what was found; gives the exit code, or what is complained of.
fn resume(
    launch: &Launch,
    args: &RestartArgs,
    loaded: LoadedCheckpoint,
    more: Vec<String>,
) -> Result<u8, String> {
    let comm = launch.comm;
    let name = loaded.checkpoint.display().to_string();
    let own = Some(&loaded.named.folder).filter(|_| loaded.named.own);
    let (input, set) = (&loaded.restored.input, &args.set);
    let settled = saved_case::resolve(comm, own, &name, input, set, args.accept_case)?;
    let case = &settled.case;
    snapshot::quantities(&case.output.fields).map_err(|error| format!("error: {error}"))?;
    if let Some(message) = args.common.shortage(comm, case) {
        return Err(message);
    }
    let state = loaded.state()?;
    let closed = comm.any(comm.is_root() && is_closed(&loaded.checkpoint));
    if closed && let Some(reason) = nothing_to_do(case, &state, args.common.until) {
        if comm.is_root() {
            say(&format!("nothing to do: {name} is at {reason}"));
        }
        comm.barrier();
        return Ok(0);
    }
    let mut warnings = settled.warnings.clone();
    let mut stop = false;
    if let Some(own) = own {
        let known = from_root(comm, || {
            let results = checkpoint::manifest(&loaded.checkpoint)?.results;
            Ok((own.losses(&results), results.ends_in_stop(own, state.step)))
        });
        let losses;
        (losses, stop) = known.map_err(|error| format!("error: {error}"))?;
        if args.strict && !losses.is_empty() {
            return Err(format!(
                "error: {}: {}",
                own.path().display(),
                losses.join("; ")
            ));
        }
        let told = |loss| format!("{}: {loss}", own.path().display());
        warnings.extend(losses.into_iter().map(told));
    }
    warnings.extend(more);
    warnings.extend(loaded.warnings());
    let passed = loaded
        .passed_over
        .iter()
        .map(|passed| (&passed.path).into());
    let origin = Origin {
        passed_over: passed.collect(),
        stop,
        checkpoint: loaded.checkpoint,
        particles: loaded.particles,
        folder: loaded.named.folder,
        own: loaded.named.own,
    };
    let (common, force) = (&args.common, args.force);
    Ok(go_on(
        launch, common, settled, state, origin, force, warnings,
    ))
}

impl LoadedCheckpoint {
    /// The state of the run.
    fn state(&self) -> Result<RunState, String> {
        state_of(&self.restored).map_err(|error| {
            let error = OutputError::OtherVersion {
                path: self.checkpoint.clone(),
                by: self.restored.by.clone(),
                what: format!("its saved state cannot be read ({error})"),
            };
            format!("error: {error}")
        })
    }

    /// The messages on the checkpoints that were passed over.
    fn warnings(&self) -> impl Iterator<Item = String> {
        let fate = if self.named.own {
            "; it is set aside, its name now ends with .damaged"
        } else {
            ""
        };
        let passed = self.passed_over.iter();
        passed.map(move |passed| format!("passed over: {}{fate}", passed.why))
    }
}

/// `true` if the run of a checkpoint was closed properly, with its summary and status.
fn is_closed(checkpoint: &Path) -> bool {
    let status = RunFolder::of_checkpoint(checkpoint).and_then(|run| run.status().ok());
    status.is_some_and(|status| matches!(status.state, Phase::Finished | Phase::Stopped))
}
