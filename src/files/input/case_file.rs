//! The file of a case.

use std::path::{Path, PathBuf};

use super::InputError;
use results::regular::content;

/// Longest file that is read as a case (bytes): that of some 10⁵ rows of a table of time.
const LONGEST_CASE: u64 = 16_000_000;

/// Complains of a path that is no text: the folder of a run, the files that a case names and what runs record of it
/// follow its path.
///
/// # Errors
/// [`InputError::Name`].
fn check_name(path: &Path) -> Result<(), InputError> {
    if path.to_str().is_some() {
        return Ok(());
    }
    let path = path.to_owned();
    Err(InputError::Name { path })
}

/// The path and the text of a case file, or of the `case.toml` in a folder.
///
/// # Errors
/// [`InputError::Name`], [`InputError::Read`], [`InputError::NoText`].
pub fn text(path: &Path) -> Result<(PathBuf, String), InputError> {
    check_name(path)?;
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
