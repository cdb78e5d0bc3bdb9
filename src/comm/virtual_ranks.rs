//! Virtual ranks: the ranks of one program as threads of one process, without MPI, on a model of a
//! machine.
//!
//! They run the code of real ranks with messages of the same length, a thousand ranks and more on a few
//! cores. A [clock](VirtualTime) of each rank counts the cost of that machine's network; the time that
//! the threads really take means nothing.
//!
//! A rank is its thread: its work must stay there to be distinguished from that of others. So a task that
//! uses rayon first builds a pool of one thread, its own, with `use_current_thread`. Virtual ranks have no
//! files: HDF5 would need MPI.

mod clock;
mod rank;
mod world;

pub use clock::{Call, CallTraffic, VirtualTime};
pub(super) use clock::{calls, waited};
pub(super) use rank::Rank;
pub(super) use world::{Tag, Ticket};

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::thread;

use super::Comm;
use clock::Clock;
use world::{Abandoned, World};

/// The machine that virtual ranks run on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Machine {
    /// Time from the end of a message at the sender to its end at the receiver (s).
    pub latency: f64,
    /// Bandwidth of the messages of a rank, which leave one after the other (bytes/s).
    pub bandwidth: f64,
    /// Source of the time that ranks compute.
    pub computing: Computing,
}

impl Machine {
    /// Messages take no time, and neither does computing.
    pub const IDEAL: Self = Self {
        latency: 0.0,
        bandwidth: f64::INFINITY,
        computing: Computing::Reported,
    };
}

/// Source of the computing time on the clock of a virtual rank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Computing {
    /// The processor time of the rank's thread between calls of this module. Threads that share
    /// a core drive each other's data from its cache, which counts.
    Measured,
    /// The seconds given to [`Comm::compute`], and nothing else: the same in every run.
    Reported,
}

/// Stack of a rank (bytes), as large as that of a process's main thread. Untouched pages take no memory.
const STACK: usize = 8 << 20;

/// Runs a task on a number of virtual ranks at once; returns its results by rank.
///
/// # Panics
/// If the task panics on a rank, which ends all others where they wait next; if ranks wait for each
/// other in a circle; if the system has no more threads.
pub fn virtual_ranks<T: Send>(
    ranks: usize,
    machine: Machine,
    task: impl Fn(&Comm) -> T + Sync,
) -> Vec<T> {
    let world = Arc::new(World::new(ranks));
    let run = |rank: usize| {
        Clock::start(machine.computing);
        let comm = Comm::on_virtual_rank(Rank::new(rank, ranks, machine, Arc::clone(&world)));
        let result = catch_unwind(AssertUnwindSafe(|| {
            let result = task(&comm);
            world.end();
            result
        }));
        result.inspect_err(|_| world.give_up())
    };
    let results: Vec<Result<T, Box<dyn Any + Send>>> = thread::scope(|scope| {
        let run = &run;
        let threads: Vec<_> = (0..ranks)
            .map(|rank| {
                let thread = thread::Builder::new().stack_size(STACK);
                let started = thread.spawn_scoped(scope, move || run(rank));
                started.unwrap_or_else(|cause| {
                    world.give_up();
                    panic!("rank {rank} cannot start: {cause}")
                })
            })
            .collect();
        let joined = threads.into_iter().map(thread::ScopedJoinHandle::join);
        joined.map(|result| result.and_then(|same| same)).collect()
    });
    let is_cause = |result: &Result<T, Box<dyn Any + Send>>| matches!(result, Err(cause) if !cause.is::<Abandoned>());
    let first = results.iter().position(is_cause);
    let mut values = Vec::with_capacity(ranks);
    for (rank, result) in results.into_iter().enumerate() {
        match result {
            Ok(value) => values.push(value),
            Err(cause) if first.is_none_or(|first| first == rank) => resume_unwind(cause),
            Err(_) => {}
        }
    }
    values
}
