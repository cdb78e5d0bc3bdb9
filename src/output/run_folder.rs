//! The folder of a run.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use crate::comm::Comm;

use super::checkpoint::{self, step_of};
use super::{OutputError, files, on_root, series, snapshot, write_atomically, write_json};

/// Files that a run writes into its folder, beside two folders.
const FILES: [&str; 9] = [
    "case.toml",
    "history.csv",
    "contacts.csv",
    "loads.csv",
    "removed.csv",
    "performance.csv",
    "log.txt",
    "status.json",
    "summary.json",
];
const SNAPSHOTS: &str = "snapshots";
const CHECKPOINTS: &str = "checkpoints";
const TROUBLE: &str = "trouble";

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// It runs, or was killed while it did.
    Running,
    /// It reached its end.
    Finished,
    /// It was asked to stop and wrote a checkpoint.
    Stopped,
    /// It ended by an error.
    Failed,
}

impl Phase {
    /// Its name in `status.json`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Finished => "finished",
            Self::Stopped => "stopped",
            Self::Failed => "failed",
        }
    }
}

/// `status.json`: what scripts that chain runs read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Status {
    /// Where the run stands.
    pub state: Phase,
    /// Last step.
    pub step: u64,
    /// Time reached (s).
    pub time: f64,
    /// Why it stopped or failed.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub reason: Option<String>,
}

