//! Errors of pictures.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use results::ReadError;

/// Why a picture could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// A snapshot could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A snapshot can be read, but what it says of itself makes no sense.
    #[error("{} is damaged: {reason}", path.display())]
    Snapshot {
        /// The file.
        path: PathBuf,
        /// The fault.
        reason: String,
    },
    /// The path is neither a snapshot nor a run with snapshots.
    #[error("no snapshots in {}: give a snapshot file or the folder of a run", path.display())]
    NoSnapshots {
        /// The folder.
        path: PathBuf,
    },
    /// No snapshot has this number.
    #[error("no snapshot {index}: the run has snapshots 0 to {last}")]
    Index {
        /// As asked for.
        index: usize,
        /// The largest there is.
        last: usize,
    },
    /// The snapshots do not hold this field.
    #[error("no field \"{name}\": {}the snapshot has {}", nearest.as_ref().map(|n| format!("did you mean \"{n}\"? ")).unwrap_or_default(), known.join(", "))]
    Field {
        /// As asked for.
        name: String,
        /// The most similar name, if one is similar.
        nearest: Option<String>,
        /// All names.
        known: Vec<String>,
    },
    /// The field has no such component.
    #[error("{}: {known}", component.as_ref().map_or_else(
        || format!("field \"{field}\" needs a component, as in {field}.COMPONENT"),
        |component| format!("field \"{field}\" has no component \"{component}\"; it has"),
    ))]
    Component {
        /// The field.
        field: String,
        /// As asked for, if one was.
        component: Option<String>,
        /// The known ones.
        known: String,
    },
    /// The snapshots hold no such body.
    #[error("no body \"{name}\": the snapshot has {}", known.join(", "))]
    Body {
        /// As asked for.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// A number, its unit or a range is wrong.
    #[error("cannot read \"{text}\": give {expected}")]
    Quantity {
        /// As typed.
        text: String,
        /// The accepted ones.
        expected: String,
    },
    /// A plane is not written as `AXIS=POSITION`.
    #[error(
        "cannot read the section \"{text}\": give an axis and a position, as in y=0 or x=0.1mm"
    )]
    Section {
        /// As typed.
        text: String,
    },
    /// The plane misses all particles.
    #[error(
        "no particle lies in the section {axis} = {position}: the particles reach from {lowest} to \
         {highest}"
    )]
    Empty {
        /// Normal of the plane.
        axis: &'static str,
        /// The position of the plane, with unit.
        position: String,
        /// Smallest coordinate, with unit.
        lowest: String,
        /// Largest coordinate, with unit.
        highest: String,
    },
    /// A table cannot be drawn.
    #[error("cannot plot {}: {reason}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// The fault, and its line.
        reason: String,
    },
    /// The run has no answer that is known exactly.
    #[error("no exact answer: {reason}")]
    Exact {
        /// The reason, and the cases that have one.
        reason: String,
    },
    /// No particle lies on the line.
    #[error("no particle lies on the line {line}: choose another with --through, or --thickness")]
    Line {
        /// The line.
        line: String,
    },
    /// Two options, or an option and the input, exclude each other.
    #[error("{0}")]
    Options(&'static str),
    /// The picture would be too small or too large.
    #[error("cannot draw a picture of {width} × {height} pixels: choose another --width")]
    Size {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The picture's name has an ending that is none of ours.
    #[error("cannot write {}: give a name that ends in {expected}", path.display())]
    Ending {
        /// As asked for.
        path: PathBuf,
        /// Endings that it could have, and what else it could be.
        expected: &'static str,
    },
    /// A picture that was made is none that can be read: a fault of ours.
    #[error("cannot draw the picture: {reason}")]
    Svg {
        /// The fault.
        reason: String,
    },
    /// The picture could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    Save {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        reason: String,
    },
}

impl PlotError {
    /// A text that is not what was expected.
    pub(crate) fn quantity(text: &str, expected: impl Into<String>) -> Self {
        Self::Quantity {
            text: text.to_owned(),
            expected: expected.into(),
        }
    }

    /// A file that could not be written.
    pub(crate) fn unsaved(path: &Path, reason: impl Display) -> Self {
        Self::Save {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}
