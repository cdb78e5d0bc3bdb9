//! Laws of materials at one point, and exact solutions: no MPI, no files.

#[path = "../common/exact/mod.rs"]
mod exact;

mod ceramics;
mod concrete;
mod cracks;
mod eos;
mod exact_bars;
mod exact_elastic;
mod exact_gas;
mod exact_hugoniot;
mod exact_sum;
mod explosives;
mod failure;
mod fluids;
mod granular;
mod orthotropic;
mod plastic;
mod porosity;
mod rht;
mod rubber;
mod spall;
mod strength;
mod support;
mod tables;
mod thermal;
mod uncoupled;
