//! Results and checkpoints: the files of a run, when they are written, and how they are read back.
//!
//! All ranks call the writers together and all get the same result: ranks agree on every return code
//! before any goes on ([`agree`]), so that callers leave together. Rows are in the order of
//! particle ids ([`Rows`]), whatever the ranks. [`h5`] is the only module that names HDF5.

mod adopt;
mod begin;
pub mod binary_table;
mod block;
pub mod checkpoint;
mod digest;
mod extents;
pub mod fragments;
pub mod gauge_records;
pub mod h5;
mod history;
mod listing;
mod lock;
mod log;
pub mod measures;
pub mod partitions;
pub mod post_mortem;
mod quantity;
mod row_schedule;
mod rows;
mod run_folder;
mod schedule;
pub mod series;
mod set_aside;
pub mod snapshot;
mod snapshot_folders;
mod status;
mod vote;

use std::sync::OnceLock;

pub use adopt::Forked;
pub use block::Block;
pub use extents::{ResultExtents, TableExtent};
pub use history::{Column, Table, Value, unit_of_model};
pub use lock::{Holder, Presence, RunLock};
pub use log::Log;
pub(crate) use results::files::make_folder;
pub use results::files::{read_regular, read_sheet, read_small, write_atomically, write_json};
pub use results::{NewFile, OutputError, Sheet, VERSION, table_line};
use results::{files, sheet};
pub use row_schedule::RowSchedule;
pub use rows::Rows;
pub use run_folder::RunFolder;
pub use schedule::Schedule;
pub use set_aside::SetAside;
pub use status::{Energies, Outlook, Phase, Status};
use vote::publish_or_remove;
pub use vote::{agree, from_root, on_root, same_on_all};

static COMMIT: OnceLock<&'static str> = OnceLock::new();

/// Sets the commit that the program is built from, once and before anything else. Only the build of the
/// program knows it, so that a commit alone rebuilds nothing else.
pub fn set_commit(commit: &'static str) {
    COMMIT.get_or_init(|| commit);
}

/// The commit that the program is built from, or `unknown`.
#[must_use]
pub fn commit() -> &'static str {
    COMMIT.get().copied().unwrap_or("unknown")
}
