//! Tests on virtual ranks.

use comm::{Comm, Machine, virtual_ranks};

/// Runs a task on so many virtual ranks, each with a pool of one thread, its own.
pub fn on_virtual_ranks<T: Send>(
    ranks: usize,
    machine: Machine,
    task: impl Fn(&Comm) -> T + Sync,
) -> Vec<T> {
    virtual_ranks(ranks, machine, |comm| {
        let _pool = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .use_current_thread()
            .build()
            .expect("a pool of this thread");
        task(comm)
    })
}

/// Runs a task on each of these numbers of ranks in turn: on one with all threads, on more as
/// [`on_virtual_ranks`] does.
pub fn on_each(ranks: &[usize], task: impl Fn(&Comm) + Sync) {
    for &ranks in ranks {
        if ranks == 1 {
            task(&Comm::solo());
        } else {
            on_virtual_ranks(ranks, Machine::IDEAL, &task);
        }
    }
}
