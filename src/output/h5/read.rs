//! Reading snapshots back: one VTKHDF file, opened by a single process without MPI.

use std::ops::Range;
use std::path::{Path, PathBuf};

use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenAscii, VarLenUnicode};
use hdf5::{Attribute, Dataset, Hyperslab, SliceOrIndex};

/// Largest string attribute that HDF5 stores with its object (bytes).
const LONGEST_TEXT: usize = 64 * 1024;

/// Why a snapshot could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file is missing, is not HDF5 or is damaged.
    #[error("cannot open {} as an HDF5 file: {reason}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What HDF5 or the system says.
        reason: String,
    },
    /// HDF5, but without something that every snapshot has.
    #[error(
        "{} is not a whipple snapshot: {what} cannot be read ({reason}); give a file of the run's \
         snapshots folder",
        path.display()
    )]
    Layout {
        /// The file.
        path: PathBuf,
        /// The object or attribute that was looked for.
        what: String,
        /// What HDF5 says.
        reason: String,
    },
}

/// An open snapshot. Rows are particles in the order of their ids.
#[derive(Debug)]
pub struct SnapshotFile {
    file: hdf5::File,
    path: PathBuf,
    particles: usize,
}

impl SnapshotFile {
    /// Opens a snapshot for reading.
    ///
    /// # Errors
    /// [`ReadError::Open`] if it is no HDF5 file, [`ReadError::Layout`] if it holds no points.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let open = |reason: String| ReadError::Open {
            path: path.to_owned(),
            reason,
        };
        // The system's message ("permission denied") is clearer than HDF5's.
        std::fs::File::open(path).map_err(|e| open(e.to_string()))?;
        let file = hdf5::File::open(path).map_err(|e| open(e.to_string()))?;
        let mut snapshot = Self {
            file,
            path: path.to_owned(),
            particles: 0,
        };
        let shape = snapshot.dataset("/VTKHDF/Points")?.shape();
        let [rows, 3] = shape[..] else {
            let reason = format!("its shape is {shape:?}, not [particles, 3]");
            return Err(snapshot.layout("/VTKHDF/Points", &reason));
        };
        snapshot.particles = rows;
        Ok(snapshot)
    }

    /// The file's path as it was opened.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of particles n.
    #[must_use]
    pub fn particles(&self) -> usize {
        self.particles
    }

    /// Time of the snapshot (s).
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the file has no time.
    pub fn time(&self) -> Result<f64, ReadError> {
        let name = "/VTKHDF/FieldData/TimeValue";
        let values = self.dataset(name)?.read_raw::<f64>();
        let values = values.map_err(|e| self.layout(name, &e))?;
        let first = values.first().copied();
        first.ok_or_else(|| self.layout(name, &"it is empty"))
    }

    /// Positions of a range of particles, `[rows][3]` (m).
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the rows cannot be read.
    pub fn points(&self, rows: Range<usize>) -> Result<Vec<[f64; 3]>, ReadError> {
        let flat = self.read("/VTKHDF/Points", rows)?;
        let (points, _) = flat.as_chunks::<3>();
        Ok(points.to_vec())
    }

    /// Names of the particle fields, in alphabetical order.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the file has no particle data.
    pub fn names(&self) -> Result<Vec<String>, ReadError> {
        let name = "/VTKHDF/PointData";
        let group = self.file.group(name).map_err(|e| self.layout(name, &e))?;
        let mut names = group.member_names().map_err(|e| self.layout(name, &e))?;
        names.sort();
        Ok(names)
    }

    /// Numbers for each particle in a field: 1, 3 (x, y, z) or 6 (xx, yy, zz, xy, yz, xz).
    ///
    /// # Errors
    /// [`ReadError::Layout`] if there is no such field or its shape fits no particles.
    pub fn components(&self, field: &str) -> Result<usize, ReadError> {
        let name = field_path(field);
        let shape = self.dataset(&name)?.shape();
        match shape[..] {
            [rows] if rows == self.particles => Ok(1),
            [rows, width] if rows == self.particles => Ok(width),
            _ => {
                let n = self.particles;
                let reason = format!("its shape {shape:?} does not fit {n} particles");
                Err(self.layout(&name, &reason))
            }
        }
    }

    /// A field of a range of particles, row after row, `[rows × components]` in the field's unit;
    /// integer fields are converted.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if there is no such field or the rows cannot be read.
    pub fn values(&self, field: &str, rows: Range<usize>) -> Result<Vec<f64>, ReadError> {
        self.read(&field_path(field), rows)
    }

    /// One component of a field for a range of particles, `[rows]` in the field's unit.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if there is no such field or component.
    pub fn scalar(
        &self,
        field: &str,
        component: usize,
        rows: Range<usize>,
    ) -> Result<Vec<f64>, ReadError> {
        let width = self.components(field)?;
        if component >= width {
            let reason = format!("it has {width} components, {component} was asked for");
            return Err(self.layout(&field_path(field), &reason));
        }
        let mut values = self.values(field, rows)?;
        if width > 1 {
            values = values.into_iter().skip(component).step_by(width).collect();
        }
        Ok(values)
    }

    /// A string attribute of a particle field, such as `unit`.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the field or the attribute is missing or no string.
    pub fn field_attribute(&self, field: &str, name: &str) -> Result<String, ReadError> {
        let path = field_path(field);
        let attribute = self.dataset(&path)?.attr(name);
        self.text(&format!("attribute {name} of {path}"), attribute)
    }

    /// A string attribute of a group, such as `title` of `/whipple`.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the group or the attribute is missing or no string.
    pub fn attribute(&self, group: &str, name: &str) -> Result<String, ReadError> {
        let attribute = self.file.group(group).and_then(|g| g.attr(name));
        self.text(&format!("attribute {name} of {group}"), attribute)
    }

    /// A whole number that is an attribute of a group, such as `dimension` of `/whipple`.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if the group or the attribute is missing or no number.
    pub fn number(&self, group: &str, name: &str) -> Result<u64, ReadError> {
        let attribute = self.file.group(group).and_then(|g| g.attr(name));
        let number = attribute.and_then(|a| a.read_scalar::<u64>());
        number.map_err(|e| self.layout(&format!("attribute {name} of {group}"), &e))
    }

    /// Rows of a dataset of one or two dimensions.
    fn read(&self, name: &str, rows: Range<usize>) -> Result<Vec<f64>, ReadError> {
        let dataset = self.dataset(name)?;
        let flat = if dataset.ndim() == 1 {
            let values = dataset.read_slice_1d(rows);
            values.map(|array| array.into_raw_vec_and_offset().0)
        } else {
            let block = Hyperslab::from(vec![SliceOrIndex::from(rows), SliceOrIndex::from(..)]);
            let values = dataset.read_slice_2d(block);
            values.map(|array| array.into_raw_vec_and_offset().0)
        };
        flat.map_err(|e| self.layout(name, &e))
    }

    fn dataset(&self, name: &str) -> Result<Dataset, ReadError> {
        self.file.dataset(name).map_err(|e| self.layout(name, &e))
    }

    /// The text of an attribute, whichever of HDF5's string types it was written with.
    fn text(&self, what: &str, attribute: hdf5::Result<Attribute>) -> Result<String, ReadError> {
        attribute
            .and_then(|a| read_text(&a))
            .map_err(|e| self.layout(what, &e))
    }

    fn layout(&self, what: &str, reason: &dyn ToString) -> ReadError {
        ReadError::Layout {
            path: self.path.clone(),
            what: what.to_owned(),
            reason: reason.to_string(),
        }
    }
}

fn field_path(field: &str) -> String {
    format!("/VTKHDF/PointData/{field}")
}

fn read_text(attribute: &Attribute) -> hdf5::Result<String> {
    fn first<T: hdf5::H5Type + ToString>(attribute: &Attribute) -> hdf5::Result<String> {
        let values = attribute.read_raw::<T>()?;
        Ok(values.first().map(T::to_string).unwrap_or_default())
    }
    match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::VarLenUnicode => first::<VarLenUnicode>(attribute),
        TypeDescriptor::VarLenAscii => first::<VarLenAscii>(attribute),
        TypeDescriptor::FixedUnicode(_) => first::<FixedUnicode<LONGEST_TEXT>>(attribute),
        TypeDescriptor::FixedAscii(_) => first::<FixedAscii<LONGEST_TEXT>>(attribute),
        other => Err(format!("it is no string but {other}").into()),
    }
}
