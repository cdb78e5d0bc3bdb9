//! The parts of a step and whole steps, on one rank or on virtual ones.

#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/mod.rs"]
mod common;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/physics_support/mod.rs"]
mod physics_support;
#[path = "../common/project.rs"]
mod project;

mod bits;
mod bridge;
mod broken;
mod cloud;
mod contact;
mod core;
mod corrected;
mod corrected_world;
mod dimensions;
mod fragments;
mod gauges;
mod initial;
mod keep;
mod linear_field;
mod loads;
mod measures;
mod meetings;
mod mirrors;
mod neighbours;
mod no_allocation;
mod normalised;
mod sph;
mod step;
mod stress_points;
mod surfaces;
mod terms;
mod total;
mod touch;
mod virtual_ranks;
mod world;
