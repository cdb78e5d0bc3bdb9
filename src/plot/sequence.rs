//! Pictures of snapshots, of whatever kind.

use std::ops::Range;
use std::path::Path;

use super::PlotError;
use super::canvas::Canvas;

/// What is said where a table of pictures without one is asked for.
pub const NO_TABLE: &str = "there is no table of a view or a radiograph, but of a section: draw it as .png or \
                            .svg";

/// Pictures of some snapshots that share frame and colours.
pub trait Sequence {
    /// The picture of one snapshot, by its place among the paths, of a width in pixels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if no such picture can be held, [`PlotError::Read`] if the snapshot
    /// cannot be read.
    fn single(&self, index: usize, width: Option<u32>) -> Result<Canvas, PlotError>;

    /// One picture with a panel for each snapshot, of a width in pixels.
    ///
    /// # Errors
    /// As [`Self::single`].
    fn panels(&self, width: Option<u32>) -> Result<Canvas, PlotError>;

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
