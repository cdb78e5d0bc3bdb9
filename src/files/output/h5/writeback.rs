//! Starts the system's writing of cached pages to the disk while the next rows are gathered. Otherwise
//! Linux begins when some tenth of all memory is full, or when the file is closed.

use std::fs::File;
use std::path::Path;

/// A file whose rows go to the disk as soon as they are written.
pub struct Writeback(Option<File>);

impl Writeback {
    /// Of an existing file. Without it nothing happens: the file is synced at its end anyway.
    pub fn of(path: &Path) -> Self {
        Self(File::options().write(true).open(path).ok())
    }

    /// Starts writing all dirty pages.
    pub fn begin(&self) {
        #[cfg(target_os = "linux")]
        if let Some(file) = &self.0 {
            use std::os::fd::AsRawFd;
            // SAFETY: the file is open.
            unsafe { libc::sync_file_range(file.as_raw_fd(), 0, 0, libc::SYNC_FILE_RANGE_WRITE) };
        }
    }
}
