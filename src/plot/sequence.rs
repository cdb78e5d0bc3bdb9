//! Pictures of snapshots of any sort.

use std::ops::Range;
use std::path::Path;

use super::PlotError;
use super::canvas::Canvas;
use super::picture::titles::Titles;
use super::style::default_width;

/// The message if a table of pictures without one is asked for.
pub const NO_TABLE: &str = "there is no table of a view or a radiograph, but of a section: draw it as .png or \
                            .svg";

/// Pictures of some snapshots that share frame and colours.
pub trait Sequence {
    /// The titles of the pictures.
    fn titles(&self) -> &Titles;

    /// The section or viewpoint of the pictures, as their titles have it. May be empty.
    fn caption(&self) -> &str;

    /// One picture of some snapshots, by their indices among the paths, side by side in a width in
    /// pixels, with a text below its title and headings above its panels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held, [`PlotError::Read`] if a snapshot cannot
    /// be read.
    fn draw(
        &self,
        chosen: Range<usize>,
        subtitle: &str,
        headings: &[String],
        width: u32,
    ) -> Result<Canvas, PlotError>;

    /// The picture of one snapshot, by its place among the paths, of a width in pixels.
    ///
    /// # Errors
    /// As [`Self::draw`].
    fn single(&self, index: usize, width: Option<u32>) -> Result<Canvas, PlotError> {
        let subtitle = self.titles().subtitle(index, self.caption());
        let width = width.unwrap_or(default_width(1));
        self.draw(index..index + 1, &subtitle, &[], width)
    }

    /// One picture with a panel for each snapshot, of a width in pixels.
    ///
    /// # Errors
    /// As [`Self::draw`].
    fn panels(&self, width: Option<u32>) -> Result<Canvas, PlotError> {
        let count = self.titles().count();
        if count == 1 {
            return self.single(0, width);
        }
        let (headings, width) = (
            self.titles().headings(),
            width.unwrap_or(default_width(count)),
        );
        self.draw(0..count, self.caption(), &headings, width)
    }

    /// Writes what the pictures of some snapshots show, by their places among the paths, as a table.
    ///
    /// # Errors
    /// [`PlotError::Options`] if there is none of such pictures, [`PlotError::Save`] if the system refuses.
    fn save_table(
        &self,
        _chosen: Range<usize>,
        _width: Option<u32>,
        _path: &Path,
    ) -> Result<(), PlotError> {
        Err(PlotError::Options(NO_TABLE))
    }
}
