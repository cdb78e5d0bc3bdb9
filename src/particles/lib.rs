//! Particles as a structure of arrays: the table of fields and the store that walks it.

mod arrays;
mod columns;
pub mod connected;
#[macro_use]
mod declare;
mod fields;
mod image;
mod inactive;
mod kept_blocks;
mod messages;
mod mirror_mask;
mod mirrors;
pub mod neighbours;
mod point;
mod records;
mod scatter;
mod select;
mod store;

pub use arrays::{SCRATCH_WORDS, empty, resize};
pub use columns::{FieldKind, HaloPhase, Life, Mirror, Output, Owner};
pub use fields::{FIELDS, FieldId, FieldInfo, ParticleStore};
pub use image::{HaloImages, Image};
pub use inactive::{Active, ActiveMut, Inactive, PART};
pub use kept_blocks::{Block, KeptBlocks};
pub use messages::copy_at_once;
pub use mirror_mask::MirrorMask;
pub use mirrors::{MirrorForce, Mirrors};
pub use point::MaterialPoints;
pub use records::Records;
pub use scatter::Scatter;
pub use select::Select;
pub use store::{
    FRAGMENT, STRESS, TEMPERATURE, VON_MISES_STRESS, gauge_names, rows, snapshot_names,
};

/// Particles that a task handles at least, where they take little work each.
pub const GRAIN: usize = 1024;
