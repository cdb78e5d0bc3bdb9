//! The text of a case file, or why there is none.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::InputError;

/// Longest file that is read as a case (bytes): that of some 10⁵ rows of a table of time.
pub const MOST_BYTES: u64 = 16_000_000;

/// The path and the text of a case file, or of the `case.toml` in a folder.
///
/// # Errors
/// [`InputError::Read`], [`InputError::TooLong`] before anything is read, [`InputError::NoText`].
pub fn text(path: &Path) -> Result<(PathBuf, String), InputError> {
    let path = if path.is_dir() {
        path.join("case.toml")
    } else {
        path.to_owned()
    };
    let failed = |cause| InputError::Read {
        path: path.clone(),
        cause,
    };
    let too_long = |size| InputError::TooLong {
        path: path.clone(),
        size,
    };
    let file = File::open(&path).map_err(failed)?;
    let bytes = file.metadata().map_err(failed)?.len();
    if bytes > MOST_BYTES {
        return Err(too_long(format!("{} MB", bytes.div_ceil(1_000_000))));
    }
    let mut read = Vec::new();
    // A device has no length and may have no end.
    file.take(MOST_BYTES + 1)
        .read_to_end(&mut read)
        .map_err(failed)?;
    if read.len() as u64 > MOST_BYTES {
        return Err(too_long("no end".to_owned()));
    }
    match String::from_utf8(read) {
        Ok(text) => Ok((path, text)),
        Err(error) => {
            let (at, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
            Err(InputError::NoText {
                path,
                line: 1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count(),
                byte: bytes[at],
            })
        }
    }
}
