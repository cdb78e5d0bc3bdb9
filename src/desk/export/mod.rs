//! Room export: snapshots in the formats of other programs.
//!
//! A [`Frame`] is a snapshot with the columns that are asked for, images behind symmetry planes
//! included where these are wanted; each format is a file that writes frames, piece by piece, so
//! that no snapshot stands whole in memory but for its surfaces. Numbers are those of the snapshot: their
//! bits in binary files, the fewest digits that give them back in texts. SI units.

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
mod surface;
mod text;
mod values;
mod vtu;
mod xyz;

pub use error::ExportError;
pub use format::{Format, Place, Wish, export, script};
