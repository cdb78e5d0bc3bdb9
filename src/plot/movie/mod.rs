//! Movies: one picture after the other in one file.

mod apng;
mod gif;
mod palette;

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::PlotError;
use super::canvas::Canvas;

/// Formats of movies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A PNG file of several pictures, in all colours.
    Apng,
    /// A GIF file, of up to 256 colours.
    Gif,
}

impl Format {
    /// The format that the ending of a name says: `.apng`, `.png` or `.gif`.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "apng" | "png" => Some(Self::Apng),
            "gif" => Some(Self::Gif),
            _ => None,
        }
    }
}

/// Writes a movie of so many pictures, which `draw` makes one by one, that goes on for ever at a
/// number of pictures a second.
///
/// The file has its name once it is whole.
///
/// # Errors
/// [`PlotError`] of `draw`; [`PlotError::Save`] if the system refuses, or if pictures differ in
/// size; [`PlotError::Options`] for a name with another ending.
pub fn write(
    path: &Path,
    pictures: usize,
    fps: f64,
    draw: impl FnMut(usize) -> Result<Canvas, PlotError>,
) -> Result<(), PlotError> {
    let format = Format::of(path).ok_or(PlotError::Options(
        "a movie has a name that ends in .apng, .png or .gif",
    ))?;
    let part = beside(path);
    let failed = |reason: String| PlotError::Save {
        path: path.to_owned(),
        reason,
    };
    let file = File::create(&part).map_err(|e| failed(e.to_string()))?;
    let mut file = BufWriter::new(file);
    let written = match format {
        Format::Apng => apng::write(&mut file, pictures, fps, draw, failed),
        Format::Gif => gif::write(&mut file, pictures, fps, draw, failed),
    };
    let whole = written.and_then(|()| {
        let named = file.flush().and_then(|()| std::fs::rename(&part, path));
        named.map_err(|e| failed(e.to_string()))
    });
    if whole.is_err() {
        // What is not whole is of no use; the error is what counts.
        let _ = std::fs::remove_file(&part);
    }
    whole
}

/// The name of a file while it is written.
fn beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.part"))
}
