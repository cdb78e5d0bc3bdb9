//! The ranks of a command: started together, and ended together with one message.

use std::sync::Once;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Instant, SystemTime};

use super::exit::{EXIT_FAILED, EXIT_INPUT};
use super::say;
use super::stop::Signals;
use crate::input::InputError;
use crate::output::h5::abandoned;
use crate::output::{
    Outlook, OutputError, Phase, RunFolder, Status, VERSION, agree, commit, same_on_all,
};
use crate::preflight::memory::local_ranks;
use comm::{Comm, Session, abort_job, library};
use model::Case;

/// Exit code of a program that panicked.
pub const EXIT_PANIC: i32 = 101;

/// The step that this process is in, for the message of a panic.
pub static STEP: AtomicU64 = AtomicU64::new(0);

/// Start of a command on all ranks.
pub struct Launch<'a> {
    /// The ranks.
    pub comm: &'a Comm,
    /// Start of the program.
    pub start: Instant,
    /// Time at which MPI had started.
    pub ready: Instant,
    /// Start of the program by the clock of files.
    pub began: SystemTime,
    /// Signals that came since.
    pub signals: Signals,
}

impl Launch<'_> {
    /// Starts the threads of this rank, once for all parts of a command.
    pub fn start_threads(&self, wanted: Option<u16>) {
        static STARTED: Once = Once::new();
        STARTED.call_once(|| start_threads(self.comm, wanted.map(usize::from)));
    }
}

/// Starts MPI, and makes a panic on one rank end all ranks. Returns `work`'s exit code once MPI is
/// finalised.
pub fn with_ranks(work: impl FnOnce(&Launch) -> u8) -> u8 {
    let (start, began) = (Instant::now(), SystemTime::now());
    let signals = Signals::watch();
    let Some((session, comm)) = Session::start() else {
        say::warn("error: MPI does not start; is this program linked to the MPI of this mpirun?");
        return EXIT_FAILED;
    };
    if let Some((rank, message)) = strangers(comm.size(), |name| std::env::var(name).ok()) {
        // Each process believes that it is rank 0.
        if rank == 0 {
            say::warn(&format!("error: {message}"));
        }
        return EXIT_FAILED;
    }
    abort_on_panic(comm.rank());
    let code = work(&Launch {
        comm: &comm,
        start,
        ready: Instant::now(),
        began,
        signals,
    });
    if abandoned() {
        // All ranks are here, and all messages are printed.
        comm.barrier();
        abort_job(code.into());
    }
    drop(comm);
    drop(session);
    code
}

/// The variables in which launchers tell a process the number of ranks and its own: those of Open MPI, of MPICH
/// and its kin, and of a step of SLURM.
const LAUNCHERS: [[&str; 2]; 3] = [
    ["OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"],
    ["PMI_SIZE", "PMI_RANK"],
    ["SLURM_STEP_NUM_TASKS", "SLURM_PROCID"],
];

/// This process's rank by its launcher, and a message, if that has started more ranks than the `size` that MPI
/// knows of: the launcher is of another MPI. The innermost launcher counts.
fn strangers(size: usize, variable: impl Fn(&str) -> Option<String>) -> Option<(usize, String)> {
    let number = |name| variable(name)?.parse::<usize>().ok();
    let mut launchers = LAUNCHERS.into_iter();
    let (name, started, rank) =
        launchers.find_map(|[all, own]| Some((all, number(all)?, number(own)?)))?;
    let message = format!(
        "the launcher has started {started} ranks ({name}), and MPI ({}) knows of {size}, so that each would \
         run the case by itself; take the mpirun of this MPI, or build the program with the launcher's",
        library()
    );
    (started > size).then_some((rank, message))
}

/// Returns true if this process was started by an MPI launcher.
#[must_use]
pub fn by_mpi() -> bool {
    let launched = ["OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE"];
    launched.iter().any(|name| std::env::var_os(name).is_some())
}

/// Runs `task` once for all processes of a job that need no MPI for their work.
pub fn once(task: impl FnOnce()) {
    // mpirun may kill the job at the first exit, so no rank leaves before rank 0 is done.
    if by_mpi()
        && let Some((_session, comm)) = Session::start()
    {
        if comm.is_root() {
            task();
        }
        comm.barrier();
    } else {
        task();
    }
}

/// Fails on every rank unless all were started with the same options of the same program. Collective.
///
/// # Errors
/// [`OutputError::OtherRank`].
pub fn same_options(comm: &Comm, options: &impl std::fmt::Debug) -> Result<(), OutputError> {
    let text = format!("{VERSION} {} {options:?}", commit());
    same_on_all(
        comm,
        "has other options, or another version of the program,",
        &text,
    )
}

/// The case that all ranks have read: some read files of their own. Collective.
///
/// # Errors
/// The error of a rank, the same on every rank.
pub fn same_case(comm: &Comm, read: Result<Case, InputError>) -> Result<Case, OutputError> {
    let read = read.map_err(|error| OutputError::OtherRank(error.to_string()));
    let case = agree(comm, read)?;
    let told = same_on_all(comm, "has read another case", &case.resolved);
    // As the errors of the input are.
    told.map_err(|error| OutputError::OtherRank(format!("error: {error}")))?;
    Ok(case)
}

/// Prints an error of the input, once for all ranks; returns the exit code.
pub fn warn(comm: &Comm, message: &str) -> u8 {
    if comm.is_root() {
        say::warn(message);
    }
    // mpirun may kill the job at the first exit.
    comm.barrier();
    EXIT_INPUT
}

