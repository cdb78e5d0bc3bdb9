//! Small cases held to exact figures.

#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/mod.rs"]
mod common;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/exact/noh.rs"]
mod noh;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/physics_support/mod.rs"]
mod physics_support;
#[path = "../common/project.rs"]
mod project;
#[path = "../common/exact/release.rs"]
mod release;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/exact/shocks.rs"]
mod shocks;

mod absorbing;
mod axisymmetric;
mod bars;
mod block;
mod contact;
mod contact_stress;
mod dam;
mod debris;
mod elastic;
mod explosives;
mod failure;
mod flyer;
mod friction;
mod gas;
mod gentle_start;
mod granular;
mod gravity;
mod hit_bar;
mod hole;
mod joints;
mod options;
mod orthotropic;
mod penalty;
mod porous;
mod quarter;
mod rigid_bodies;
mod rings;
mod self_contact;
mod spall;
mod spin;
mod stress_points;
mod time_step;
mod uncoupled;
mod waves;
