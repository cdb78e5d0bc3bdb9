//! The results that a checkpoint stands on: a restart adds to them, and must not lose any in silence.

use std::path::{Component, Path};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::{OutputError, RunFolder, read_regular};

/// The results of a run up to a checkpoint.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResultExtents {
    /// Tables of text.
    pub tables: Vec<TableExtent>,
    /// Other files, by their names in the run's folder.
    pub files: Vec<String>,
}

impl ResultExtents {
    /// True if a default snapshot of the checkpoint's `step` is none that it stands on: a stop wrote it, which no schedule
    /// asked for, and a restart sets it aside. Earlier versions named no results.
    #[must_use]
    pub fn ends_in_stop(&self, run: &RunFolder, step: u64) -> bool {
        let own = run.snapshot_of(None, step);
        let mut names = self.files.iter().map(|name| run.path().join(name));
        !self.tables.is_empty() && names.all(|name| name != own)
    }
}

/// What a table of text held.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TableExtent {
    /// Name in the run's folder.
    pub name: String,
    /// Rows below the header.
    pub rows: u64,
    /// Bytes.
    pub bytes: u64,
    /// SHA-256 of these bytes.
    pub sha256: String,
}

impl TableExtent {
    /// What a folder's table lacks of this, if it lacks anything.
    fn loss(&self, run: &RunFolder) -> Option<String> {
        let Self { name, rows, .. } = self;
        let content = is_within(name).then(|| read_regular(&run.path().join(name)).ok());
        let Some(content) = content.flatten() else {
            return Some(format!("{name} with {rows} rows is missing"));
        };
        let bytes = usize::try_from(self.bytes).unwrap_or(usize::MAX);
        let same = content
            .get(..bytes)
            .is_some_and(|known| format!("{:x}", Sha256::digest(known)) == self.sha256);
        (!same).then(|| format!("{name} has other rows than the {rows} that it had"))
    }
}

/// Returns true for a name within a folder.
pub(super) fn is_within(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    parts.all(|part| matches!(part, Component::Normal(_)))
}

impl RunFolder {
    /// The files of results beside tables of text. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn result_files(&self) -> Result<Vec<String>, OutputError> {
        let mut all = Vec::new();
        for schedule in self.all_schedules()? {
            all.extend(self.snapshot_files_of(schedule.as_deref())?);
        }
        let others = self
            .fragment_files()?
            .into_iter()
            .chain(self.gauge_files()?);
        all.extend(others.map(|(_, path)| path));
        let names = all
            .iter()
            .filter_map(|path| path.strip_prefix(&self.path).ok());
        Ok(names.map(|name| name.display().to_string()).collect())
    }

    /// What is lost of the results that a checkpoint stands on, in words. By one process.
    #[must_use]
    pub fn losses(&self, known: &ResultExtents) -> Vec<String> {
        let tables = known.tables.iter().filter_map(|table| table.loss(self));
        let mut losses: Vec<String> = tables.collect();
        let is_there = |name: &&String| is_within(name) && self.path.join(name).is_file();
        let mut missing = known.files.iter().filter(|name| !is_there(name));
        if let Some(first) = missing.next() {
            losses.push(match missing.count() {
                0 => format!("{first} is missing"),
                more => format!("{first} and {more} more files of results are missing"),
            });
        }
        losses
    }
}
