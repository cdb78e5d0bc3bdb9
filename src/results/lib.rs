//! Files of results without HDF5, MPI or inputs: small files, new ones, tables, and the traits through which all else
//! is read ([`Opener`], [`SnapshotReader`]).

mod error;
pub mod files;
mod new_file;
mod opener;
pub mod regular;
pub mod sheet;

pub use error::{OutputError, ReadError};
pub use new_file::NewFile;
pub use opener::{Opener, SnapshotReader};
pub use sheet::Sheet;
pub use sheet::line as table_line;

/// The program's version.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
