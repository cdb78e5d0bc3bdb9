//! Room output.

pub mod h5;
