//! The folder of a run that begins with what another run had written up to a checkpoint.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::checkpoint::{self, MANIFEST, STATE};
use super::extents::is_within;
use super::{
    OutputError, Phase, RunFolder, Status, files, read_regular, read_small, write_atomically,
    write_json,
};

/// `forked.json`: what a run has taken over from another one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Forked {
    /// The folder of the other run.
    pub from: PathBuf,
    /// Steps that were not computed again.
    pub step: u64,
    /// Their time (s).
    pub time: f64,
}

impl RunFolder {
    /// What the run has taken over from another one, if it has.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Damaged`].
    pub fn forked(&self) -> Result<Option<Forked>, OutputError> {
        let path = self.forked_file();
        if !path.is_file() {
            return Ok(None);
        }
        let forked = serde_json::from_slice(&read_small(&path)?);
        forked.map_err(|error| OutputError::damaged(&path, error.to_string()))
    }

    /// Fills this folder, which is held, with what another run had written up to a checkpoint of it, and with a resolved input of
    /// its own. Files of an earlier run go. Files that no run changes are linked where the file system can. Until the
    /// checkpoint's manifest is there, which comes last, the folder is a run without a checkpoint. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Damaged`].
    pub fn adopt(
        &self,
        other: &Self,
        checkpoint: &Path,
        resolved: &str,
    ) -> Result<(), OutputError> {
        let manifest = checkpoint::manifest(checkpoint)?;
        self.clear()?;
        copy(&other.listing(), &self.listing())?;
        let own = Self {
            id: manifest.run,
            ..self.clone()
        };
        let (step, time) = (manifest.step, manifest.time);
        own.write_status(&Status::new(Phase::Running, step, time))?;
        own.list(&self.forked_file())?;
        let from = other.path.clone();
        write_json(&self.forked_file(), &Forked { from, step, time })?;
        let name = checkpoint.file_name().unwrap_or_default();
        let into = self.checkpoints().join(name);
        for folder in [&self.snapshots(), &self.checkpoints(), &into] {
            files::make_folder(folder)?;
        }
        write_atomically(&self.case(), resolved.as_bytes())?;
        copy(&other.log(), &self.log())?;
        for table in &manifest.results.tables {
            if is_within(&table.name) {
                let mut rows = read_regular(&other.path.join(&table.name))?;
                rows.truncate(usize::try_from(table.bytes).unwrap_or(usize::MAX));
                write_atomically(&self.path.join(&table.name), &rows)?;
            }
        }
        for name in manifest.results.files.iter().filter(|name| is_within(name)) {
            let (from, to) = (other.path.join(name), self.path.join(name));
            if let Some(folder) = to.parent() {
                fs::create_dir_all(folder).map_err(OutputError::io("create the folder", folder))?;
            }
            link(&from, &to)?;
        }
        for schedule in other.all_schedules()? {
            let schedule = schedule.as_deref();
            let (from, to) = (other.series_of(schedule), self.series_of(schedule));
            if from.is_file() && self.snapshots_of(schedule).is_dir() {
                copy(&from, &to)?;
            }
        }
        link(&checkpoint.join(STATE), &into.join(STATE))?;
        copy(&checkpoint.join(MANIFEST), &into.join(MANIFEST))?;
        files::sync_folder(&into)
    }
}

/// Copies a small file.
fn copy(from: &Path, to: &Path) -> Result<(), OutputError> {
    write_atomically(to, &read_regular(from)?)
}

/// Gives a file a second name, or copies it where there are no links.
fn link(from: &Path, to: &Path) -> Result<(), OutputError> {
    // A link of the other folder would lead elsewhere.
    files::length_of_regular("link", from)?;
    if fs::hard_link(from, to).is_ok() {
        return Ok(());
    }
    fs::copy(from, to).map_err(OutputError::io("copy", from))?;
    files::sync_file(to)
}