/// The folder of a run and the names of what is in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// Makes the folder of a new run, with its resolved input. A folder with something in it is
    /// refused, unless `force` is given and it holds a run: then that run's files go, and
    /// nothing else. Collective.
    ///
    /// # Errors
    /// [`OutputError::FolderInUse`], [`OutputError::NotARun`], [`OutputError::Io`]; the same on
    /// every rank.
    pub fn create(
        comm: &Comm,
        path: &Path,
        resolved: &str,
        force: bool,
    ) -> Result<Self, OutputError> {
        let folder = Self::at(path);
        on_root(comm, || {
            folder.make_room(force)?;
            for path in [folder.snapshots(), folder.checkpoints()] {
                fs::create_dir_all(&path).map_err(OutputError::io("create the folder", &path))?;
            }
            folder.write_status(&Status {
                state: Phase::Running,
                step: 0,
                time: 0.0,
                reason: None,
            })?;
            write_atomically(&folder.case(), resolved.as_bytes())
        })?;
        Ok(folder)
    }

    /// Goes on in the folder of an earlier run from a checkpoint of it: snapshots and
    /// checkpoints later than that are removed, for the new run writes them again; tables are
    /// cut by [`super::Table::resume`]. Collective.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Damaged`]; the same on every rank.
    pub fn resume(
        comm: &Comm,
        path: &Path,
        resolved: &str,
        step: u64,
        time: f64,
    ) -> Result<Self, OutputError> {
        let folder = Self::at(path);
        on_root(comm, || {
            for path in [folder.snapshots(), folder.checkpoints()] {
                fs::create_dir_all(&path).map_err(OutputError::io("create the folder", &path))?;
            }
            for (other, path) in checkpoint::list(&folder.checkpoints())? {
                if other > step {
                    files::remove(&path)?;
                }
            }
            series::keep_until(&folder.series(), time)?;
            for path in folder.snapshot_files()? {
                if step_of(&path, SNAPSHOT_ENDING).is_some_and(|other| other > step) {
                    files::remove(&path)?;
                }
            }
            folder.write_status(&Status {
                state: Phase::Running,
                step,
                time,
                reason: None,
            })?;
            write_atomically(&folder.case(), resolved.as_bytes())
        })?;
        Ok(folder)
    }

    /// Names the folder of a run, whether it exists or not.
    #[must_use]
    pub fn at(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
        }
    }

    /// Removes a file `stop` that asked an earlier run to stop: one from before `began`. One that has
    /// come since, while this run was starting, stays and stops it. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn forget_stop(&self, began: SystemTime) -> Result<(), OutputError> {
        let path = self.stop();
        let written = fs::metadata(&path).and_then(|meta| meta.modified());
        if written.is_ok_and(|written| written < began) {
            files::remove(&path)?;
        }
        Ok(())
    }

    /// Whether a folder holds a run.
    #[must_use]
    pub fn is_run(path: &Path) -> bool {
        path.join("status.json").is_file()
    }

    /// The run that a checkpoint stands in, if it stands in one.
    #[must_use]
    pub fn of_checkpoint(checkpoint: &Path) -> Option<Self> {
        let checkpoint = checkpoint.canonicalize().ok()?;
        let path = checkpoint.parent()?.parent()?;
        Self::is_run(path).then(|| Self::at(path))
    }

    /// The checkpoints there are, newest first.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn checkpoint_folders(&self) -> Result<Vec<PathBuf>, OutputError> {
        let found = checkpoint::list(&self.checkpoints())?;
        Ok(found.into_iter().rev().map(|(_, path)| path).collect())
    }

    /// Where post-mortems of a step go, without an ending.
    #[must_use]
    pub fn post_mortem(&self, step: u64) -> PathBuf {
        self.path.join(TROUBLE).join(format!("step-{step:08}"))
    }

    /// Table of what removed particles took with them.
    #[must_use]
    pub fn removed(&self) -> PathBuf {
        self.path.join("removed.csv")
    }

    /// Reads `status.json`.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Damaged`].
    pub fn status(&self) -> Result<Status, OutputError> {
        let path = self.status_file();
        let text = files::read_small(&path)?;
        serde_json::from_slice(&text).map_err(|e| OutputError::damaged(&path, e.to_string()))
    }

    /// Writes `status.json`. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn write_status(&self, status: &Status) -> Result<(), OutputError> {
        write_json(&self.status_file(), status)
    }

    /// The folder itself.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The resolved input.
    #[must_use]
    pub fn case(&self) -> PathBuf {
        self.path.join("case.toml")
    }

    /// Table of conserved sums.
    #[must_use]
    pub fn history(&self) -> PathBuf {
        self.path.join("history.csv")
    }

    /// Table of contacts.
    #[must_use]
    pub fn contacts(&self) -> PathBuf {
        self.path.join("contacts.csv")
    }

    /// Table of loads.
    #[must_use]
    pub fn loads(&self) -> PathBuf {
        self.path.join("loads.csv")
    }

    /// Table of wall-clock times.
    #[must_use]
    pub fn performance(&self) -> PathBuf {
        self.path.join("performance.csv")
    }

    /// The log.
    #[must_use]
    pub fn log(&self) -> PathBuf {
        self.path.join("log.txt")
    }

    /// The status file.
    #[must_use]
    pub fn status_file(&self) -> PathBuf {
        self.path.join("status.json")
    }

    /// The figures of a finished run; see [`write_json`].
    #[must_use]
    pub fn summary(&self) -> PathBuf {
        self.path.join("summary.json")
    }

    /// The file whose appearance asks the run to stop.
    #[must_use]
    pub fn stop(&self) -> PathBuf {
        self.path.join("stop")
    }

    /// The folder of snapshots.
    #[must_use]
    pub fn snapshots(&self) -> PathBuf {
        self.path.join(SNAPSHOTS)
    }

    /// A snapshot's file name. Named by step, so that it means the same state in any run of
    /// the case, whatever is written how often.
    #[must_use]
    pub fn snapshot_name(step: u64) -> String {
        format!("step-{step:08}{SNAPSHOT_ENDING}")
    }

    /// A snapshot's path.
    #[must_use]
    pub fn snapshot(&self, step: u64) -> PathBuf {
        self.snapshots().join(Self::snapshot_name(step))
    }

    /// The index of the snapshots.
    #[must_use]
    pub fn series(&self) -> PathBuf {
        let name = format!("{SNAPSHOTS}.{}.series", snapshot::EXTENSION);
        self.snapshots().join(name)
    }

    /// The folder of checkpoints.
    #[must_use]
    pub fn checkpoints(&self) -> PathBuf {
        self.path.join(CHECKPOINTS)
    }

    /// The snapshots there are, in the order of steps.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn snapshot_files(&self) -> Result<Vec<PathBuf>, OutputError> {
        let folder = self.snapshots();
        let mut found = names_in(&folder)?;
        found.retain(|path| step_of(path, SNAPSHOT_ENDING).is_some());
        found.sort_by_key(|path| step_of(path, SNAPSHOT_ENDING));
        Ok(found)
    }

    /// Sees to it that the folder exists and holds no run.
    fn make_room(&self, force: bool) -> Result<(), OutputError> {
        fs::create_dir_all(&self.path).map_err(OutputError::io("create the folder", &self.path))?;
        if names_in(&self.path)?.is_empty() {
            return Ok(());
        }
        let path = self.path.clone();
        if !force {
            return Err(OutputError::FolderInUse { path });
        }
        if !Self::is_run(&path) {
            return Err(OutputError::NotARun { path });
        }
        for folder in [self.snapshots(), self.checkpoints()] {
            for path in names_in(&folder)? {
                if is_ours(&path) {
                    files::remove(&path)?;
                }
            }
        }
        files::remove(&path.join(TROUBLE))?;
        // The status goes last, so that a clearing that was cut short can be taken up again.
        for name in FILES.iter().filter(|&&name| name != "status.json") {
            files::remove(&path.join(name))?;
            files::remove(&files::partial(&path.join(name)))?;
        }
        files::remove(&self.status_file())
    }
}

