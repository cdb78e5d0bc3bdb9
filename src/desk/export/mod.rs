//! Exports: snapshots in the formats of other programs.
//!
//! A frame (`frame.rs`) is a snapshot with the columns that are asked for, and with images behind symmetry
//! planes if wanted. Each format is a file that writes frames piece by piece: only surfaces need a
//! whole snapshot in memory. Numbers are those of the snapshot: their bits in binary files, the
//! fewest digits that give them back in texts. SI units.

mod column;
mod csv;
mod error;
mod format;
mod frame;
mod images;
mod lammps;
mod npz;
mod paraview;
mod ply;
mod start;
mod stl;
pub(crate) mod surface;
mod text;
mod values;
mod vtu;
mod xyz;

pub use error::ExportError;
pub use format::{Destination, Format, Wish, export, script};
