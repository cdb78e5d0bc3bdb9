//! The arrays and notes of a file, bit for bit: read by one process, or by all ranks together.

use std::path::{Path, PathBuf};

use crate::output::{Block, OutputError};
use comm::Comm;

use super::gate::{self, Gate, Located};
use super::{Element, Number, RowType, explain};

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
    gate: Gate,
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
    /// same calls in the same order. Errors of those calls are each rank's own. Collective.
    ///
    /// # Errors
    /// [`OutputError::Io`] or [`OutputError::Hdf5`], the same on every rank.
    pub fn open_shared(comm: &Comm, path: &Path) -> Result<Self, OutputError> {
        Self::open_with(Some(comm), path)
    }

    fn open_with(comm: Option<&Comm>, path: &Path) -> Result<Self, OutputError> {
        Ok(Self {
            path: path.to_owned(),
            gate: Gate::open(comm, path)?,
        })
    }

    /// The file's path as it was opened.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns true if there is a group or dataset of this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.gate.has(name)
    }

    /// The datasets of a group, all of them fields, in alphabetical order.
    ///
    /// # Errors
    /// As [`Self::array`].
    pub fn arrays(&self, group: &str) -> Result<Vec<Array>, OutputError> {
        let names = self.converted(group, self.gate.members(group))?;
        let array = |name: &String| self.array(&format!("{group}/{name}"));
        names.iter().map(array).collect()
    }

    /// The type, size and notes of a dataset of numbers.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] if there is none, or if it is not one as the program writes.
    pub fn array(&self, path: &str) -> Result<Array, OutputError> {
        let rows = self.numbers(path)?;
        Ok(Array {
            name: path.rsplit('/').next().unwrap_or(path).to_owned(),
            row: rows.row,
            rows: rows.rows,
            unit: self.converted(&format!("the unit of {path}"), rows.note_if_any("unit"))?,
            description: self.converted(
                &format!("the description of {path}"),
                rows.note_if_any("description"),
            )?,
        })
    }

    /// Reads a block of a dataset's rows, of the type that [`Self::array`] returned, into `bytes`,
    /// which is as long.
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
        let rows = self.numbers(path)?;
        let read = if rows.row == row {
            rows.read(block, bytes)
        } else {
            Err("its rows have another type".into())
        };
        self.converted(path, read)
    }

    /// All of a short dataset of single values.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn all<T: Number>(&self, path: &str) -> Result<Vec<T>, OutputError> {
        let rows = self.numbers(path)?;
        if rows.row != RowType::single(T::ELEMENT) {
            let what = format!("its rows are not of one {} each", T::ELEMENT.name());
            return self.converted(path, Err(what.into()));
        }
        self.values(path, &rows)
    }

    /// All ids of a dataset. VTK has no unsigned ones, so snapshots keep their bits as `i64`.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn ids(&self, path: &str) -> Result<Vec<u64>, OutputError> {
        let rows = self.numbers(path)?;
        let known = [Element::U64, Element::I64].map(RowType::single);
        if !known.contains(&rows.row) {
            return self.converted(path, Err("its rows are no ids".into()));
        }
        self.values(path, &rows)
    }

    /// Number of partitions of a grid's points.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`], also if they cannot be those of its points.
    pub fn partitions(&self, grid: &str) -> Result<u64, OutputError> {
        let points = self.numbers(&format!("{grid}/Points"))?.rows;
        let what = format!("{grid}/NumberOfPoints");
        self.converted(&what, self.gate.partitions(grid, points))
    }

    /// A text dataset.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`], [`OutputError::Damaged`] if it is no UTF-8.
    pub fn text(&self, path: &str) -> Result<String, OutputError> {
        let bytes = self.converted(path, self.gate.text(path))?;
        let text = String::from_utf8(bytes);
        text.map_err(|e| OutputError::damaged(&self.path, format!("{path}: {e}")))
    }

    /// A text attribute of a group.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn note(&self, group: &str, name: &str) -> Result<String, OutputError> {
        let note = self.gate.group(group).and_then(|g| gate::note(&g, name));
        self.converted(name, note)
    }

    /// A text attribute of a group, if there is one.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn note_if_any(&self, group: &str, name: &str) -> Result<Option<String>, OutputError> {
        let note = self.gate.group(group);
        let note = note.and_then(|g| gate::note_if_any(&g, name));
        self.converted(name, note)
    }

    /// A number attached to a group.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn number<T: Number>(&self, group: &str, name: &str) -> Result<T, OutputError> {
        let number = self.gate.group(group).and_then(|g| gate::number(&g, name));
        self.converted(name, number)
    }

    fn numbers(&self, path: &str) -> Result<Located, OutputError> {
        self.converted(path, self.gate.numbers(path))
    }

    /// All values of a dataset whose rows are single values as wide as `T`.
    fn values<T: bytemuck::Pod>(&self, path: &str, rows: &Located) -> Result<Vec<T>, OutputError> {
        let block = Block::even(rows.rows, 0, 1);
        let mut values = vec![T::zeroed(); block.count];
        let read = rows.read(block, bytemuck::cast_slice_mut(&mut values));
        self.converted(path, read)?;
        Ok(values)
    }

    fn converted<T>(&self, what: &str, result: hdf5::Result<T>) -> Result<T, OutputError> {
        result.map_err(|error| OutputError::Hdf5 {
            action: format!("read {what} from"),
            path: self.path.clone(),
            reason: explain(&error),
        })
    }
}
