//! What is read and written: inputs, particles, surfaces, checkpoints, tables; and what is told of a case before it runs.

#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/project.rs"]
mod project;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/stored.rs"]
mod stored;

use common::sentinel;

mod input_absorbers;
mod input_bad;
mod input_case;
mod input_errors;
mod input_meshes;
mod input_particles;
mod input_shapes;
mod input_surfaces;
mod many_bodies;
mod measures;
mod output_checkpoint;
mod output_compare;
mod output_virtual_ranks;
mod plan;
mod preflight_warnings;
mod schema_keys;
mod surfaces;
