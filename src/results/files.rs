//! Small files that are either old or new, never half.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::{OutputError, Sheet, regular};

/// Ending of unfinished files and folders.
pub const PARTIAL: &str = ".partial";

/// The name under which a file or folder is written before it is renamed.
#[must_use]
pub fn partial(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(PARTIAL);
    name.into()
}

/// Replaces a file by new content, so that a reader at any time, or after a crash, sees the old
/// or the new one.
///
/// # Errors
/// [`OutputError::Io`].
pub fn write_atomically(path: &Path, content: &[u8]) -> Result<(), OutputError> {
    let temporary = partial(path);
    let mut file = File::create(&temporary).map_err(OutputError::io("create", &temporary))?;
    let written = file.write_all(content).and_then(|()| file.sync_all());
    let published = written
        .map_err(OutputError::io("write", &temporary))
        .and_then(|()| publish(&temporary, path));
    if published.is_err() {
        // What has not become the file is of no use, and on a full disk in the way.
        let _ = fs::remove_file(&temporary);
    }
    published
}

/// [`write_atomically`] of a value as indented JSON.
///
/// # Errors
/// [`OutputError::Io`].
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<(), OutputError> {
    let mut text = serde_json::to_vec_pretty(value)
        .map_err(std::io::Error::from)
        .map_err(OutputError::io("write", path))?;
    text.push(b'\n');
    write_atomically(path, &text)
}

/// Most bytes of one of our small files: those of the manifest of a checkpoint of 60 TB.
const SMALL: u64 = 64 << 20;

/// The length of an untrusted regular file that can be opened.
///
/// # Errors
/// [`OutputError::Io`].
pub fn length_of_regular(action: &'static str, path: &Path) -> Result<u64, OutputError> {
    let opened = regular::open_regular(path);
    opened.map_or_else(
        |e| Err(OutputError::io(action, path)(e)),
        |(_, length)| Ok(length),
    )
}

/// Reads a whole untrusted file.
///
/// # Errors
/// [`OutputError::Io`].
pub fn read_regular(path: &Path) -> Result<Vec<u8>, OutputError> {
    let content = regular::open_regular(path).and_then(|(mut file, _)| {
        let mut content = Vec::new();
        file.read_to_end(&mut content).map(|_| content)
    });
    content.map_err(OutputError::io("read", path))
}

/// Reads one of our small files, which is not trusted.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Damaged`] if it is no regular file or not small.
pub fn read_small(path: &Path) -> Result<Vec<u8>, OutputError> {
    regular::content(path, SMALL, "such a file").map_err(|error| match error.kind() {
        ErrorKind::InvalidInput | ErrorKind::FileTooLarge => {
            OutputError::damaged(path, error.to_string())
        }
        _ => OutputError::io("read", path)(error),
    })
}

/// Reads one of our small tables, which is not trusted.
///
/// # Errors
/// As [`read_small`], and [`OutputError::Damaged`] if it is no table.
pub fn read_sheet(path: &Path) -> Result<Sheet, OutputError> {
    let damaged = |reason: String| OutputError::damaged(path, reason);
    let text = String::from_utf8(read_small(path)?).map_err(|error| damaged(error.to_string()))?;
    Sheet::parse(&text).map_err(damaged)
}

/// Makes a folder within one that exists. No path is made anew by its name: what was removed or moved
/// stays so.
///
/// # Errors
/// [`OutputError::Io`].
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    match fs::create_dir(path) {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => {
            Err(OutputError::io("create the folder", path)(error))
        }
        _ => Ok(()),
    }
}

/// Gives a finished file or folder its name, and syncs its folder.
///
/// # Errors
/// [`OutputError::Io`].
pub fn publish(temporary: &Path, path: &Path) -> Result<(), OutputError> {
    fs::rename(temporary, path).map_err(OutputError::io("rename to", path))?;
    sync_folder(path.parent().unwrap_or(Path::new(".")))
}

/// Syncs a folder, so that renames and removals survive a power cut.
///
/// # Errors
/// [`OutputError::Io`].
pub fn sync_folder(folder: &Path) -> Result<(), OutputError> {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    File::open(folder)
        .and_then(|file| file.sync_all())
        .map_err(OutputError::io("sync the folder", folder))
}

/// Syncs a file; also returns the errors of writes that the system had deferred.
///
/// # Errors
/// [`OutputError::Io`].
pub fn sync_file(path: &Path) -> Result<(), OutputError> {
    File::open(path)
        .and_then(|file| file.sync_all())
        .map_err(OutputError::io("sync", path))
}

/// Removes a file or a whole folder if it exists.
///
/// # Errors
/// [`OutputError::Io`].
pub fn remove(path: &Path) -> Result<(), OutputError> {
    let result = match fs::symlink_metadata(path) {
        Ok(meta) if meta.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    };
    result.map_err(OutputError::io("remove", path))
}

/// Paths of all files and folders in a folder; none if there is no such folder.
///
/// # Errors
/// [`OutputError::Io`].
pub fn names_in(folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(OutputError::io("list", folder))?,
    };
    entries
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()
        .map_err(OutputError::io("list", folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("status.json");
        write_atomically(&path, b"old").unwrap();
        write_json(&path, &[0.1, 1e-30]).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text, "[\n  0.1,\n  1e-30\n]\n");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_cannot_be_published_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.html");
        fs::create_dir(&path).unwrap();
        assert!(write_atomically(&path, b"page").is_err());
        let left = fs::read_dir(folder.path()).unwrap();
        assert_eq!(left.count(), 1, "the folder alone");
    }

    #[test]
    fn an_error_names_the_file() {
        let error = write_atomically(Path::new("/nowhere/at/all"), b"").unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("cannot create /nowhere/at/all.partial: ")
        );
    }

    #[test]
    fn pipes_and_what_is_too_long_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |path: &Path| read_small(path).unwrap_err().to_string();
        assert!(refused(Path::new("/dev/zero")).contains("a device"));
        assert!(refused(folder.path()).contains("a folder"));
        let path = folder.path().join("manifest.json");
        assert!(refused(&path).contains("No such file"));
        File::create(&path).unwrap().set_len(1 << 40).unwrap();
        assert!(refused(&path).contains("67 MB that such a file may have"));
    }
}
