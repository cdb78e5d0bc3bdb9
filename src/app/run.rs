//! `whipple run`: a case from its start.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::driver::{self, Driver, Options};
use super::stop::parse_walltime;
use crate::comm::{Comm, Session, abort_job};
use crate::input;
use crate::model::Case;
use crate::output::RunFolder;
use crate::step::Simulation;

use super::EXIT_INPUT;

/// Run a case from its start
#[derive(Debug, clap::Args)]
pub struct RunArgs {
    /// Case file (TOML), or a folder with a case.toml
    #[arg(value_name = "CASE")]
    case: PathBuf,

    /// Folder of the results [default: runs/NAME]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Change a value of the case, as in spacing=0.015mm or body.sphere.velocity=[...]
    #[arg(short, long, value_name = "KEY=VALUE")]
    set: Vec<String>,

    #[command(flatten)]
    common: CommonArgs,

    /// Replace an earlier run in the same folder
    #[arg(short, long)]
    force: bool,
}

/// Options that `run` and `restart` share.
#[derive(Debug, Clone, clap::Args)]
pub struct CommonArgs {
    /// Stop with a checkpoint at the first step at or after this time, as in 0.1us
    #[arg(short, long, value_name = "TIME")]
    pub until: Option<String>,

    /// Stop with a checkpoint when this much time has passed, as in 90s, 2h or 1:30:00
    #[arg(short, long, value_name = "TIME", value_parser = parse_walltime)]
    pub walltime: Option<Duration>,

    /// Threads of each rank [default: cores of the machine / ranks on it]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,

    /// Fill all that is not state with NaN between steps, to find what a checkpoint forgets
    #[arg(long, hide = true)]
    pub poison: bool,
}

impl CommonArgs {
    /// The options of the loop.
    ///
    /// # Errors
    /// A message if `--until` is no time.
    pub fn options(&self, start: Instant) -> Result<Options, String> {
        let until = self.until.as_deref().map(input::time).transpose();
        Ok(Options {
            until: until.map_err(|error| format!("error: --until {error}"))?,
            walltime: self.walltime,
            poison: self.poison,
            start,
        })
    }
}

/// Runs the command; returns the exit code.
pub fn run(args: &RunArgs) -> u8 {
    with_ranks(&args.common, |comm, options| {
        let (path, text) = match read_case(comm, &args.case) {
            Ok(found) => found,
            Err(message) => return complain(comm, &message),
        };
        let case = match input::parse(&path.display().to_string(), &text, &args.set) {
            Ok(case) => case,
            Err(error) => return complain(comm, &error.to_string()),
        };
        let out = args.out.clone().unwrap_or_else(|| default_folder(&path));
        start(comm, case, &out, args.force, options)
    })
}

fn start(comm: &Comm, case: Case, out: &Path, force: bool, options: &Options) -> u8 {
    if let Err(error) = crate::output::snapshot::quantities(&case.output.fields) {
        return complain(comm, &format!("error: {error}"));
    }
    let folder = match RunFolder::create(comm, out, &case.resolved, force) {
        Ok(folder) => folder,
        Err(error) => return complain(comm, &format!("error: {error}")),
    };
    let simulation = match Simulation::start(case, comm) {
        Ok(simulation) => simulation,
        Err(error) => return driver::fail(comm, &folder, &error.to_string()),
    };
    match Driver::begin(comm, simulation, &folder, options, None) {
        Ok(driver) => driver.run(comm),
        Err(error) => driver::fail(comm, &folder, &error.to_string()),
    }
}

/// The case file and its text, read by rank 0 for all.
fn read_case(comm: &Comm, path: &Path) -> Result<(PathBuf, String), String> {
    let path = if path.is_dir() {
        path.join("case.toml")
    } else {
        path.to_owned()
    };
    // The first byte tells whether the rest is the text or an error.
    let mut bytes = Vec::new();
    if comm.is_root() {
        match std::fs::read_to_string(&path) {
            Ok(text) => {
                bytes.push(0);
                bytes.extend_from_slice(text.as_bytes());
            }
            Err(error) => {
                bytes.push(1);
                let text = format!("error: cannot read the case {}: {error}", path.display());
                bytes.extend_from_slice(text.as_bytes());
            }
        }
    }
    comm.broadcast(&mut bytes);
    let text = String::from_utf8_lossy(bytes.get(1..).unwrap_or_default()).into_owned();
    if bytes.first() == Some(&0) {
        Ok((path, text))
    } else {
        Err(text)
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

/// Says what is wrong with the input, once for all ranks.
pub fn complain(comm: &Comm, message: &str) -> u8 {
    if comm.is_root() {
        eprintln!("{}", message.trim_end());
    }
    // Nobody leaves before rank 0 has spoken: mpirun may kill the job at the first exit.
    comm.barrier();
    EXIT_INPUT
}

/// Starts MPI and the threads, and makes a panic on one rank end all ranks.
pub fn with_ranks(args: &CommonArgs, work: impl FnOnce(&Comm, &Options) -> u8) -> u8 {
    let start = Instant::now();
    let options = match args.options(start) {
        Ok(options) => options,
        Err(message) => {
            eprintln!("{}", message.trim_end());
            return EXIT_INPUT;
        }
    };
    let Some((session, comm)) = Session::start() else {
        eprintln!("error: MPI does not start; is this program linked to the MPI of this mpirun?");
        return 1;
    };
    abort_on_panic(comm.rank());
    let threads = args.threads.map_or_else(
        || default_threads(&comm),
        |threads| Some(usize::from(threads)),
    );
    if let Some(threads) = threads {
        // Without a pool of its own rayon uses all cores, which is right, if not what was asked.
        let _ = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .use_current_thread()
            .build_global();
    }
    let code = work(&comm, &options);
    drop(comm);
    drop(session);
    code
}

/// Cores of the machine over ranks, unless `RAYON_NUM_THREADS` says otherwise.
fn default_threads(comm: &Comm) -> Option<usize> {
    if let Ok(Ok(threads)) = std::env::var("RAYON_NUM_THREADS").map(|text| text.parse::<usize>()) {
        return Some(threads.max(1));
    }
    let local = std::env::var("OMPI_COMM_WORLD_LOCAL_SIZE")
        .ok()
        .and_then(|text| text.parse::<usize>().ok())
        .unwrap_or_else(|| comm.size());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Some((cores / local.max(1)).max(1))
}

fn abort_on_panic(rank: usize) {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let step = driver::STEP.load(std::sync::atomic::Ordering::Relaxed);
        let place = info
            .location()
            .map(|l| format!(" ({}:{})", l.file(), l.line()))
            .unwrap_or_default();
        let what = info.payload_as_str().unwrap_or("unknown cause");
        eprintln!("error: rank {rank}, step {step}: {what}{place}; this is a bug of the program");
        if std::env::var_os("RUST_BACKTRACE").is_some() {
            usual(info);
        }
        abort_job(101);
    }));
}
