//! Slow physics, the second tier: `make validation` runs it.

#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/mod.rs"]
mod common;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/physics_support/mod.rs"]
mod physics_support;
#[path = "../common/project.rs"]
mod project;

mod absorbing;
mod alone;
mod contacts;
mod cratering;
mod dam;
mod debris;
mod flyer;
mod grading;
mod hertz;
mod impact;
mod punch;
mod ranks;
mod sliding;
mod taylor;
mod time_step;
mod total;
