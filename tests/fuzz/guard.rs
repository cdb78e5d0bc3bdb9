//! What no file may make a reader do: take much more memory than the file is long, or wait for
//! ever.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Memory beyond that in use when an attempt begins (bytes): pictures and threads need some, and no
/// file here is longer than a few of these hundreds.
const MOST: usize = 256 << 20;
/// One attempt takes milliseconds, and under a memory checker a second.
const LONGEST: Duration = Duration::from_mins(1);

struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn take(bytes: usize) {
    let held = HELD.fetch_add(bytes, Relaxed) + bytes;
    PEAK.fetch_max(held, Relaxed);
}

// SAFETY: hands every call to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        take(layout.size());
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        take(layout.size());
        // SAFETY: the caller keeps the contract of `alloc_zeroed`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        take(size);
        HELD.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// An attempt that is watched until this is dropped.
pub struct Watch {
    begun: usize,
    most: usize,
    what: String,
    _end: Sender<()>,
}

/// Watches an attempt: one that does not end is told and ends the process, which nothing else
/// could.
pub fn watch(what: &str) -> Watch {
    watch_within(what, MOST)
}

/// The same of one that may take so much memory (bytes).
pub fn watch_within(what: &str, most: usize) -> Watch {
    let begun = HELD.load(Relaxed);
    PEAK.store(begun, Relaxed);
    let (end, ended) = channel();
    let told = what.to_owned();
    // What crashes the process leaves its recipe behind.
    let last = concat!(env!("CARGO_TARGET_TMPDIR"), "/fuzz-file.json");
    std::fs::write(last, what).unwrap();
    std::thread::spawn(move || {
        if ended.recv_timeout(LONGEST) == Err(RecvTimeoutError::Timeout) {
            eprintln!("this file keeps its reader for ever: {told}");
            std::process::abort();
        }
    });
    Watch {
        begun,
        most,
        what: what.to_owned(),
        _end: end,
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let taken = PEAK.load(Relaxed).saturating_sub(self.begun);
        if !std::thread::panicking() {
            let what = &self.what;
            assert!(
                taken < self.most,
                "{taken} bytes of memory are taken for the file {what}"
            );
        }
    }
}
