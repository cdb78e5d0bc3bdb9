//! `whipple run`: a case from its start.

use std::path::{Path, PathBuf};

use comm::Comm;
use files::input;
use files::output::{RunFolder, snapshot};
use files::run::CommonArgs;
use files::run::launch::{Launch, same_case, same_options, warn, with_ranks};
use files::run::start::start;

/// Run a case from its start
///
/// Under mpirun each rank has a slab of the model, and the results are the same bits on any number
/// of ranks and threads. The folder of the results holds tables (history.csv, contacts.csv),
/// snapshots for ParaView, checkpoints, summary.json and status.json.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  mpirun -n 2 whipple run inputs/quarter-impact
  mpirun -n 2 whipple run inputs/quarter-impact --set spacing=0.015mm \\
      --out runs/fine
  mpirun -n 2 whipple run inputs/quarter-impact --walltime 1h --force

To stop a run softly, send SIGUSR1 to mpirun or SIGTERM to a rank, make a file
`stop` in its folder, or give --walltime: it writes a checkpoint and exits with
75, and `whipple restart` goes on. Other exit codes: 0 finished, or --until is
reached; 1 failed; 2 wrong input.")]
pub struct RunArgs {
    /// Case file (TOML), or a folder with a case.toml
    #[arg(value_name = "CASE")]
    pub(super) case: PathBuf,

    /// Folder of the results [default: runs/NAME, after the case's folder or file]
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,

    /// Change a value of the case, as in spacing=0.015mm; may be given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,

    #[command(flatten)]
    pub(super) common: CommonArgs,

    /// Replace an earlier run in the folder of the results
    #[arg(short, long)]
    pub(super) force: bool,
}

/// Runs the command; returns the exit code.
pub fn run(args: &RunArgs) -> u8 {
    args.common.verbosity().begin();
    with_ranks(|launch| go(launch, args))
}

/// Runs a case on ranks that have started; returns the exit code. Collective.
pub(super) fn go(launch: &Launch, args: &RunArgs) -> u8 {
    let comm = launch.comm;
    if let Err(error) = same_options(comm, args) {
        return warn(comm, &format!("error: {error}"));
    }
    let (path, text) = match read_case(comm, &args.case) {
        Ok(read) => read,
        Err(message) => return warn(comm, &message),
    };
    let read = input::parse(&path.display().to_string(), &text, &args.set);
    let case = match same_case(comm, read) {
        Ok(case) => case,
        Err(error) => return warn(comm, &error.to_string()),
    };
    if let Err(error) = snapshot::quantities(&case.output.fields) {
        return warn(comm, &format!("error: {error}"));
    }
    if let Some(message) = args.common.shortage(comm, &case) {
        return warn(comm, &message);
    }
    let out = args.out.clone().unwrap_or_else(|| default_folder(&path));
    let mut folder = RunFolder::at(&out);
    match folder.take_new(comm, args.force, args.common.ignore_lock) {
        Ok(more) => start(launch, &args.common, case, folder, args.force, more),
        Err(error) => warn(comm, &format!("error: {error}")),
    }
}

/// The case file and its text, read by rank 0 for all.
fn read_case(comm: &Comm, path: &Path) -> Result<(PathBuf, String), String> {
    // The first byte says if the rest is path and text or an error.
    let mut bytes = Vec::new();
    if comm.is_root() {
        let (tag, text) = match input::text(path) {
            Ok((path, text)) => (0, format!("{}\0{text}", path.display())),
            Err(error) => (1, error.to_string()),
        };
        bytes.push(tag);
        bytes.extend_from_slice(text.as_bytes());
    }
    comm.broadcast(&mut bytes);
    let text = String::from_utf8_lossy(bytes.get(1..).unwrap_or_default()).into_owned();
    match text.split_once('\0') {
        Some((path, text)) if bytes.first() == Some(&0) => {
            Ok((PathBuf::from(path), text.to_owned()))
        }
        _ => Err(text),
    }
}

/// `runs/` and the case's own name: that of its file, or of its folder for a `case.toml`.
pub(super) fn default_folder(case: &Path) -> PathBuf {
    let stem = case.file_stem().unwrap_or_default();
    let folder = case.parent().and_then(Path::file_name);
    let name = if stem == "case" {
        folder.unwrap_or(stem)
    } else {
        stem
    };
    Path::new("runs").join(name)
}