const SNAPSHOT_ENDING: &str = ".vtkhdf";

/// Whether a run wrote this into its folder of snapshots or checkpoints.
fn is_ours(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.trim_end_matches(files::PARTIAL);
    let name = Path::new(name.strip_suffix(".old").unwrap_or(name));
    step_of(name, SNAPSHOT_ENDING).is_some()
        || step_of(name, "").is_some()
        || name.extension().is_some_and(|e| e == "series")
}

/// Paths of all files and folders in a folder; none if there is no such folder.
fn names_in(folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let entries = fs::read_dir(folder).map_err(OutputError::io("list", folder))?;
    entries
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()
        .map_err(OutputError::io("list", folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: PathBuf) {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "x").unwrap();
    }

    #[test]
    fn a_used_folder_is_refused_and_force_clears_only_a_run() {
        let comm = Comm::solo();
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("deep/run");
        let run = RunFolder::create(&comm, &path, "title = 1", false).unwrap();
        assert_eq!(run.status().unwrap().state, Phase::Running);
        let refused = RunFolder::create(&comm, &path, "", false).unwrap_err();
        assert!(refused.is_users() && refused.to_string().contains("--force"));

        write(run.snapshot(3));
        write(run.series());
        write(run.checkpoints().join("step-00000003/manifest.json"));
        write(run.checkpoints().join("step-00000004.partial/state.h5"));
        write(run.snapshots().join("my picture.png"));
        write(path.join("notes.txt"));
        RunFolder::create(&comm, &path, "title = 2", true).unwrap();
        let left = names_in(&run.snapshots()).unwrap();
        assert_eq!(left, [run.snapshots().join("my picture.png")]);
        assert!(names_in(&run.checkpoints()).unwrap().is_empty());
        assert!(path.join("notes.txt").exists());
        assert_eq!(fs::read_to_string(run.case()).unwrap(), "title = 2");
    }

    #[test]
    fn a_stop_file_is_that_of_an_earlier_run_or_of_this_one() {
        let place = tempfile::tempdir().unwrap();
        let run = RunFolder::at(place.path());
        write(run.stop());
        let second = std::time::Duration::from_secs(1);
        let written = fs::metadata(run.stop()).unwrap().modified().unwrap();
        run.forget_stop(written - second).unwrap();
        assert!(run.stop().exists());
        run.forget_stop(written + second).unwrap();
        assert!(!run.stop().exists());
        run.forget_stop(written).unwrap();
    }

    #[test]
    fn force_leaves_a_folder_alone_that_holds_no_run() {
        let place = tempfile::tempdir().unwrap();
        let case = place.path().join("case.toml");
        write(case.clone());
        let refused = RunFolder::create(&Comm::solo(), place.path(), "", true).unwrap_err();
        assert!(matches!(refused, OutputError::NotARun { .. }));
        assert_eq!(fs::read_to_string(case).unwrap(), "x");
    }

    #[test]
    fn a_restart_drops_what_came_after_its_checkpoint() {
        let comm = Comm::solo();
        let place = tempfile::tempdir().unwrap();
        let run = RunFolder::create(&comm, place.path(), "", false).unwrap();
        for step in [2, 4, 6] {
            write(run.snapshot(step));
            let time = f64::from(u32::try_from(step).unwrap());
            series::add(&run.series(), &RunFolder::snapshot_name(step), time).unwrap();
            write(
                run.checkpoints()
                    .join(format!("step-{step:08}/manifest.json")),
            );
        }
        let run = RunFolder::resume(&comm, place.path(), "", 4, 4.0).unwrap();
        assert_eq!(
            run.snapshot_files().unwrap(),
            [run.snapshot(2), run.snapshot(4)]
        );
        assert_eq!(series::read(&run.series()).unwrap().len(), 2);
        let newest = run.checkpoint_folders().unwrap().remove(0);
        assert!(newest.ends_with("step-00000004"));
        assert_eq!(
            RunFolder::of_checkpoint(&newest)
                .unwrap()
                .status()
                .unwrap()
                .step,
            4
        );
    }
}
