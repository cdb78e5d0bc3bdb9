//! The file of a case.

use std::path::{Path, PathBuf};

use super::InputError;
use results::regular::content;

/// Longest file that is read as a case (bytes): that of some 10⁵ rows of a table of time.
const LONGEST_CASE: u64 = 16_000_000;

/// The path and the text of a case file, or of the `case.toml` in a folder.
///
/// # Errors
/// [`InputError::Read`], [`InputError::NoText`].
pub fn text(path: &Path) -> Result<(PathBuf, String), InputError> {
    let path = if path.is_dir() {
        path.join("case.toml")
    } else {
        path.to_owned()
    };
    let read = match content(&path, LONGEST_CASE, "a case") {
        Ok(read) => read,
        Err(cause) => return Err(InputError::Read { path, cause }),
    };
    match String::from_utf8(read) {
        Ok(text) => Ok((path, text)),
        Err(error) => {
            let (at, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
            Err(InputError::NoText {
                path,
                line: bytes[..at].split(|&byte| byte == b'\n').count(),
                byte: bytes[at],
            })
        }
    }
}
