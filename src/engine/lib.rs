//! Engine: domain decomposition over ranks, SPH, contact, loads, sums and measures, and the loop.

pub mod contact;
pub mod diagnose;
pub mod domain;
pub mod fragments;
pub mod gravity;
pub mod loads;
pub mod measure;
pub mod sph;
pub mod step;
