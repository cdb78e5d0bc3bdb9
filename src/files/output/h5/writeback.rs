//! Starts the system's writing of cached pages to the disk while the next rows are gathered. Otherwise
//! Linux begins when some tenth of all memory is full, or when the file is closed.

use std::fs::File;

/// Starts writing all dirty pages of a file. Where the system cannot, they go when the file is synced.
pub fn begin_writeback(file: &File) {
    #[cfg(target_os = "linux")]
    {
        use std::os::fd::AsRawFd;
        // SAFETY: the file is open.
        unsafe { libc::sync_file_range(file.as_raw_fd(), 0, 0, libc::SYNC_FILE_RANGE_WRITE) };
    }
    #[cfg(not(target_os = "linux"))]
    let _ = file;
}
