//! Positions of particles at the start of the run, from its first snapshot.

use std::path::Path;

use super::ExportError;
use files::output::RunFolder;
use files::output::h5::Content;
use files::output::h5::read::SnapshotFile;
use results::SnapshotReader as _;

/// The first snapshot of a run.
#[derive(Debug)]
pub struct Start {
    file: SnapshotFile,
    /// In ascending order.
    ids: Vec<u64>,
}

impl Start {
    /// Opens the first snapshot, in the folder of another of the same run.
    pub fn beside(path: &Path) -> Result<Self, ExportError> {
        let first = path.with_file_name(RunFolder::snapshot_name(0));
        if !first.is_file() {
            let name = first.file_name().unwrap_or_default().to_string_lossy();
            let reason = format!("no initial places: {name} is not beside it");
            return Err(wrong(path, reason));
        }
        let ids = Content::open(&first)?.ids("/VTKHDF/PointData/id")?;
        let file = SnapshotFile::open(&first)?;
        if ids.len() != file.particles() || !ids.is_sorted() {
            return Err(wrong(&first, "its rows do not stand in the order of ids"));
        }
        Ok(Self { file, ids })
    }

    /// The initial positions of some particles (m); NaN of those that were not there.
    pub fn positions(&self, ids: &[u64]) -> Result<Vec<[f64; 3]>, ExportError> {
        let row = |id: &u64| self.ids.binary_search(id).ok();
        let rows: Vec<Option<usize>> = ids.iter().map(row).collect();
        let first = rows.iter().flatten().min().copied().unwrap_or(0);
        let end = rows.iter().flatten().max().map_or(first, |last| last + 1);
        let points = self.file.points(first..end)?;
        let position = |row: Option<usize>| row.map_or([f64::NAN; 3], |row| points[row - first]);
        Ok(rows.into_iter().map(position).collect())
    }
}

fn wrong(path: &Path, reason: impl Into<String>) -> ExportError {
    ExportError::Snapshot {
        path: path.to_owned(),
        reason: reason.into(),
    }
}
