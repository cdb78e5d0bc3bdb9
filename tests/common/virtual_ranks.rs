//! Tests on virtual ranks.
#![allow(dead_code, reason = "each test file uses some of these")]

use whipple::comm::{Comm, Machine, virtual_ranks};

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
