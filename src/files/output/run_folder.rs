//! The folder of a run.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use comm::Comm;
use uuid::Uuid;

use super::checkpoint::{self, step_of};
use super::files::names_in;
use super::fragments::FragmentTable;
use super::listing::LISTING;
use super::lock::{LOCK, RunLock};
use super::{OutputError, Status, files, on_root, read_small, sheet, write_atomically};
use results::regular::open_regular;

pub(super) const STATUS: &str = "status.json";
const SNAPSHOTS: &str = "snapshots";
pub(super) const CHECKPOINTS: &str = "checkpoints";
const FRAGMENTS: &str = "fragments";
const FRAGMENTS_ENDING: &str = ".csv";
const GAUGES: &str = "gauges";
const HDF5_ENDING: &str = ".h5";
const TROUBLE: &str = "trouble";
pub(super) const SNAPSHOT_ENDING: &str = ".vtkhdf";

/// Tables of sums that state the share of the model that was computed where it has symmetry planes.
const OF_WHOLE: [&str; 6] = [
    "history.csv",
    "contacts.csv",
    "loads.csv",
    "rigid.csv",
    "removed.csv",
    "departed.csv",
];
/// Bytes of the beginning of a table with its comments.
const BEGIN: u64 = 1 << 14;

/// The folder of a run and the names of its files.
#[derive(Debug, Clone)]
pub struct RunFolder {
    pub(super) path: PathBuf,
    /// The id of the run, once it has begun there.
    pub(super) id: Option<Uuid>,
    /// On rank 0 of a run that holds it.
    pub(super) lock: Option<Arc<RunLock>>,
}

impl RunFolder {
    /// [`Self::note_of_part`] of all tables that have one, with their names.
    pub fn notes_of_part(&self) -> impl Iterator<Item = (&'static str, String)> {
        OF_WHOLE
            .into_iter()
            .filter_map(|name| Some((name, self.note_of_part(name)?)))
    }

    /// What to say of a table of sums that an earlier version began for a model with symmetry planes: it is of the
    /// part that was computed. By one process.
    #[must_use]
    pub fn note_of_part(&self, name: &str) -> Option<String> {
        if !OF_WHOLE.contains(&name) {
            return None;
        }
        let case = read_small(&self.case()).ok()?;
        let case: toml::Table = toml::from_slice(&case).ok()?;
        let planes = case.get("symmetry")?.as_array()?.len().min(3);
        let mut begin = Vec::new();
        let (file, _) = open_regular(&self.path.join(name)).ok()?;
        file.take(BEGIN).read_to_end(&mut begin).ok()?;
        let states = String::from_utf8_lossy(&begin)
            .lines()
            .take_while(|line| line.starts_with('#'))
            .any(sheet::is_share_line);
        let copies = 1 << planes;
        (planes > 0 && !states).then(|| {
            format!("{name} of an earlier version is of what was computed, 1/{copies} of the whole")
        })
    }

