//! Threads, each bound to a core: so that they neither wander nor share one, as they would under
//! Open MPI's default, which binds all threads of a rank to a single core.

use crate::comm::Comm;
use crate::run::say;

/// Starts so many threads on each rank. Each gets a core of its own where this process may use as
/// many as the ranks of this machine need together; else the launcher's binding stays.
///
/// # Errors
/// A message if there are already threads.
pub fn start_threads(threads: usize, comm: &Comm) -> Result<(), String> {
    let number = |name| std::env::var(name).ok()?.parse::<usize>().ok();
    let ranks = number("OMPI_COMM_WORLD_LOCAL_SIZE").unwrap_or_else(|| comm.size());
    let rank = number("OMPI_COMM_WORLD_LOCAL_RANK").unwrap_or_else(|| comm.rank());
    let all = allowed();
    if comm.is_root() && all.len() < threads {
        say::complain(&format!(
            "warning: each rank has {threads} threads and may use {} of the cores",
            all.len()
        ));
    }
    let cores = if all.len() >= ranks * threads {
        all[rank * threads..][..threads].to_vec()
    } else {
        Vec::new()
    };
    if let Some(&core) = cores.first() {
        bind(core);
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .use_current_thread()
        .start_handler(move |thread| {
            if let Some(&core) = cores.get(thread) {
                bind(core);
            }
        })
        .build_global()
        .map_err(|error| format!("error: {threads} threads do not start: {error}"))
}

/// The cores that this process may use.
#[cfg(target_os = "linux")]
fn allowed() -> Vec<usize> {
    // SAFETY: the set is plain bits, and the call writes no more than its size.
    let (set, failed) = unsafe {
        let mut set: libc::cpu_set_t = std::mem::zeroed();
        let failed = libc::sched_getaffinity(0, size_of_val(&set), &raw mut set);
        (set, failed)
    };
    let limit = usize::try_from(libc::CPU_SETSIZE).unwrap_or(0);
    // SAFETY: the number is below the size of the set.
    let has = |&core: &usize| unsafe { libc::CPU_ISSET(core, &set) };
    if failed == 0 {
        (0..limit).filter(has).collect()
    } else {
        Vec::new()
    }
}

/// Binds this thread to a core; if the system refuses, it stays free.
#[cfg(target_os = "linux")]
fn bind(core: usize) {
    // SAFETY: the set is plain bits, and `core` came from such a set.
    unsafe {
        let mut set: libc::cpu_set_t = std::mem::zeroed();
        libc::CPU_SET(core, &mut set);
        libc::sched_setaffinity(0, size_of_val(&set), &raw const set);
    }
}

#[cfg(not(target_os = "linux"))]
fn allowed() -> Vec<usize> {
    Vec::new()
}

#[cfg(not(target_os = "linux"))]
fn bind(_core: usize) {}
