//! Start of a run in its folder, a new one or that of an earlier run. Nothing of an earlier run is lost
//! before the new one has begun.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use comm::Comm;
use uuid::Uuid;

use super::checkpoint::{self, run_of, step_of};
use super::files::names_in;
use super::listing::LISTING;
use super::lock::{LOCK, RunLock};
use super::run_folder::{SNAPSHOT_ENDING, STATUS};
use super::set_aside::{SET_ASIDE, SetAside};
use super::{
    OutputError, Phase, RunFolder, Status, files, from_root, on_root, series, write_atomically,
};

/// Most files of a user's that are named.
const TOLD: usize = 5;

/// Files that a restart changes before it has a checkpoint.
const CHANGED: [&str; 17] = [
    "history.csv",
    "contacts.csv",
    "loads.csv",
    "rigid.csv",
    "removed.csv",
    "departed.csv",
    "fragments.csv",
    "bodies.csv",
    "gauges.csv",
    "measures.csv",
    "distributions.csv",
    "witness.csv",
    "crossings.csv",
    "performance.csv",
    "ranks.csv",
    "case.toml",
    STATUS,
];

impl RunFolder {
    /// Takes the folder of a new run, and makes it if need be; nothing in it changes. A folder with
    /// something in it is refused, unless `force` is given and it holds a run. One that a run has
    /// open is refused unless `ignore` is given. Rank 0 holds it for as long as `self` or a copy lives, and
    /// receives the warnings. Collective.
    ///
    /// # Errors
    /// [`OutputError::FolderInUse`], [`OutputError::NotARun`], [`OutputError::Held`],
    /// [`OutputError::Unclear`], [`OutputError::Io`]; the same on every rank.
    pub fn take_new(
        &mut self,
        comm: &Comm,
        force: bool,
        ignore: bool,
    ) -> Result<Vec<String>, OutputError> {
        let mut lock = None;
        on_root(comm, || {
            let path = &self.path;
            let new = !path.exists();
            fs::create_dir_all(path).map_err(OutputError::io("create the folder", path))?;
            if self.is_empty()? || Self::is_run(path) {
                let taken = RunLock::take(path, ignore)?;
                lock = Some(if new { taken.of_new_folder() } else { taken });
            }
            // Another run may have begun and ended here before the lock was taken.
            self.refuse(force)
        })?;
        Ok(self.hold(lock))
    }

    /// Takes the folder of a run to continue it; nothing in it changes. Rank 0 holds it for as long as
    /// `self` or a copy lives, and receives the warnings. Collective.
    ///
    /// # Errors
    /// [`OutputError::Held`], [`OutputError::Unclear`], [`OutputError::Io`]; the same on
    /// every rank.
    pub fn take(&mut self, comm: &Comm, ignore: bool) -> Result<Vec<String>, OutputError> {
        let mut lock = None;
        on_root(comm, || {
            lock = Some(RunLock::take(&self.path, ignore)?);
            Ok(())
        })?;
        Ok(self.hold(lock))
    }

    fn hold(&mut self, lock: Option<RunLock>) -> Vec<String> {
        self.lock = lock.map(Arc::new);
        let lock = self.lock.iter();
        lock.flat_map(|lock| lock.warnings.clone()).collect()
    }

    /// Begins a new run in its folder, with its resolved input. A folder with something in it is
    /// refused, unless `force` is given and it holds a run: then that run's files go, and
    /// nothing else; tells on rank 0 what stays. Collective.
    ///
    /// # Errors
    /// [`OutputError::FolderInUse`], [`OutputError::NotARun`], [`OutputError::Io`]; the same on
    /// every rank.
    pub fn create(
        &mut self,
        comm: &Comm,
        resolved: &str,
        force: bool,
    ) -> Result<Option<String>, OutputError> {
        self.id = Some(from_root(comm, || Ok(Uuid::new_v4()))?);
        let path = &self.path;
        let mut kept = Vec::new();
        self.on_root(comm, || {
            files::make_folder(path)?;
            self.refuse(force)?;
            kept = self.clear()?;
            // List and status first, by which the folder is a run that --force clears.
            self.begin_listing(&[])?;
            self.begin(0, 0.0, Some(resolved))?;
            self.make_folders()?;
            files::sync_folder(path)?;
            files::sync_folder(path.parent().unwrap_or(path))
        })?;
        let names = kept.iter().filter_map(|kept| kept.strip_prefix(path).ok());
        let names: Vec<_> = names.map(|name| name.display().to_string()).collect();
        let (named, more) = names.split_at(names.len().min(TOLD));
        let more = match more.len() {
            0 => String::new(),
            count => format!(" and {count} more"),
        };
        let text = format!(
            "--force keeps what the run did not write: {}{more}",
            named.join(", ")
        );
        Ok((!named.is_empty()).then_some(text))
    }

