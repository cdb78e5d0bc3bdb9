//! Files that a user names: regular ones of a bounded size, since a pipe or a device has no end.

use std::fs::{File, FileType};
use std::io::{self, Read};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;

/// Opens a regular file; gives its length (bytes) too.
///
/// # Errors
/// That of the system; [`io::ErrorKind::InvalidInput`] for a pipe, a device or a folder.
pub fn open_regular(path: &Path) -> io::Result<(File, u64)> {
    // Without the flag the opening of a pipe waits for somebody to write to it.
    let file = File::options()
        .read(true)
        .custom_flags(libc::O_NONBLOCK)
        .open(path)?;
    let metadata = file.metadata()?;
    if let Some(kind) = not_regular(metadata.file_type()) {
        let why = format!("it is {kind}, not a regular file");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    }
    Ok((file, metadata.len()))
}

/// The content of a regular file of at most `longest` bytes, which are those of `what`.
///
/// # Errors
/// As [`open_regular`]; [`io::ErrorKind::FileTooLarge`] before more than that is read.
pub fn content(path: &Path, longest: u64, what: &str) -> io::Result<Vec<u8>> {
    let (file, length) = open_regular(path)?;
    let most = longest / 1_000_000;
    let too_long = |size: &str| {
        let why = format!("it has {size}, more than the {most} MB that {what} may have");
        io::Error::new(io::ErrorKind::FileTooLarge, why)
    };
    if length > longest {
        let size = length.div_ceil(1_000_000);
        return Err(too_long(&format!("{size} MB")));
    }
    let mut content = Vec::new();
    // It may have grown, or be one of those that the system makes up as they are read.
    file.take(longest + 1).read_to_end(&mut content)?;
    if content.len() as u64 > longest {
        return Err(too_long("no end"));
    }
    Ok(content)
}

/// Name of a kind of file, if it is no regular file.
fn not_regular(kind: FileType) -> Option<&'static str> {
    if kind.is_file() {
        None
    } else if kind.is_dir() {
        Some("a folder")
    } else if kind.is_fifo() {
        Some("a pipe")
    } else {
        Some("a device or a socket")
    }
}
