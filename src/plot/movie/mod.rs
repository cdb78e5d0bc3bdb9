//! Movies: one picture after the other in one file.

mod apng;
mod gif;
mod palette;

use std::path::Path;

use super::PlotError;
use super::canvas::Canvas;
use super::file;

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
/// The file has its name once it is whole; its folder is made if it lacks.
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
    let failed = |reason: String| PlotError::unsaved(path, reason);
    file::save_by(path, |file| match format {
        Format::Apng => apng::write(file, pictures, fps, draw, failed),
        Format::Gif => gif::write(file, pictures, fps, draw, failed),
    })
}