    /// Names the folder of a run, whether it exists or not.
    #[must_use]
    pub fn at(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            id: None,
            lock: None,
        }
    }

    /// The id of the run, once it has begun in the folder: results of several runs are told by it.
    #[must_use]
    pub fn id(&self) -> Option<Uuid> {
        self.id
    }

    /// The folder that the run holds, where it is now. Rank 0's alone.
    #[must_use]
    pub fn place(&self) -> Option<Self> {
        match &self.lock {
            Some(lock) => lock.place().map(|path| Self {
                path,
                ..self.clone()
            }),
            None => Some(self.clone()),
        }
    }

    /// Fails if the folder was removed or moved, or if another process has taken it: nothing is written
    /// there then. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Lost`].
    pub fn check(&self) -> Result<(), OutputError> {
        let place = self.place();
        let what = match &place {
            Some(place) if place.path == self.path => return Ok(()),
            Some(place) => format!("it was moved to {}", place.path.display()),
            None => match self.lock.as_ref().and_then(|lock| lock.successor()) {
                Some(who) => format!("{who} has taken it"),
                None if self.path.exists() => format!("its file `{LOCK}` was removed"),
                None => "it was removed".to_owned(),
            },
        };
        let left = place.as_ref().unwrap_or(self).checkpoint_folders();
        let is_own = |path: &PathBuf| checkpoint::run_of(path) == self.id;
        Err(OutputError::Lost {
            path: self.path.clone(),
            what,
            newest: left.unwrap_or_default().into_iter().find(is_own),
        })
    }

    /// [`on_root`], if the folder is still the run's. Collective.
    ///
    /// # Errors
    /// [`OutputError::Lost`], or the error of `task`; with the same text on every rank.
    pub fn on_root(
        &self,
        comm: &Comm,
        task: impl FnOnce() -> Result<(), OutputError>,
    ) -> Result<(), OutputError> {
        on_root(comm, || self.check().and_then(|()| task()))
    }

    /// Removes a file `stop` that asked an earlier run to stop: one from before `began`. One that
    /// has come since, while this run was starting, stays and stops it. Rank 0's alone.
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

    /// Returns true if a folder holds a run.
    #[must_use]
    pub fn is_run(path: &Path) -> bool {
        path.join(STATUS).is_file()
    }

    /// The run that a checkpoint belongs to, if it is in the folder of one.
    #[must_use]
    pub fn of_checkpoint(checkpoint: &Path) -> Option<Self> {
        let checkpoint = checkpoint.canonicalize().ok()?;
        let path = checkpoint.parent()?.parent()?;
        Self::is_run(path).then(|| Self::at(path))
    }

    /// The run that a snapshot belongs to, if it is in the folder of one.
    pub(super) fn of_snapshot(path: &Path) -> Option<Self> {
        let path = path.canonicalize().ok()?;
        let snapshots = path.ancestors().skip(1).take(2);
        let run = snapshots
            .filter(|path| path.ends_with(SNAPSHOTS))
            .find_map(Path::parent)?;
        Self::is_run(run).then(|| Self::at(run))
    }

    /// Fails if the folder holds another run than that of a file in it.
    ///
    /// # Errors
    /// [`OutputError::OtherRun`].
    pub(super) fn refuse_other(&self, file: &Path, run: Option<Uuid>) -> Result<(), OutputError> {
        let own = self.status().ok().and_then(|status| status.run);
        match (own, run) {
            (Some(own), Some(run)) if own != run => Err(OutputError::OtherRun {
                path: file.to_owned(),
                run,
                folder: self.path.clone(),
                own,
            }),
            _ => Ok(()),
        }
    }

    /// The checkpoints, newest first.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn checkpoint_folders(&self) -> Result<Vec<PathBuf>, OutputError> {
        let found = checkpoint::list(&self.checkpoints())?;
        Ok(found.into_iter().rev().map(|(_, path)| path).collect())
    }

    /// Path of post-mortems of a step, without an ending.
    #[must_use]
    pub fn post_mortem(&self, step: u64) -> PathBuf {
        self.path.join(TROUBLE).join(format!("step-{step:08}"))
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
        let run = self.id;
        let status = Status {
            run,
            ..status.clone()
        };
        write_atomically(&self.status_file(), &status.text())
    }

    /// The folder itself.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A snapshot's file name. Named by step, so that it is the same state in any run of the case,
    /// whatever the intervals of output.
    #[must_use]
    pub fn snapshot_name(step: u64) -> String {
        format!("step-{step:08}{SNAPSHOT_ENDING}")
    }

    /// The path of a default snapshot.
    #[must_use]
    pub fn snapshot(&self, step: u64) -> PathBuf {
        self.snapshot_of(None, step)
    }

    /// The path of the table of all fragments at a step.
    #[must_use]
    pub fn fragment_table(&self, step: u64) -> PathBuf {
        in_steps(&self.fragment_tables(), step, FRAGMENTS_ENDING)
    }

    /// The path of the same table as HDF5.
    #[must_use]
    pub fn fragment_hdf5(&self, step: u64) -> PathBuf {
        in_steps(&self.fragment_tables(), step, HDF5_ENDING)
    }

    /// The path of the readings of many gauges up to a step.
    #[must_use]
    pub fn gauge_record(&self, step: u64) -> PathBuf {
        in_steps(&self.gauge_records(), step, HDF5_ENDING)
    }

    /// Writes the table of all fragments at a step, as text and as HDF5. Rank 0's alone.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Hdf5`].
    pub fn write_fragments(&self, step: u64, table: &FragmentTable) -> Result<(), OutputError> {
        let folder = self.fragment_tables();
        for path in [self.fragment_hdf5(step), self.fragment_table(step)] {
            self.list(&path)?;
        }
        files::make_folder(&folder)?;
        table.write_hdf5(&self.fragment_hdf5(step))?;
        files::write_atomically(&self.fragment_table(step), &table.text())
    }

    /// The tables of all fragments, of text and of HDF5, with their steps and in the order of these.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn fragment_files(&self) -> Result<Vec<(u64, PathBuf)>, OutputError> {
        by_steps(&self.fragment_tables(), &[FRAGMENTS_ENDING, HDF5_ENDING])
    }

    /// The files of readings of many gauges, with their last steps and in the order of these.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn gauge_files(&self) -> Result<Vec<(u64, PathBuf)>, OutputError> {
        by_steps(&self.gauge_records(), &[HDF5_ENDING])
    }

    /// The index of the default snapshots.
    #[must_use]
    pub fn series(&self) -> PathBuf {
        self.series_of(None)
    }

    /// The default snapshots, in the order of steps.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn snapshot_files(&self) -> Result<Vec<PathBuf>, OutputError> {
        self.snapshot_files_of(None)
    }
}

