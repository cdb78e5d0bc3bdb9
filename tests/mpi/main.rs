//! Real ranks under `mpirun`: of the test itself, or of the program.

#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/mod.rs"]
mod common;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/program.rs"]
mod program;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/project.rs"]
mod project;
#[path = "../common/stored.rs"]
mod stored;

use common::sentinel;

mod alone;
mod comm;
mod engine;
mod fragments;
mod initial;
mod output;
mod particles;
mod plan;
mod ranks;
mod same_bits;
