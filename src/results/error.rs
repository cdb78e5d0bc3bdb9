//! Errors of results and checkpoints.

use std::io;
use std::path::{Path, PathBuf};

use uuid::Uuid;

/// An error of writing or reading back.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The system refused.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The action, as a verb.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The message of the system.
        source: io::Error,
    },
    /// HDF5 refused.
    #[error("cannot {action} {}: {reason}", path.display())]
    Hdf5 {
        /// The action, as a verb.
        action: String,
        /// The file.
        path: PathBuf,
        /// The message of HDF5.
        reason: String,
    },
    /// The run folder holds something already.
    #[error(
        "the folder {} is not empty; choose another with --out, or replace the run in it with \
         --force",
        path.display()
    )]
    FolderInUse {
        /// The folder.
        path: PathBuf,
    },
    /// `--force` on a folder that no run has made.
    #[error(
        "the folder {} is not empty and holds no run that lists its files (status.json, files.txt), so \
         --force does not clear it; choose another with --out",
        path.display()
    )]
    NotARun {
        /// The folder.
        path: PathBuf,
    },
    /// A run without a checkpoint.
    #[error(
        "the run {} has no {}checkpoint to restart from; run its case again{}",
        path.display(),
        if passed_over.is_empty() { "" } else { "whole " },
        lines(passed_over)
    )]
    NoCheckpoint {
        /// The run's folder.
        path: PathBuf,
        /// Errors of existing ones.
        passed_over: Vec<String>,
    },
    /// A checkpoint in no run folder.
    #[error(
        "{} is neither a run nor a checkpoint in one; name the run, or a checkpoint and a folder \
         for the results with --out",
        path.display()
    )]
    OutsideRun {
        /// The checkpoint.
        path: PathBuf,
    },
    /// A file with wrong content.
    #[error("{} is damaged: {what}", path.display())]
    Damaged {
        /// The file or folder.
        path: PathBuf,
        /// The damage, and advice.
        what: String,
    },
    /// A checkpoint of another program version.
    #[error(
        "the checkpoint {} has format {found}, this program reads format {known}; restart it with \
         the program that wrote it",
        path.display()
    )]
    Format {
        /// The checkpoint.
        path: PathBuf,
        /// Its format number.
        found: u64,
        /// The format number read here.
        known: u64,
    },
    /// A checkpoint with content that this program does not know, or without content that it needs.
    #[error(
        "the checkpoint {} was written by whipple {by}, and this is {}: {what}; restart it with the \
         program that wrote it",
        path.display(),
        crate::VERSION
    )]
    OtherVersion {
        /// The checkpoint or its file.
        path: PathBuf,
        /// Version and commit that wrote it.
        by: String,
        /// The difference.
        what: String,
    },
    /// A run is going on in the folder.
    #[error(
        "the folder {} is in use by {who}: wait for its end, stop it (`touch {}`), or choose another \
         folder with --out; --ignore-lock takes the folder all the same",
        path.display(),
        path.join("stop").display()
    )]
    Held {
        /// The folder.
        path: PathBuf,
        /// The holder.
        who: String,
    },
    /// The folder is no longer this run's.
    #[error(
        "the run no longer has its folder {}: {what}; nothing more is written, {}",
        path.display(),
        newest.as_ref().map_or_else(
            || "and no checkpoint of it is left".to_owned(),
            |newest| format!("the newest whole checkpoint is {}", newest.display())
        )
    )]
    Lost {
        /// The folder as it was taken.
        path: PathBuf,
        /// What became of it.
        what: String,
        /// The newest whole checkpoint.
        newest: Option<PathBuf>,
    },
    /// A file of another run than the folder's.
    #[error(
        "{} is of the run {run}, and {} holds the run {own}: two runs have written there; move away what is \
         not of the one you want",
        path.display(),
        folder.display()
    )]
    OtherRun {
        /// The file or checkpoint.
        path: PathBuf,
        /// Its run.
        run: Uuid,
        /// The run's folder.
        folder: PathBuf,
        /// Its run.
        own: Uuid,
    },
    /// A run on another host has not closed the folder.
    #[error(
        "the folder {} was not closed by {who}, and whether that still runs cannot be told from \
         {here}: look there; if it does not, --ignore-lock takes the folder",
        path.display()
    )]
    Unclear {
        /// The folder.
        path: PathBuf,
        /// The last holder.
        who: String,
        /// This host.
        here: String,
    },
    /// A snapshot field that does not exist.
    #[error("there is no snapshot field `{name}`; choose from {allowed}")]
    UnknownField {
        /// The name as given.
        name: String,
        /// All names, joined by commas.
        allowed: String,
    },
    /// Two particles share an id.
    #[error("two particles have the id {id}; ids must be unique")]
    DuplicateId {
        /// The id.
        id: u64,
    },
    /// Another rank met an error; the text is the same on every rank.
    #[error("{0}")]
    OtherRank(String),
}

impl OutputError {
    /// For `map_err` after a file operation.
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io {
            action,
            path,
            source,
        }
    }

    /// A file with wrong content.
    pub fn damaged(path: &Path, what: impl Into<String>) -> Self {
        Self::Damaged {
            path: path.to_owned(),
            what: what.into(),
        }
    }

    /// Returns true if a file is not what was written, as against one that cannot be read now or that
    /// another version wrote. On the rank that met the error: others receive only its text.
    #[must_use]
    pub fn is_damage(&self) -> bool {
        matches!(self, Self::Damaged { .. })
    }

    /// Returns true if another version of the program wrote it.
    #[must_use]
    pub fn is_other_version(&self) -> bool {
        matches!(self, Self::Format { .. } | Self::OtherVersion { .. })
    }
}

/// Each on a line of its own, with a line end before the first.
fn lines(reasons: &[String]) -> String {
    [&[String::new()], reasons].concat().join("\n  ")
}

/// An error of reading a snapshot.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file is missing, is not HDF5 or is damaged.
    #[error(transparent)]
    Open(#[from] OutputError),
    /// HDF5, but without something that every snapshot has.
    #[error(
        "{} is not a whipple snapshot: {what} cannot be read ({reason}); give a file of the run's \
         snapshots folder",
        path.display()
    )]
    Layout {
        /// The file.
        path: PathBuf,
        /// The missing object or attribute.
        what: String,
        /// The message of HDF5.
        reason: String,
    },
}
