//! How long this rank has waited for others, by the clock.
//!
//! Every call of this room that returns only when other ranks have come as far goes through
//! [`waiting`]: so a rank's own work can be told from its waiting wherever the call stands.

use std::cell::Cell;
use std::time::{Duration, Instant};

use super::virtual_ranks;

thread_local! {
    /// Of this thread: MPI is on the main thread alone.
    static WAITED: Cell<Duration> = const { Cell::new(Duration::ZERO) };
}

/// How long calls of this room have waited for other ranks since the thread began. On a virtual
/// rank it is all time that the rank has not computed, as its clock counts it.
#[must_use]
pub fn waited() -> Duration {
    virtual_ranks::waited().unwrap_or_else(|| WAITED.get())
}

/// A call that waits for others.
pub(super) fn waiting<T>(call: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = call();
    WAITED.set(WAITED.get() + start.elapsed());
    result
}
