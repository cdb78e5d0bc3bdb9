//! Movies: one picture after the other in one file.

mod apng;
mod gif;
mod palette;
mod patch;

use std::path::Path;

use super::PlotError;
use super::canvas::Canvas;
use super::file;
use super::pixels::Pixels;

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
    file::save_by(path, |file| {
        let pictures = drawn(path, pictures, draw);
        match format {
            Format::Apng => apng::write(file, path, pictures, fps),
            Format::Gif => gif::write(file, path, pictures, fps),
        }
    })
}

/// The pixels of so many pictures, one by one, all of one size.
fn drawn(
    path: &Path,
    pictures: usize,
    mut draw: impl FnMut(usize) -> Result<Canvas, PlotError>,
) -> impl ExactSizeIterator<Item = Result<Pixels, PlotError>> {
    let mut size = None;
    (0..pictures).map(move |k| {
        let picture = draw(k)?.pixels()?;
        let own = [picture.width, picture.height];
        if *size.get_or_insert(own) == own {
            Ok(picture)
        } else {
            Err(PlotError::unsaved(path, "its pictures differ in size"))
        }
    })
}
