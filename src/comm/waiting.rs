//! Time that this rank has waited for others.
//!
//! Every call of this crate that returns only when other ranks have come as far goes through
//! [`waiting`], which separates a rank's own work from its waiting.

use std::cell::Cell;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use mpi::ffi;

use super::virtual_ranks;

thread_local! {
    /// Waiting of this thread: MPI is on the main thread alone.
    static WAITED: Cell<Duration> = const { Cell::new(Duration::ZERO) };
    static IS_ON: Cell<bool> = const { Cell::new(false) };
}

/// Time that calls of this crate have waited for other ranks since the thread began. On a virtual
/// rank it is all time that the rank has not computed by its clock.
#[must_use]
pub fn waited() -> Duration {
    virtual_ranks::waited().unwrap_or_else(|| WAITED.get())
}

/// Seconds since a first call of this.
pub(super) fn since_start() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Lets MPI move the messages that are under way, if this is the thread that it is on: without its calls long messages stand
/// still. For loops of all threads that run meanwhile, now and then.
pub fn progress() {
    if !IS_ON.get() {
        return;
    }
    let mut flag = 0;
    // SAFETY: MPI is initialised, and this is its thread. A probe takes no message.
    unsafe {
        ffi::MPI_Iprobe(
            ffi::RSMPI_ANY_SOURCE,
            ffi::RSMPI_ANY_TAG,
            ffi::RSMPI_COMM_WORLD,
            &raw mut flag,
            ffi::RSMPI_STATUS_IGNORE,
        );
    }
}

/// Says that messages of MPI are on this thread from now on, or no longer.
pub(super) fn set_on(is_on: bool) {
    IS_ON.set(is_on);
}

/// A call that waits for others.
pub(super) fn waiting<T>(call: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = call();
    WAITED.set(WAITED.get() + start.elapsed());
    result
}
