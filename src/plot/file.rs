//! Files of pictures, which have their names when they are whole.

use std::fs;
use std::path::Path;

use super::PlotError;
use results::{NewFile, OutputError};

/// Writes a file; its folder is made if it lacks. What is there and no file, as a terminal or a pipe, gets
/// the content as it is: nothing can take its name.
///
/// # Errors
/// [`PlotError::Save`] if the system refuses.
pub fn save(path: &Path, content: &[u8]) -> Result<(), PlotError> {
    let takes = |metadata: fs::Metadata| !metadata.is_file() && !metadata.is_dir();
    if fs::metadata(path).is_ok_and(takes) {
        return fs::write(path, content).map_err(|error| PlotError::unsaved(path, error));
    }
    save_by(path, |file| file.put(content).map_err(unsaved(path)))
}

/// Writes what `write` puts into a file; its folder is made if it lacks.
///
/// # Errors
/// Those of `write`; [`PlotError::Save`] if the system refuses.
pub fn save_by(
    path: &Path,
    write: impl FnOnce(&mut NewFile) -> Result<(), PlotError>,
) -> Result<(), PlotError> {
    let mut file = NewFile::create(path).map_err(unsaved(path))?;
    write(&mut file)?;
    file.finish().map_err(unsaved(path))
}

/// The error of the system, for the file that was asked for.
fn unsaved(path: &Path) -> impl Fn(OutputError) -> PlotError {
    move |error| match error {
        OutputError::Io { source, .. } => PlotError::unsaved(path, source),
        other => PlotError::unsaved(path, other),
    }
}
