//! whipple: MPI-parallel smoothed particle hydrodynamics for large 3-D impacts of solids.
//!
//! MPI ranks own slabs of space, threads work inside a rank, parallel HDF5 holds results and
//! checkpoints. The rooms below stand in the order in which data flows through a run; the
//! developer guide in `docs/` says what each may know. SI units everywhere inside the program.

pub mod app;
pub mod run;
pub mod sweep;

pub mod input;
pub mod model;
pub mod populate;
pub mod preflight;

pub mod numerics;

pub mod material;
pub mod particles;

pub mod comm;
pub mod domain;
pub mod fragments;
pub mod neighbours;

pub mod contact;
pub mod loads;
pub mod sph;
pub mod step;

pub mod diagnose;
pub mod measure;
pub mod output;

pub mod ballistic;
pub mod exact;
pub mod export;
pub mod plan;
pub mod plot;
pub mod report;
