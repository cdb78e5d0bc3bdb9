//! Particles as a structure of arrays: the table of fields and the store that walks it.

mod fields;
mod image;
mod scatter;
mod store;

pub use fields::{FIELDS, FieldId, FieldInfo, FieldKind, FieldUse, ParticleStore};
pub use image::Image;
pub use scatter::Scatter;
pub use store::{SCRATCH_WORDS, TEMPERATURE, VON_MISES_STRESS, resize, snapshot_names, with_use};
