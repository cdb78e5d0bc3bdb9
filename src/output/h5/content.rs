//! The arrays and notes of a file, bit for bit: read by one process, or by all ranks together.

use std::path::{Path, PathBuf};

use hdf5::types::TypeDescriptor;
use hdf5::{Dataset, File, Group, H5Type, Location};

use crate::comm::Comm;
use crate::output::{Block, OutputError};

use super::transfer::{call, read_rows};
use super::{Element, RowType, access, explain};

/// A dataset of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Array {
    /// Its name in its group.
    pub name: String,
    /// Its rows' type.
    pub row: RowType,
    /// Number of rows.
    pub rows: u64,
    /// SI unit; empty for none.
    pub unit: String,
    /// One sentence.
    pub description: String,
}

/// A file open for reading.
#[derive(Debug)]
pub struct Content {
    path: PathBuf,
    file: File,
}

impl Content {
    /// Opens a file, without MPI.
    ///
    /// # Errors
    /// [`OutputError::Io`] or [`OutputError::Hdf5`].
    pub fn open(path: &Path) -> Result<Self, OutputError> {
        Self::open_with(None, path)
    }

    /// Opens a file on all ranks together, which share the reading of its records: all make the
    /// same calls in the same order. Errors are each rank's own.
    ///
    /// # Errors
    /// [`OutputError::Io`] or [`OutputError::Hdf5`].
    pub fn open_shared(comm: &Comm, path: &Path) -> Result<Self, OutputError> {
        Self::open_with(Some(comm), path)
    }

    fn open_with(comm: Option<&Comm>, path: &Path) -> Result<Self, OutputError> {
        // The system's message ("no such file") is clearer than HDF5's.
        std::fs::File::open(path).map_err(OutputError::io("open", path))?;
        let opened = access(comm).open(path);
        let file = opened.map_err(|error| OutputError::Hdf5 {
            action: "open as HDF5".to_owned(),
            path: path.to_owned(),
            reason: explain(&error),
        })?;
        Ok(Self {
            path: path.to_owned(),
            file,
        })
    }

    /// The file's path as it was opened.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether there is a group or dataset of this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.file.link_exists(name)
    }

    /// The datasets of a group, in alphabetical order.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn arrays(&self, group: &str) -> Result<Vec<Array>, OutputError> {
        let names = self.file.group(group).and_then(|g| g.member_names());
        let mut names = names.map_err(|e| self.refusal(group, &e))?;
        names.sort();
        let array = |name: &String| self.array(&format!("{group}/{name}"));
        names.iter().map(array).collect()
    }

    /// A dataset's type, size and notes.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if there is none, or if its type is not one of [`Element`].
    pub fn array(&self, path: &str) -> Result<Array, OutputError> {
        let describe = || {
            let dataset = self.file.dataset(path)?;
            let (rows, components) = match dataset.shape()[..] {
                [rows] => (rows, 1),
                [rows, components] => (rows, components),
                ref shape => return Err(format!("unexpected shape {shape:?}").into()),
            };
            let row = RowType {
                element: Element::of(&dataset.dtype()?)?,
                components,
            };
            // Nothing is compressed: what is longer than the file would only take memory.
            let length = (rows as u64).checked_mul(row.bytes() as u64);
            if length.is_none_or(|length| length > self.file.size()) {
                return Err(format!("{rows} rows are more than the file holds").into());
            }
            Ok(Array {
                name: path.rsplit('/').next().unwrap_or(path).to_owned(),
                row,
                rows: rows as u64,
                unit: note_of(&dataset, "unit").unwrap_or_default(),
                description: note_of(&dataset, "description").unwrap_or_default(),
            })
        };
        describe().map_err(|e| self.refusal(path, &e))
    }

    /// Reads a block of a dataset's rows into `bytes`, which is as long.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn rows(
        &self,
        path: &str,
        row: RowType,
        block: Block,
        bytes: &mut [u8],
    ) -> Result<(), OutputError> {
        let dataset = self.dataset(path)?;
        let read = read_rows(&dataset, row, block, bytes);
        read.map_err(|e| self.refusal(path, &e))
    }

    /// All of a short dataset.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn all<T: bytemuck::Pod>(&self, path: &str) -> Result<Vec<T>, OutputError> {
        let array = self.array(path)?;
        let bytes = self.all_bytes(path, &array)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// A text dataset.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`], [`OutputError::Damaged`] if it is no UTF-8.
    pub fn text(&self, path: &str) -> Result<String, OutputError> {
        let array = self.array(path)?;
        let bytes = self.all_bytes(path, &array)?;
        let text = String::from_utf8(bytes);
        let text = text.map_err(|e| OutputError::damaged(&self.path, format!("{path}: {e}")))?;
        Ok(text.trim_end_matches('\0').to_owned())
    }

    fn all_bytes(&self, path: &str, array: &Array) -> Result<Vec<u8>, OutputError> {
        let block = Block::even(array.rows, 0, 1);
        let mut bytes = vec![0; block.count * array.row.bytes()];
        self.rows(path, array.row, block, &mut bytes)?;
        Ok(bytes)
    }

    /// A text attribute of a group.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn note(&self, group: &str, name: &str) -> Result<String, OutputError> {
        let note = self.group(group)?;
        note_of(&note, name).map_err(|e| self.refusal(name, &e))
    }

    /// A number attached to a group.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn number<T: H5Type>(&self, group: &str, name: &str) -> Result<T, OutputError> {
        let number = self.group(group)?.attr(name);
        let number = number.and_then(|attribute| attribute.read_scalar());
        number.map_err(|e| self.refusal(name, &e))
    }

    fn group(&self, name: &str) -> Result<Group, OutputError> {
        self.file.group(name).map_err(|e| self.refusal(name, &e))
    }

    fn dataset(&self, path: &str) -> Result<Dataset, OutputError> {
        self.file.dataset(path).map_err(|e| self.refusal(path, &e))
    }

    fn refusal(&self, what: &str, error: &hdf5::Error) -> OutputError {
        OutputError::Hdf5 {
            action: format!("read {what} from"),
            path: self.path.clone(),
            reason: explain(error),
        }
    }
}

/// A text attribute as the [`super::Writer`] makes it.
fn note_of(object: &Location, name: &str) -> hdf5::Result<String> {
    let attribute = object.attr(name)?;
    let datatype = attribute.dtype()?;
    match datatype.to_descriptor()? {
        TypeDescriptor::FixedUnicode(bytes) | TypeDescriptor::FixedAscii(bytes) => {
            let mut text = vec![0_u8; bytes];
            // SAFETY: the buffer is as long as the type says.
            call(|| unsafe {
                hdf5_sys::h5a::H5Aread(attribute.id(), datatype.id(), text.as_mut_ptr().cast())
            })?;
            let text = String::from_utf8(text).map_err(|e| e.to_string())?;
            Ok(text.trim_end_matches('\0').to_owned())
        }
        other => Err(format!("{name} is no text but {other}").into()),
    }
}
