//! What is made of results, and formulas beside them: pictures, pages, exports, sweeps, ballistic limits.

pub mod ballistic;
pub mod export;
pub mod report;
pub mod sweep;