/// The file of a step in a folder.
fn in_steps(folder: &Path, step: u64, ending: &str) -> PathBuf {
    folder.join(format!("step-{step:08}{ending}"))
}

/// The files of steps in a folder, with their steps and in the order of these.
fn by_steps(folder: &Path, endings: &[&str]) -> Result<Vec<(u64, PathBuf)>, OutputError> {
    let step = |path: &PathBuf| endings.iter().find_map(|ending| step_of(path, ending));
    let found = names_in(folder)?.into_iter();
    let mut found: Vec<_> = found
        .filter_map(|path| Some((step(&path)?, path)))
        .collect();
    found.sort_unstable();
    Ok(found)
}

/// Declares files in the folder of a run: method and name.
macro_rules! paths {
    ($($(#[$doc:meta])+ $path:ident: $name:expr;)+) => {
        impl RunFolder { $(
            $(#[$doc])+
            #[must_use]
            pub fn $path(&self) -> PathBuf {
                self.path.join($name)
            }
        )+ }
    };
}

paths! {
    /// The list of the files that the run has written.
    listing: LISTING;
    /// The resolved input.
    case: "case.toml";
    /// Table of conserved sums.
    history: "history.csv";
    /// Table of contacts.
    contacts: "contacts.csv";
    /// Table of loads.
    loads: "loads.csv";
    /// Table of rigid bodies that forces move.
    rigid: "rigid.csv";
    /// Table of the mass, momentum and energy of removed particles.
    removed: "removed.csv";
    /// Table of the mass, momentum and energy of particles that left the box of interest.
    departed: "departed.csv";
    /// Table of fragments over time.
    fragments: "fragments.csv";
    /// Table of the sums over each body.
    bodies: "bodies.csv";
    /// Table of gauges.
    gauges: "gauges.csv";
    /// Table of the figures of measures.
    measures: "measures.csv";
    /// Table of profiles and other distributions of measures.
    distributions: "distributions.csv";
    /// Table of sums over the particles that have passed witness planes.
    witness: "witness.csv";
    /// Table of the particles that have passed them, with position and time.
    crossings: "crossings.csv";
    /// Table of wall-clock times.
    performance: "performance.csv";
    /// Table of the load of each rank or group of ranks.
    ranks: "ranks.csv";
    /// The log.
    log: "log.txt";
    /// The status file.
    status_file: STATUS;
    /// The figures of a finished run; see [`write_json`](super::write_json).
    summary: "summary.json";
}

paths! {
    /// What the run has taken over from another one.
    forked_file: "forked.json";
    /// The file that stops the run when it appears.
    stop: "stop";
    /// The folder of snapshots.
    snapshots: SNAPSHOTS;
    /// The folder of checkpoints.
    checkpoints: CHECKPOINTS;
    /// The folder of tables of all fragments.
    fragment_tables: FRAGMENTS;
    /// The folder of readings of many gauges.
    gauge_records: GAUGES;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_file_is_that_of_an_earlier_run_or_of_this_one() {
        let folder = tempfile::tempdir().unwrap();
        let run = RunFolder::at(folder.path());
        fs::write(run.stop(), "").unwrap();
        let second = std::time::Duration::from_secs(1);
        let written = fs::metadata(run.stop()).unwrap().modified().unwrap();
        run.forget_stop(written - second).unwrap();
        assert!(run.stop().exists());
        run.forget_stop(written + second).unwrap();
        assert!(!run.stop().exists());
        run.forget_stop(written).unwrap();
    }
}
