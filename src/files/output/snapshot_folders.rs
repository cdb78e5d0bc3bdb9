//! Paths of the snapshots of a run: the default ones are in their folder, those of each schedule in a
//! folder in it.

use std::fs;
use std::path::PathBuf;

use super::checkpoint::step_of;
use super::files::names_in;
use super::run_folder::SNAPSHOT_ENDING;
use super::{OutputError, RunFolder};

impl RunFolder {
    /// The folder of a schedule's snapshots, or of the default ones.
    #[must_use]
    pub fn snapshots_of(&self, schedule: Option<&str>) -> PathBuf {
        let default = self.snapshots();
        schedule.map_or(default.clone(), |name| default.join(name))
    }

    /// The path of a schedule's snapshot.
    #[must_use]
    pub fn snapshot_of(&self, schedule: Option<&str>, step: u64) -> PathBuf {
        self.snapshots_of(schedule).join(Self::snapshot_name(step))
    }

    /// The index of a schedule's snapshots.
    #[must_use]
    pub fn series_of(&self, schedule: Option<&str>) -> PathBuf {
        let name = schedule.unwrap_or("snapshots");
        let name = format!("{name}{SNAPSHOT_ENDING}.series");
        self.snapshots_of(schedule).join(name)
    }

    /// A schedule's snapshots, in the order of steps.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn snapshot_files_of(&self, schedule: Option<&str>) -> Result<Vec<PathBuf>, OutputError> {
        let mut found = names_in(&self.snapshots_of(schedule))?;
        found.retain(|path| step_of(path, SNAPSHOT_ENDING).is_some());
        found.sort_by_key(|path| step_of(path, SNAPSHOT_ENDING));
        Ok(found)
    }

    /// The schedules that have a folder, in alphabetical order.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn schedules(&self) -> Result<Vec<String>, OutputError> {
        let mut names = Vec::new();
        for path in names_in(&self.snapshots())? {
            let meta = fs::symlink_metadata(&path).map_err(OutputError::io("read", &path))?;
            if let (true, Some(name)) = (meta.is_dir(), path.file_name()) {
                names.extend(name.to_str().map(str::to_owned));
            }
        }
        names.sort_unstable();
        Ok(names)
    }

    /// The default snapshots, and the schedules that have a folder.
    pub(super) fn all_schedules(&self) -> Result<Vec<Option<String>>, OutputError> {
        let more = self.schedules()?.into_iter().map(Some);
        Ok(std::iter::once(None).chain(more).collect())
    }
}
