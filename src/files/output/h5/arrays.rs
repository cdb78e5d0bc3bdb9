//! Arrays of any HDF5 file, read by a single process without MPI.

use std::path::Path;

use crate::output::{Block, OutputError};

use super::explain;
use super::gate::Gate;

/// A file of arrays.
#[derive(Debug)]
pub struct ArrayFile(Gate);

impl ArrayFile {
    /// Opens a file for reading.
    ///
    /// # Errors
    /// If it is no HDF5 file.
    pub fn open(path: &Path) -> Result<Self, OutputError> {
        Gate::open(None, path).map(Self)
    }

    /// Names in the root group, in alphabetical order.
    ///
    /// # Errors
    /// The message of HDF5.
    pub fn names(&self) -> Result<Vec<String>, String> {
        self.0.members("/").map_err(|cause| explain(&cause))
    }

    /// Numbers in a row and all numbers of an array, row after row, those of integers converted.
    ///
    /// # Errors
    /// If there is no such array of numbers that lies in one piece.
    pub fn values(&self, name: &str) -> Result<(usize, Vec<f64>), String> {
        let read = || {
            let dataset = self.0.numbers(name)?;
            let bytes = dataset.bytes(Block {
                total: dataset.rows,
                first: 0,
                count: dataset.count(),
            })?;
            Ok((dataset.row.components, dataset.row.element.reals(&bytes)))
        };
        read().map_err(|cause: hdf5::Error| explain(&cause))
    }
}
