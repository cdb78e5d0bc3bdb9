//! The list of the files that a run has written, which tells them from a user's in the same folder.
//!
//! A file is listed before it is made, so that a run that is killed leaves none that is not. `run --force`
//! deletes what is listed, and nothing else.

use std::collections::HashSet;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::checkpoint::{self, MANIFEST, STATE, folder_name};
use super::files::{PARTIAL, names_in, read_small};
use super::lock::LOCK;
use super::run_folder::{CHECKPOINTS, STATUS};
use super::set_aside::SET_ASIDE;
use super::{OutputError, RunFolder, write_atomically};

/// Name of the list in a run's folder.
pub(super) const LISTING: &str = "files.txt";

/// Files of every run.
const ALWAYS: [&str; 5] = [LISTING, STATUS, "case.toml", "log.txt", "summary.json"];

impl RunFolder {
    /// Begins the list of a run's files, some of which may be there.
    pub(super) fn begin_listing(&self, there: &[String]) -> Result<(), OutputError> {
        let always = ALWAYS.map(str::to_owned);
        let lines: Vec<_> = always
            .iter()
            .chain(there)
            .map(|name| format!("{name}\n"))
            .collect();
        write_atomically(&self.listing(), lines.concat().as_bytes())
    }

    /// Returns true if there is a list that a run has begun.
    pub(super) fn has_listing(&self) -> bool {
        let begin = format!("{LISTING}\n");
        read_small(&self.listing()).is_ok_and(|text| text.starts_with(begin.as_bytes()))
    }

    /// Lists a file that the run, once it has begun, is about to make. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn list(&self, path: &Path) -> Result<(), OutputError> {
        if self.id.is_none() || fs::symlink_metadata(path).is_ok() {
            return Ok(());
        }
        let name = path.strip_prefix(&self.path).unwrap_or(path);
        let line = format!("{}\n", name.display());
        let listing = self.listing();
        let opened = File::options().append(true).open(&listing);
        opened
            .and_then(|mut file| file.write_all(line.as_bytes()))
            .map_err(OutputError::io("write", &listing))
    }

    /// Lists the files of the checkpoint of a step. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn list_checkpoint(&self, step: u64) -> Result<(), OutputError> {
        let [state, manifest] = self.files_of_checkpoint(step);
        self.list(&state).and_then(|()| self.list(&manifest))
    }

    fn files_of_checkpoint(&self, step: u64) -> [PathBuf; 2] {
        let folder = self.checkpoints().join(folder_name(step));
        [STATE, MANIFEST].map(|name| folder.join(name))
    }

    /// Names of the files that are there of a run which has no list, as runs of earlier versions.
    pub(super) fn unlisted(&self, tables: &[&str]) -> Result<Vec<String>, OutputError> {
        let mut paths: Vec<_> = tables.iter().map(|name| self.path.join(name)).collect();
        for schedule in self.all_schedules()? {
            paths.push(self.series_of(schedule.as_deref()));
        }
        for (step, _) in checkpoint::list(&self.checkpoints())? {
            paths.extend(self.files_of_checkpoint(step));
        }
        let there = paths.iter().filter(|path| path.is_file());
        let names = there.filter_map(|path| path.strip_prefix(&self.path).ok());
        let mut names: Vec<_> = names.map(|name| name.display().to_string()).collect();
        names.extend(self.result_files()?);
        Ok(names)
    }

    /// Removes the files of a run at once, as `--force` demands, and returns those that are not its own.
    /// Checkpoints go first, each in one rename and the newest first, so that a restart after an interrupted
    /// clearing finds whole ones or none. The list and the status stay until new ones replace them, so that the
    /// folder remains one that `--force` clears.
    pub(super) fn clear(&self) -> Result<Vec<PathBuf>, OutputError> {
        let listed = self.listed()?;
        let checkpoints = self.checkpoints();
        if !checkpoints.is_symlink() {
            for (_, path) in checkpoint::list(&checkpoints)?.iter().rev() {
                if listed.contains(&self.listed_name(&path.join(MANIFEST))) {
                    checkpoint::discard(path)?;
                }
            }
        }
        let mut kept = Vec::new();
        self.remove_listed(&self.path, &listed, &mut kept)?;
        Ok(kept)
    }

    /// Removes the files that restarts have set aside, if any: the run has a checkpoint of its own.
    /// Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn forget_set_aside(&self) -> Result<(), OutputError> {
        let Some(folder) = self.set_aside_folder() else {
            return Ok(());
        };
        let listed = self.listed()?;
        self.remove_listed(&folder, &listed, &mut Vec::new())?;
        remove_if_empty(&folder);
        Ok(())
    }

    /// Removes the listed files in a folder, and folders in it that are empty then. Follows no links. Adds what
    /// stays to `kept`, and returns the number of files removed.
    fn remove_listed(
        &self,
        folder: &Path,
        listed: &HashSet<PathBuf>,
        kept: &mut Vec<PathBuf>,
    ) -> Result<usize, OutputError> {
        let mut removed = 0;
        for path in names_in(folder)? {
            let meta = fs::symlink_metadata(&path).map_err(OutputError::io("read", &path))?;
            if meta.is_dir() {
                let within = self.remove_listed(&path, listed, kept)?;
                if within > 0 {
                    let _ = fs::remove_dir(&path);
                }
                removed += within;
            } else if [LOCK, LISTING, STATUS]
                .iter()
                .any(|name| path == self.path.join(name))
            {
            } else if meta.is_file() && listed.contains(&self.listed_name(&path)) {
                fs::remove_file(&path).map_err(OutputError::io("remove", &path))?;
                removed += 1;
            } else {
                kept.push(path);
            }
        }
        Ok(removed)
    }

    /// The names in the list; none if there is no list.
    fn listed(&self) -> Result<HashSet<PathBuf>, OutputError> {
        if !self.has_listing() {
            return Ok(HashSet::new());
        }
        let text = read_small(&self.listing())?;
        Ok(String::from_utf8_lossy(&text)
            .lines()
            .map(PathBuf::from)
            .collect())
    }

    /// The name under which a file is listed that may be half written, set aside, or of a checkpoint which is
    /// old or damaged.
    fn listed_name(&self, path: &Path) -> PathBuf {
        let mut parts = path.strip_prefix(&self.path).unwrap_or(path).components();
        if parts.as_path().starts_with(SET_ASIDE) {
            // And the number of the restart.
            parts.by_ref().take(2).for_each(drop);
        }
        let mut checkpoint = false;
        parts
            .map(|part| {
                let name = part.as_os_str().to_string_lossy();
                let name = name.trim_end_matches(PARTIAL);
                let step = name.split('.').next().filter(|_| checkpoint);
                checkpoint = name == CHECKPOINTS;
                step.unwrap_or(name).to_owned()
            })
            .collect()
    }
}

/// Removes a folder of the program's own with those in it that are empty, as a killed restart leaves them. With something else in it,
/// it stays. Follows no links.
fn remove_if_empty(folder: &Path) {
    for path in names_in(folder).unwrap_or_default() {
        if fs::symlink_metadata(&path).is_ok_and(|meta| meta.is_dir()) {
            remove_if_empty(&path);
        }
    }
    let _ = fs::remove_dir(folder);
}
