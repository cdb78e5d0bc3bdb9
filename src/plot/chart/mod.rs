//! Charts: curves over common axes, from tables and from snapshots along a line.

pub mod curves;
pub mod distributions;
pub mod exact;
pub mod fragments;
pub mod history;
pub mod profile;
mod ranks;
pub mod series;
pub mod sheet;
pub mod table;
pub mod tables;
pub mod tornado;
