//! Results of runs for crates that know neither HDF5 nor inputs.

use std::path::Path;

use model::Case;
use results::{Opener, OutputError, ReadError, Sheet, SnapshotReader};

use crate::input;
use crate::output::h5::read::SnapshotFile;
use crate::output::{RunFolder, gauge_records};

/// Opens results as runs write them.
#[derive(Debug)]
pub struct FileOpener;

impl Opener for FileOpener {
    fn snapshot(&self, path: &Path) -> Result<Box<dyn SnapshotReader>, ReadError> {
        Ok(Box::new(SnapshotFile::open(path)?))
    }

    fn gauges(&self, run: &Path, only: Option<&[String]>) -> Result<Option<Sheet>, OutputError> {
        gauge_records::sheet(&RunFolder::at(run), only)
    }

    fn case(&self, path: &Path) -> Result<Case, String> {
        input::load(path, &[]).map_err(|error| error.to_string())
    }
}
