//! The allocator of the program: the system's, which says that memory is out.
//!
//! The standard library would look for a backtrace then, for which it needs memory.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::{Cursor, Write};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use files::run::exit::EXIT_FAILED;

/// The system's allocator; a program whose memory is out ends with one message.
#[derive(Debug)]
pub struct Memory;

// SAFETY: all calls go to the system's allocator as they are, and what it gives is given on, unless it is nothing.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's contract.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's contract.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller's contract.
        given(unsafe { System.realloc(old, layout, size) }, size)
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        // SAFETY: the caller's contract.
        unsafe { System.dealloc(old, layout) }
    }
}

/// The place of so many bytes, unless there is none.
fn given(place: *mut u8, bytes: usize) -> *mut u8 {
    if place.is_null() {
        out_of_memory(bytes);
    }
    place
}

/// Ends the process with a message, without more memory.
#[cold]
fn out_of_memory(bytes: usize) -> ! {
    static TOLD: AtomicBool = AtomicBool::new(false);
    let mut text = [0_u8; 128];
    let mut writer = Cursor::new(&mut text[..]);
    let _ = writeln!(
        writer,
        "error: out of memory: {bytes} bytes more are not to be had"
    );
    #[expect(clippy::cast_possible_truncation, reason = "at most 128")]
    let length = writer.position() as usize;
    if TOLD.swap(true, Relaxed) {
        // Another thread ends the process.
        loop {
            std::thread::park();
        }
    }
    // SAFETY: the text is as long, and the process ends here.
    unsafe {
        libc::write(libc::STDERR_FILENO, text.as_ptr().cast(), length);
        libc::_exit(EXIT_FAILED.into())
    }
}
