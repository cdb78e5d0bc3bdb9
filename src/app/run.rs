//! `whipple run`: a case from its start.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::driver::{Driver, fail};
use super::launch::{Launch, complain, give_up, with_ranks};
use super::memory;
use super::stop::{parse_until, parse_walltime};
use crate::comm::Comm;
use crate::input;
use crate::model::Case;
use crate::output::{RunFolder, RunLock, snapshot};
use crate::step::Simulation;

/// Run a case from its start
///
/// Under mpirun each rank has a slab of the model, and the results are the same bits on any number
/// of ranks and threads. The folder of the results holds tables (history.csv, contacts.csv),
/// snapshots for ParaView, checkpoints, summary.json and status.json.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  mpirun -n 2 whipple run inputs/quarter-impact
  mpirun -n 2 whipple run inputs/quarter-impact --set spacing=0.015mm --out runs/fine
  mpirun -n 2 whipple run inputs/quarter-impact --walltime 1h --force

To stop a run softly, send SIGUSR1 to mpirun or SIGTERM to a rank, make a file `stop` in its
folder, or give --walltime: it writes a checkpoint and exits with 75, and `whipple restart` goes
on. Other exit codes: 0 finished, or --until is reached; 1 failed; 2 wrong input.")]
pub struct RunArgs {
    /// Case file (TOML), or a folder with a case.toml
    #[arg(value_name = "CASE")]
    case: PathBuf,

    /// Folder of the results [default: runs/NAME, after the case's folder or file]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Change a value of the case, as in spacing=0.015mm; may be given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    set: Vec<String>,

    #[command(flatten)]
    common: CommonArgs,

    /// Replace an earlier run in the folder of the results
    #[arg(short, long)]
    force: bool,
}

/// Options that `run` and `restart` share.
#[derive(Debug, Clone, clap::Args)]
pub struct CommonArgs {
    /// Stop with a checkpoint at the first step at or after this time of the case, as in 0.1us
    #[arg(short, long, value_name = "TIME", value_parser = parse_until)]
    pub until: Option<f64>,

    /// Stop with a checkpoint after this much time of the clock, as in 90s, 2h or 1:30:00
    #[arg(short, long, value_name = "TIME", value_parser = parse_walltime)]
    pub walltime: Option<Duration>,

    /// Threads of each rank [default: the cores shared out among the machine's ranks]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,

    /// Start even if the memory that the ranks will take is more than there is
    #[arg(long)]
    pub ignore_memory: bool,

    /// Take the folder of the results even if another process seems to write into it
    #[arg(long)]
    pub ignore_lock: bool,

    /// Fill all that is not state with NaN between steps, to find what a checkpoint forgets
    #[arg(long, hide = true)]
    pub poison: bool,
}

impl CommonArgs {
    /// Why there is not enough memory for a case, unless the user will not hear of it. Collective.
    pub fn shortage(&self, comm: &Comm, case: &Case) -> Option<String> {
        let shortage = (!self.ignore_memory).then(|| memory::shortage(comm, case));
        shortage.flatten().map(|why| format!("error: {why}"))
    }
}

/// Runs the command; returns the exit code.
pub fn run(args: &RunArgs) -> u8 {
    with_ranks(|launch| {
        let comm = launch.comm;
        let (path, text) = match read_case(comm, &args.case) {
            Ok(found) => found,
            Err(message) => return complain(comm, &message),
        };
        let case = match input::parse(&path.display().to_string(), &text, &args.set) {
            Ok(case) => case,
            Err(error) => return complain(comm, &error.to_string()),
        };
        if let Err(error) = snapshot::quantities(&case.output.fields) {
            return complain(comm, &format!("error: {error}"));
        }
        if let Some(message) = args.common.shortage(comm, &case) {
            return complain(comm, &message);
        }
        let out = args.out.clone().unwrap_or_else(|| default_folder(&path));
        // Held to the end.
        let lock = match RunFolder::at(&out).take_new(comm, args.force, args.common.ignore_lock) {
            Ok(lock) => lock,
            Err(error) => return complain(comm, &format!("error: {error}")),
        };
        start(launch, args, case, &out, lock.as_ref())
    })
}

/// Sets the case up, and only then clears the folder of an earlier run.
fn start(launch: &Launch, args: &RunArgs, case: Case, out: &Path, lock: Option<&RunLock>) -> u8 {
    launch.start_threads(&args.common);
    let comm = launch.comm;
    let mut warnings = input::warnings(&case);
    warnings.extend(lock.iter().flat_map(|lock| lock.warnings.iter().cloned()));
    let resolved = case.resolved.clone();
    let simulation = match Simulation::start(case, comm) {
        Ok(simulation) => simulation,
        Err(error) => return give_up(comm, &error.to_string()),
    };
    let folder = match RunFolder::create(comm, out, &resolved, args.force) {
        Ok(folder) => folder,
        Err(error) => return give_up(comm, &error.to_string()),
    };
    match Driver::begin(launch, &args.common, simulation, &folder, None, &warnings) {
        Ok(driver) => driver.run(comm),
        Err(error) => fail(comm, &folder, &error.to_string(), 0, 0.0),
    }
}

/// The case file and its text, read by rank 0 for all.
fn read_case(comm: &Comm, path: &Path) -> Result<(PathBuf, String), String> {
    // The first byte tells whether the rest is path and text or an error.
    let mut bytes = Vec::new();
    if comm.is_root() {
        let (kind, text) = match input::text(path) {
            Ok((path, text)) => (0, format!("{}\0{text}", path.display())),
            Err(error) => (1, error.to_string()),
        };
        bytes.push(kind);
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
fn default_folder(case: &Path) -> PathBuf {
    let stem = case.file_stem().unwrap_or_default();
    let folder = case.parent().and_then(Path::file_name);
    let name = if stem == "case" {
        folder.unwrap_or(stem)
    } else {
        stem
    };
    Path::new("runs").join(name)
}
