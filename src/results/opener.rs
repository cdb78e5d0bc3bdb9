//! What reads results that are not plain text.

use std::fmt::Debug;
use std::ops::Range;
use std::path::Path;

use model::Case;

use crate::{OutputError, ReadError, Sheet};

/// Opens the results of runs.
pub trait Opener: Debug + Sync {
    /// Opens a snapshot.
    ///
    /// # Errors
    /// [`ReadError::Open`] if it is no HDF5 file or lies in the folder of another run,
    /// [`ReadError::Layout`] if it is no snapshot.
    fn snapshot(&self, path: &Path) -> Result<Box<dyn SnapshotReader>, ReadError>;

    /// Reads what many gauges have read in the folder of a run; of the gauges `only`, if these are given.
    /// `None` if there is no such file.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Hdf5`], [`OutputError::Damaged`].
    fn gauges(&self, run: &Path, only: Option<&[String]>) -> Result<Option<Sheet>, OutputError>;

    /// Reads the input of a run.
    ///
    /// # Errors
    /// A message if it cannot be read or is not valid.
    fn case(&self, path: &Path) -> Result<Case, String>;
}

/// An open snapshot. Rows are particles in the order of their ids.
pub trait SnapshotReader: Debug + Send + Sync {
    /// The file's path as it was opened.
    #[must_use]
    fn path(&self) -> &Path;

    /// Number of particles n.
    #[must_use]
    fn particles(&self) -> usize;

    /// Time of the snapshot (s).
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the file has no time.
    fn time(&self) -> Result<f64, ReadError>;

    /// Positions of a range of particles, `[rows][3]` (m).
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the rows cannot be read.
    fn points(&self, rows: Range<usize>) -> Result<Vec<[f64; 3]>, ReadError>;

    /// Names of the particle fields, in alphabetical order.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the file has no particle data.
    fn names(&self) -> Result<Vec<String>, ReadError>;

    /// Numbers for each particle in a field: 1, 3 (x, y, z) or 6 (xx, yy, zz, xy, yz, xz).
    ///
    /// # Errors
    /// [`ReadError::Layout`] if there is no such field or its shape fits no particles.
    fn components(&self, field: &str) -> Result<usize, ReadError>;

    /// A field of a range of particles, row after row, `[rows × components]` in the field's unit;
    /// integer fields are converted.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if there is no such field or the rows cannot be read.
    fn values(&self, field: &str, rows: Range<usize>) -> Result<Vec<f64>, ReadError>;

    /// One component of a field for a range of particles, `[rows]` in the field's unit.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if there is no such field or component.
    fn scalar(
        &self,
        field: &str,
        component: usize,
        rows: Range<usize>,
    ) -> Result<Vec<f64>, ReadError>;

    /// A string attribute of a particle field, such as `unit`.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the field or the attribute is missing or no string.
    fn field_attribute(&self, field: &str, name: &str) -> Result<String, ReadError>;

    /// A string attribute of a group, such as `title` of `/whipple`.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the group or the attribute is missing or no string.
    fn attribute(&self, group: &str, name: &str) -> Result<String, ReadError>;

    /// A whole number that is an attribute of a group, such as `dimension` of `/whipple`.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the group or the attribute is missing or not a number.
    fn number(&self, group: &str, name: &str) -> Result<u64, ReadError>;
}
