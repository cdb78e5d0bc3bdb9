//! Radiographs: the mass that lies along each line of sight, per area.

pub mod radiographs;
pub mod spread;
