//! Products of results, and formulas to compare them with: pages, exports, sweeps, ballistic
//! limits.

pub mod ballistic;
pub mod catalogue;
pub mod export;
pub mod report;
pub mod sweep;
