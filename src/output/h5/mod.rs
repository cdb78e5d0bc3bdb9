//! The only room that names HDF5.

pub mod read;
