//! What a restart takes out of its way: set aside under another name, until it is not needed.
//!
//! A restart from a checkpoint writes anew what the run had written after it. Until it has a
//! checkpoint of its own, what came later stays in `set-aside/N/`, laid out like the run's folder.
//! Every order of steps here leaves, if it is cut short, checkpoints whose tables are whole: tables
//! are cut last, when no later checkpoint is left in its place.

use std::fs;
use std::path::{Path, PathBuf};

use super::{OutputError, files};

/// Name of the folder in a run's folder.
pub(super) const SET_ASIDE: &str = "set-aside";

/// Files and folders of a run that a restart has moved away or is about to change.
#[derive(Debug)]
#[must_use = "what is set aside is put back or forgotten"]
pub struct SetAside {
    run: PathBuf,
    folder: PathBuf,
    /// From where to where, in the order of moving.
    moved: Vec<(PathBuf, PathBuf)>,
}

impl SetAside {
    /// An empty place in the folder of a run.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub(super) fn new(run: &Path) -> Result<Self, OutputError> {
        let all = run.join(SET_ASIDE);
        let folder = (1..=u32::MAX)
            .map(|n| all.join(n.to_string()))
            .find(|path| !path.exists())
            .unwrap_or_default();
        fs::create_dir_all(&folder).map_err(OutputError::io("create the folder", &folder))?;
        Ok(Self {
            run: run.to_owned(),
            folder,
            moved: Vec::new(),
        })
    }

    /// Moves a file or folder of the run away.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub(super) fn take(&mut self, path: &Path) -> Result<(), OutputError> {
        let place = self.place(path)?;
        self.rename(path, place)
    }

    /// Gives something another name in its own folder: what it has and an ending, with a number if
    /// that is taken.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub(super) fn rename_as(&mut self, path: &Path, ending: &str) -> Result<(), OutputError> {
        let named = |n: u32| {
            let mut name = path.as_os_str().to_owned();
            name.push(ending);
            if n > 1 {
                name.push(format!("-{n}"));
            }
            PathBuf::from(name)
        };
        let place = (1..=u32::MAX).map(named).find(|path| !path.exists());
        self.rename(path, place.unwrap_or_default())
    }

    fn rename(&mut self, path: &Path, place: PathBuf) -> Result<(), OutputError> {
        fs::rename(path, &place).map_err(OutputError::io("move", path))?;
        self.moved.push((path.to_owned(), place));
        Ok(())
    }

    /// Keeps a copy of a file of the run as it is now, if there is one.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub(super) fn copy(&mut self, path: &Path) -> Result<(), OutputError> {
        let place = self.place(path)?;
        match fs::copy(path, &place) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(OutputError::io("copy", path)(error)),
            Ok(_) => {
                files::sync_file(&place)?;
                self.moved.push((path.to_owned(), place));
                Ok(())
            }
        }
    }

    /// The same path below the place.
    fn place(&self, path: &Path) -> Result<PathBuf, OutputError> {
        let name = path.strip_prefix(&self.run).unwrap_or(path);
        let place = self.folder.join(name);
        if let Some(parent) = place.parent() {
            fs::create_dir_all(parent).map_err(OutputError::io("create the folder", parent))?;
        }
        Ok(place)
    }

    /// Puts everything back: the restart could not begin. What cannot be put back stays set aside.
    pub fn undo(self) {
        let mut all = true;
        for (path, place) in self.moved.iter().rev() {
            all &= fs::rename(place, path).is_ok();
        }
        if all {
            let _ = files::remove(&self.folder);
            // With others in it, it stays.
            let _ = fs::remove_dir(self.run.join(SET_ASIDE));
        }
    }
}

/// Removes what restarts have set aside: the run has a newer checkpoint now.
///
/// # Errors
/// [`OutputError::Io`].
pub(super) fn forget(run: &Path) -> Result<(), OutputError> {
    files::remove(&run.join(SET_ASIDE))
}
