//! Threads, each bound to a core, so that they neither migrate nor share one as under Open MPI's default,
//! which binds all threads of a rank to a single core.

use comm::Comm;
use files::run::say;

/// Starts `threads` threads on each rank. Each gets a core of its own if this process may use as many as
/// the ranks of this machine need together; else the launcher's binding stays.
///
/// # Errors
/// A message if there are already threads.
pub fn start_threads(threads: usize, comm: &Comm) -> Result<(), String> {
    let number = |name| std::env::var(name).ok()?.parse::<usize>().ok();
    let ranks = number("OMPI_COMM_WORLD_LOCAL_SIZE").unwrap_or_else(|| comm.size());
    let rank = number("OMPI_COMM_WORLD_LOCAL_RANK").unwrap_or_else(|| comm.rank());
    // None where the cores are unknown.
    let all = core_affinity::get_core_ids().unwrap_or_default();
    if comm.is_root() && all.len() < threads {
        say::warn(&format!(
            "warning: each rank has {threads} threads and may use {} of the cores",
            all.len()
        ));
    }
    let cores = if all.len() >= ranks * threads {
        all[rank * threads..][..threads].to_vec()
    } else {
        Vec::new()
    };
    // Threads that the system does not bind stay free.
    if let Some(&core) = cores.first() {
        core_affinity::set_for_current(core);
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .use_current_thread()
        .start_handler(move |thread| {
            if let Some(&core) = cores.get(thread) {
                core_affinity::set_for_current(core);
            }
        })
        .build_global()
        .map_err(|error| format!("error: {threads} threads do not start: {error}"))
}