    /// Continues in the folder of an earlier run from a checkpoint of it, with a resolved input
    /// unless the one there stays. Checkpoints that were passed over as damaged get another name.
    /// Later files of the run are set aside until [`Self::forget_set_aside`], since the new
    /// run writes them again, and with them the snapshot that a `stop` wrote at this step; copies of the tables go there too, which [`super::Table::resume`] cuts.
    /// Collective.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Damaged`]; the same on every rank. The folder is then as
    /// it was.
    pub fn resume(
        &mut self,
        comm: &Comm,
        resolved: Option<&str>,
        step: u64,
        time: f64,
        stop: bool,
        passed_over: &[PathBuf],
    ) -> Result<Option<SetAside>, OutputError> {
        let known = || {
            let status = self.status().ok().and_then(|status| status.run);
            // An earlier version may have written the status since.
            let newest = || {
                self.checkpoint_folders()
                    .ok()?
                    .iter()
                    .find_map(|path| run_of(path))
            };
            status.or_else(newest)
        };
        self.id = Some(from_root(
            comm,
            || Ok(known().unwrap_or_else(Uuid::new_v4)),
        )?);
        let mut aside = None;
        self.on_root(comm, || {
            if !self.has_listing() {
                self.begin_listing(&self.unlisted(&CHANGED)?)?;
            }
            self.make_folders()?;
            let mut files = SetAside::new(&self.path)?;
            let moved = self
                .set_aside(&mut files, step, time, stop, passed_over)
                .and_then(|()| self.begin(step, time, resolved));
            if let Err(error) = moved {
                files.undo();
                return Err(error);
            }
            aside = Some(files);
            Ok(())
        })?;
        Ok(aside)
    }

    /// Sets later files aside: checkpoints first, the newest first of all, so that at any time the newest
    /// one left has all its rows and snapshots.
    fn set_aside(
        &self,
        aside: &mut SetAside,
        step: u64,
        time: f64,
        stop: bool,
        passed_over: &[PathBuf],
    ) -> Result<(), OutputError> {
        for path in passed_over {
            aside.rename_as(path, checkpoint::DAMAGED)?;
        }
        let checkpoints = checkpoint::list(&self.checkpoints())?;
        for (_, path) in checkpoints.iter().rev().filter(|(other, _)| *other > step) {
            aside.take(path)?;
        }
        files::sync_folder(&self.checkpoints())?;
        for name in CHANGED {
            aside.copy(&self.path.join(name))?;
        }
        for schedule in self.all_schedules()? {
            let series = self.series_of(schedule.as_deref());
            aside.copy(&series)?;
            let is_of_stop = |other| stop && schedule.is_none() && other == step;
            let of_stop = Self::snapshot_name(step);
            series::keep(&series, |entry| {
                entry.time <= time && !(is_of_stop(step) && entry.name == of_stop)
            })?;
            // What a kill left unfinished, of a step that may write no snapshot now: parts, and what kept room for them.
            for path in names_in(&self.snapshots_of(schedule.as_deref()))? {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let whole = name.split_once(files::PARTIAL).map(|(whole, _)| whole);
                let is_part =
                    whole.is_some_and(|name| step_of(Path::new(name), SNAPSHOT_ENDING).is_some());
                if is_part && path.is_file() {
                    fs::remove_file(&path).map_err(OutputError::io("remove", &path))?;
                }
            }
            for path in self.snapshot_files_of(schedule.as_deref())? {
                if step_of(&path, SNAPSHOT_ENDING)
                    .is_some_and(|other| other > step || is_of_stop(other))
                {
                    aside.take(&path)?;
                }
            }
        }
        for (other, path) in self
            .fragment_files()?
            .into_iter()
            .chain(self.gauge_files()?)
        {
            if other > step {
                aside.take(&path)?;
            }
        }
        Ok(())
    }

    /// The folder of files that restarts have set aside, if there is one.
    #[must_use]
    pub fn set_aside_folder(&self) -> Option<PathBuf> {
        Some(self.path.join(SET_ASIDE)).filter(|path| path.exists())
    }

    /// Writes the status of a run that begins at a step and time (s), and its resolved input.
    fn begin(&self, step: u64, time: f64, resolved: Option<&str>) -> Result<(), OutputError> {
        // The outlook up to here stays.
        let before = self.status().ok().filter(|_| step > 0);
        self.write_status(&Status {
            outlook: before.and_then(|status| status.outlook),
            ..Status::new(Phase::Running, step, time)
        })?;
        let run = self
            .id
            .map_or(String::new(), |run| format!("# run {run}\n"));
        resolved.map_or(Ok(()), |text| {
            write_atomically(&self.case(), format!("{run}{text}").as_bytes())
        })
    }

    fn make_folders(&self) -> Result<(), OutputError> {
        for path in [self.snapshots(), self.checkpoints()] {
            files::make_folder(&path)?;
        }
        Ok(())
    }

    /// Refuses a folder with something in it, unless it is a run and `force` is given.
    fn refuse(&self, force: bool) -> Result<(), OutputError> {
        let path = self.path.clone();
        if self.is_empty()? {
            Ok(())
        } else if !force {
            Err(OutputError::FolderInUse { path })
        } else if Self::is_run(&path) && self.has_listing() {
            Ok(())
        } else {
            Err(OutputError::NotARun { path })
        }
    }

    /// Returns true if there is nothing in it but a lock, or the files of a run that was killed at its
    /// very beginning.
    fn is_empty(&self) -> Result<bool, OutputError> {
        let names = names_in(&self.path)?;
        let unfinished = [LOCK, LISTING, STATUS].map(|name| files::partial(Path::new(name)));
        let is_nothing = |path: &PathBuf| {
            path.ends_with(LOCK)
                || path.ends_with(LISTING) && self.has_listing()
                || unfinished.iter().any(|name| path.ends_with(name))
        };
        Ok(names.iter().all(is_nothing))
    }
}

#[cfg(test)]
mod tests;
