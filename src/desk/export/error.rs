//! Errors of exports.

use std::path::PathBuf;

use files::output::OutputError;
use plot::PlotError;
use results::ReadError;

/// Why a snapshot could not be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// No snapshot, or none that says what is asked for.
    #[error(transparent)]
    Choice(#[from] PlotError),
    /// A file could not be read or written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A snapshot cannot be exported as is asked.
    #[error("cannot export {}: {reason}", path.display())]
    Snapshot {
        /// The snapshot.
        path: PathBuf,
        /// The reason, and a remedy.
        reason: String,
    },
    /// Options that do not go together.
    #[error("{0}")]
    Options(String),
}

impl From<ReadError> for ExportError {
    fn from(error: ReadError) -> Self {
        PlotError::from(error).into()
    }
}
