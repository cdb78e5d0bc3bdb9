//! The file of a checkpoint that holds the particles.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::manifest::OLDER;
use crate::output::h5::{Element, RowType};
use crate::output::{OutputError, from_root};
use comm::Comm;
use particles::FieldKind;

pub(in crate::output) const STATE: &str = "state.h5";
/// Group of the fields in the state file.
pub const FIELDS: &str = "/fields";

/// The state file of a checkpoint.
#[must_use]
pub fn state_file(folder: &Path) -> PathBuf {
    folder.join(STATE)
}

/// The type of a field's rows in a file.
pub(in crate::output) fn row_type(kind: FieldKind) -> RowType {
    let element = match kind {
        FieldKind::Id => Element::U64,
        FieldKind::Index => Element::U32,
        _ => Element::F64,
    };
    RowType {
        element,
        components: kind.components(),
    }
}

/// The size of a state file as rank 0 sees it. Collective.
pub(super) fn size_of(comm: &Comm, path: &Path) -> Result<u64, OutputError> {
    from_root(comm, || match fs::metadata(path) {
        Ok(meta) => Ok(meta.len()),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(OutputError::damaged(
            path,
            format!("it is missing; {OLDER}"),
        )),
        Err(error) => Err(OutputError::io("read", path)(error)),
    })
}
