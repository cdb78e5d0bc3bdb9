//! Particles as a structure of arrays: the table of fields and the store that walks it.

mod columns;
mod fields;
mod image;
mod point;
mod scatter;
mod store;

pub use columns::{FieldInfo, FieldKind, HaloPhase, Life, Mirror, Output, Owner, Select};
pub use fields::{FIELDS, FieldId, ParticleStore};
pub use image::Image;
pub use point::MaterialPoints;
pub(crate) use point::material_points;
pub use scatter::Scatter;
pub use store::{SCRATCH_WORDS, TEMPERATURE, VON_MISES_STRESS, resize, rows, snapshot_names};
