//! The results that a path of the command line names: a run, a snapshot or a checkpoint.

use std::path::{Path, PathBuf};

use files::output::checkpoint;
use files::output::h5::Content;
use files::output::{OutputError, Phase, Presence, RunFolder, Status};

/// Group of a snapshot's grid.
pub const GRID: &str = "/VTKHDF";
/// Group of a snapshot's particle fields.
pub const POINT_DATA: &str = "/VTKHDF/PointData";

/// Something that a run has written.
#[derive(Debug)]
pub enum Results {
    /// A run's folder.
    Run(RunFolder),
    /// A snapshot.
    Snapshot(Content),
    /// The state file of a checkpoint.
    Checkpoint(Content),
}

/// Why a path cannot be examined.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// It cannot be read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// It is none of ours.
    #[error("{} is neither a run folder, a snapshot nor a checkpoint", .0.display())]
    Unknown(PathBuf),
    /// Two paths of different types.
    #[error("{a} is a {a_kind} and {b} is a {b_kind}; give two of one kind")]
    Kinds {
        /// The first path.
        a: String,
        /// The type of the first.
        a_kind: &'static str,
        /// The second path.
        b: String,
        /// The type of the other.
        b_kind: &'static str,
    },
    /// A text of a run cannot be understood.
    #[error("{} cannot be read: {reason}", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// The fault.
        reason: String,
    },
}

impl Results {
    /// Opens a run folder, a checkpoint's folder or state file, or a snapshot.
    ///
    /// # Errors
    /// [`ResultsError::Output`], [`ResultsError::Unknown`].
    pub fn open(path: &Path) -> Result<Self, ResultsError> {
        if RunFolder::is_run(path) {
            return Ok(Self::Run(RunFolder::at(path)));
        }
        let state = checkpoint::state_file(path);
        if path.is_dir() && !state.is_file() {
            return Err(ResultsError::Unknown(path.to_owned()));
        }
        let file = Content::open(if path.is_dir() { &state } else { path })?;
        if file.has("VTKHDF") {
            Ok(Self::Snapshot(file))
        } else if file.has("fields") {
            Ok(Self::Checkpoint(file))
        } else {
            Err(ResultsError::Unknown(path.to_owned()))
        }
    }

    /// The type of the results, for people.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Run(_) => "run",
            Self::Snapshot(_) => "snapshot",
            Self::Checkpoint(_) => "checkpoint",
        }
    }
}

/// The message for a snapshot of a part of the model if all of it is needed.
#[must_use]
pub fn only_part(part: &str) -> String {
    format!("it holds a part of the model alone ({part}); give a snapshot of all particles")
}

/// Names of the components of a field of so many; `vtk` for the order that VTK wants.
#[must_use]
pub fn component_names(components: usize, vtk: bool) -> &'static [&'static str] {
    match components {
        3 => &["x", "y", "z"],
        6 if vtk => &["xx", "yy", "zz", "xy", "yz", "xz"],
        6 => &["xx", "yy", "zz", "xy", "xz", "yz"],
        9 => &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
        _ => &[""],
    }
}

/// The status of a run, and the holder of its folder if the status says `running` and `needs` asks
/// for that. `Nobody` is returned for a killed run alone, not for one that has ended in between.
pub(super) fn status_and_presence(
    folder: &RunFolder,
    needs_presence: impl Fn(&Status) -> bool,
) -> Result<(Status, Option<Presence>), OutputError> {
    let mut status = folder.status()?;
    while status.state == Phase::Running && needs_presence(&status) {
        let presence = Presence::of(folder.path());
        if !matches!(presence, Presence::Nobody(_)) {
            return Ok((status, Some(presence)));
        }
        // A run says how it has ended before it leaves its folder.
        let again = folder.status()?;
        if again == status {
            return Ok((status, Some(presence)));
        }
        status = again;
    }
    Ok((status, None))
}

/// The meaning of `running` in a status: a run that is killed cannot change it.
pub(super) fn running(presence: &Presence) -> String {
    match presence {
        Presence::Held(Some(holder)) => format!("running ({holder})"),
        Presence::Held(None) => "running".to_owned(),
        Presence::Nobody(_) => {
            "was running; killed or lost (no process holds the folder)".to_owned()
        }
        Presence::Unclear(holder) => {
            format!("running, or killed or lost ({holder}, which cannot be seen from this host)")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_ends_while_it_is_looked_at_is_not_killed() {
        let dir = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(dir.path());
        let write = |state| folder.write_status(&Status::new(state, 7, 1e-6)).unwrap();
        write(Phase::Running);
        let (status, presence) = status_and_presence(&folder, |_| true).unwrap();
        assert_eq!(status.state, Phase::Running);
        assert!(matches!(presence, Some(Presence::Nobody(None))));
        let ends = |_: &Status| {
            write(Phase::Finished);
            true
        };
        let (status, presence) = status_and_presence(&folder, ends).unwrap();
        assert_eq!(status.state, Phase::Finished);
        assert!(presence.is_none());
    }
}
