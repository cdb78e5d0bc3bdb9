//! Checkpoints: the whole state of a run, bit for bit, in a folder that is whole or absent.
//!
//! `step-NNNNNNNN/` holds `state.h5` (each state field in id order, the caller's own state and the
//! resolved input as text) and `manifest.json` (sizes and digests). It is written under another
//! name and renamed at the end; an older one of the same step is called `.old` meanwhile, and
//! is valid as long as there is no other. Any number of ranks may read it.

mod folder;
mod manifest;
mod read;
mod state_file;
mod write;

pub(super) use folder::{DAMAGED, discard, folder_name, step_of};
pub use folder::{keep_newest, list, list_broken, list_damaged};
pub(super) use manifest::run_of;
pub use manifest::{FORMAT, MANIFEST, Manifest, manifest};
pub use read::{Restored, read};
pub use state_file::{FIELDS, state_file};
pub(super) use state_file::{STATE, row_type};
pub use write::{Meta, write};
