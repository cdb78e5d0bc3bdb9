//! Particles that one thread has visited while the others waited, counted for tests.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

static VISITED: AtomicU64 = AtomicU64::new(0);

/// Counts particles that the thread which steps visits alone, or is about to.
pub fn visit(particles: usize) {
    VISITED.fetch_add(particles as u64, Relaxed);
}

/// All that were counted in this process.
#[must_use]
pub fn visited() -> u64 {
    VISITED.load(Relaxed)
}
