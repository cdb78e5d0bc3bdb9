//! Charts and pictures.

#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/exact/shocks.rs"]
mod shocks;

mod cuts;
mod fixture;
mod pictures;
mod profile;
mod scene;
mod svg;
