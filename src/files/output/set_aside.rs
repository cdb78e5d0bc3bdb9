//! Files of a run that a restart sets aside until they are not needed.
//!
//! A restart from a checkpoint writes anew what the run had written after it. Until it has a
//! checkpoint of its own, the later files stay in `set-aside/N/`, laid out like the run's folder.
//! If a restart is interrupted anywhere, the checkpoints left have whole tables: tables are cut
//! last, when no later checkpoint is left in the run's folder.

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
    /// Sources and destinations, in the order of moving.
    moved: Vec<(PathBuf, PathBuf)>,
}

impl SetAside {
    /// A new folder for such files in that of a run.
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
        let destination = self.destination(path)?;
        self.rename(path, destination)
    }

    /// Renames a file or folder within its own folder: adds an ending, with a number if that is taken.
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
        let free = (1..=u32::MAX).map(named).find(|path| !path.exists());
        self.rename(path, free.unwrap_or_default())
    }

    fn rename(&mut self, path: &Path, destination: PathBuf) -> Result<(), OutputError> {
        fs::rename(path, &destination).map_err(OutputError::io("move", path))?;
        self.moved.push((path.to_owned(), destination));
        Ok(())
    }

    /// Keeps a copy of a file of the run as it is now, if there is one.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub(super) fn copy(&mut self, path: &Path) -> Result<(), OutputError> {
        let destination = self.destination(path)?;
        match fs::copy(path, &destination) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(OutputError::io("copy", path)(error)),
            Ok(_) => {
                files::sync_file(&destination)?;
                self.moved.push((path.to_owned(), destination));
                Ok(())
            }
        }
    }

    /// The same path below the folder of files set aside.
    fn destination(&self, path: &Path) -> Result<PathBuf, OutputError> {
        let name = path.strip_prefix(&self.run).unwrap_or(path);
        let destination = self.folder.join(name);
        if let Some(parent) = destination.parent() {
            fs::create_dir_all(parent).map_err(OutputError::io("create the folder", parent))?;
        }
        Ok(destination)
    }

    /// Moves everything back: the restart could not begin. Files that cannot be moved stay set aside.
    pub fn undo(self) {
        let mut all = true;
        for (path, destination) in self.moved.iter().rev() {
            all &= fs::rename(destination, path).is_ok();
        }
        if all {
            let _ = files::remove(&self.folder);
            // With others in it, it stays.
            let _ = fs::remove_dir(self.run.join(SET_ASIDE));
        }
    }
}
