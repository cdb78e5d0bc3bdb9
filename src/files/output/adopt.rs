//! The folder of a run that begins with what another run had written up to a checkpoint.

use std::fs;
use std::path::Path;

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
    pub from: String,
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
    /// its own; tells the results that are not there to be taken over. Files of an earlier run go. Files that no run changes get a
    /// second name where the file system can do that. Until the checkpoint's manifest is there, which comes last, the folder is a run
    /// without a checkpoint. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Damaged`].
    pub fn adopt(
        &self,
        other: &Self,
        checkpoint: &Path,
        resolved: &str,
    ) -> Result<Vec<String>, OutputError> {
        let manifest = checkpoint::manifest(checkpoint)?;
        let whole = (other.path.canonicalize()).map_err(OutputError::io("find", &other.path))?;
        self.clear()?;
        copy(&other.listing(), &self.listing())?;
        let own = Self {
            id: manifest.run,
            ..self.clone()
        };
        let (step, time) = (manifest.step, manifest.time);
        own.write_status(&Status::new(Phase::Running, step, time))?;
        own.list(&self.forked_file())?;
        let from = whole.display().to_string();
        write_json(&self.forked_file(), &Forked { from, step, time })?;
        let name = checkpoint.file_name().unwrap_or_default();
        let into = self.checkpoints().join(name);
        for folder in [
            &self.snapshots(),
            &self.fragment_tables(),
            &self.gauge_records(),
            &self.checkpoints(),
            &into,
        ] {
            files::make_folder(folder)?;
        }
        write_atomically(&self.case(), resolved.as_bytes())?;
        let mut missing = Vec::new();
        for table in &manifest.results.tables {
            let rows = Some(&table.name)
                .filter(|name| is_within(name) && Path::new(name).parent() == Some(Path::new("")))
                .and_then(|name| read_regular(&other.path.join(name)).ok());
            let Some(mut rows) = rows else {
                missing.push(table.name.clone());
                continue;
            };
            rows.truncate(usize::try_from(table.bytes).unwrap_or(usize::MAX));
            write_atomically(&self.path.join(&table.name), &rows)?;
        }
        for name in &manifest.results.files {
            if !self.take_over(&whole, name)? {
                missing.push(name.clone());
            }
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
        for empty in [self.fragment_tables(), self.gauge_records()] {
            // With something in it, it stays.
            let _ = fs::remove_dir(empty);
        }
        files::sync_folder(&into)?;
        Ok(missing)
    }

    /// Takes a file of results of another run over, which is at a whole path; false if it is not there, or lies elsewhere.
    fn take_over(&self, other: &Path, name: &str) -> Result<bool, OutputError> {
        let to = self.path.join(name);
        let folders = [
            self.snapshots(),
            self.fragment_tables(),
            self.gauge_records(),
        ];
        let is_result = folders.iter().any(|folder| to.starts_with(folder));
        let from = other.join(name).canonicalize();
        let Some(from) = from.ok().filter(|from| {
            is_within(name) && is_result && from.starts_with(other) && from.is_file()
        }) else {
            return Ok(false);
        };
        if let Some(folder) = to.parent() {
            // Of a schedule.
            files::make_folder(folder)?;
        }
        if !to.exists() {
            link(&from, &to)?;
        }
        Ok(true)
    }
}

/// Copies a small file.
fn copy(from: &Path, to: &Path) -> Result<(), OutputError> {
    write_atomically(to, &read_regular(from)?)
}

/// Gives a file a second name, which is free, or copies it where there are none.
fn link(from: &Path, to: &Path) -> Result<(), OutputError> {
    if fs::hard_link(from, to).is_ok() {
        return Ok(());
    }
    let temporary = files::partial(to);
    fs::copy(from, &temporary).map_err(OutputError::io("copy", from))?;
    files::sync_file(&temporary)?;
    files::publish(&temporary, to)
}