/// Prints why a run could not begin, once for all ranks; returns the exit code. Its folder is left as
/// it was.
pub fn give_up(comm: &Comm, message: &str) -> u8 {
    warn(comm, &format!("error: {message}"));
    EXIT_FAILED
}

/// Prints once for all ranks why a run failed at a step and a time (s), and writes it into its
/// folder; returns the exit code.
pub fn fail(comm: &Comm, folder: &RunFolder, message: &str, step: u64, time: f64) -> u8 {
    if comm.is_root() {
        let lost = folder.check().err().map(|lost| lost.to_string());
        say::warn(&format!("error: {}", lost.as_deref().unwrap_or(message)));
    }
    if comm.is_root()
        && let Some(folder) = folder.place()
    {
        // The message above is what counts; the folder may be what failed.
        let outlook = folder.status().ok().and_then(|status| status.outlook);
        let _ = folder.write_status(&Status {
            reason: Some(message.to_owned()),
            exit_code: Some(EXIT_FAILED),
            outlook: outlook.map(|outlook| Outlook {
                seconds_left: None,
                ..outlook
            }),
            ..Status::new(Phase::Failed, step, time)
        });
    }
    comm.barrier();
    EXIT_FAILED
}

/// Stack of a thread (bytes): exact sums are large, and waiting tasks are nested. Untouched pages take no
/// memory.
const STACK: usize = 16 << 20;

fn start_threads(comm: &Comm, wanted: Option<usize>) {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = wanted.unwrap_or_else(|| default_threads(comm, cores));
    if comm.is_root() && threads > cores {
        say::warn(&format!(
            "warning: each rank has {threads} threads and may use {cores} of the cores; if the \
             machine has more, mpirun has bound the ranks: --bind-to none or --map-by \
             slot:PE={threads} frees them"
        ));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(STACK)
        .use_current_thread()
        .build_global();
    // Without a pool of its own rayon uses all cores, which is correct, if not what was wanted.
    if let Err(cause) = pool {
        let rank = comm.rank();
        say::warn(&format!(
            "warning: rank {rank} cannot start {threads} threads: {cause}"
        ));
    }
}

/// Lets `RAYON_NUM_THREADS` start no more threads than there are cores, in commands without ranks.
pub fn bound_threads() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    if let Some(threads) = wanted_by_rayon(cores, true) {
        // A pool that cannot start fails where it is used, with its reason.
        let _ = (rayon::ThreadPoolBuilder::new().num_threads(threads)).build_global();
    }
}

/// The number of `RAYON_NUM_THREADS`, at most that of the cores; warns where it is more, if this process `tells`.
fn wanted_by_rayon(cores: usize, tells: bool) -> Option<usize> {
    let wanted = std::env::var("RAYON_NUM_THREADS")
        .ok()?
        .parse::<usize>()
        .ok()?;
    if wanted > cores && tells {
        say::warn(&format!(
            "warning: RAYON_NUM_THREADS is {wanted}, more than the cores that this process may use: it has {cores} threads"
        ));
    }
    Some(wanted.min(cores))
}

/// Cores that this process may use over ranks of this machine, unless `RAYON_NUM_THREADS` says
/// otherwise.
fn default_threads(comm: &Comm, cores: usize) -> usize {
    wanted_by_rayon(cores, comm.is_root())
        .unwrap_or_else(|| cores / local_ranks(comm.size()))
        .max(1)
}

/// Makes a panic anywhere print one line and end all ranks: else it would unwind into `MPI_Finalize`,
/// which waits for the other ranks, and they for this one.
pub fn abort_on_panic(rank: usize) {
    let default_hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let step = STEP.load(Ordering::Relaxed);
        let location = info
            .location()
            .map(|l| format!(" ({}:{})", l.file(), l.line()))
            .unwrap_or_default();
        let what = info
            .payload_as_str()
            .unwrap_or("unknown cause")
            .replace('\n', " ");
        say::warn(&format!(
            "error: rank {rank}, step {step}: {what}{location}; this is a bug of the program"
        ));
        if std::env::var_os("RUST_BACKTRACE").is_some_and(|wanted| wanted != "0") {
            default_hook(info);
        }
        abort_job(EXIT_PANIC);
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_launcher_of_another_mpi_is_noticed() {
        let told = |size, known: &[(&str, &str)]| {
            let variable = |name: &str| {
                let found = known.iter().find(|(known, _)| *known == name);
                found.map(|(_, value)| (*value).to_owned())
            };
            strangers(size, variable)
        };
        assert_eq!(told(1, &[]), None);
        let hydra = [("PMI_SIZE", "4"), ("PMI_RANK", "2")];
        let (rank, message) = told(1, &hydra).unwrap();
        assert!(
            rank == 2 && message.contains("4 ranks (PMI_SIZE)"),
            "{message}"
        );
        assert_eq!(told(4, &hydra), None);
        // A batch job's own shell is no step, and mpirun counts more than the step that it runs in.
        assert_eq!(
            told(1, &[("SLURM_NTASKS", "4"), ("SLURM_PROCID", "0")]),
            None
        );
        let step = [("SLURM_STEP_NUM_TASKS", "2"), ("SLURM_PROCID", "0")];
        assert!(told(1, &step).is_some());
        let within = [("OMPI_COMM_WORLD_SIZE", "1"), ("OMPI_COMM_WORLD_RANK", "0")];
        assert_eq!(told(1, &[&step[..], &within].concat()), None);
    }
}
