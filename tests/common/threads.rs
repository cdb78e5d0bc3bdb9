//! How many threads a test has.

use std::sync::Once;

/// Where cargo-nextest runs a test of these rooms, in a process of its own beside one for each other
/// core, its thread computes alone: to hand small sums to a second one and wait for it would take
/// most of the time. That threads change no bit is held by `bits` and by tests of the whole program.
pub fn stay_alone() {
    static ONCE: Once = Once::new();
    let room = std::env::var("NEXTEST_BINARY_ID").unwrap_or_default();
    if room.ends_with("::physics") || room.ends_with("::engine") {
        ONCE.call_once(|| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
            // A pool that is there already is as good.
            let _ = pool.use_current_thread().build_global();
        });
    }
}
