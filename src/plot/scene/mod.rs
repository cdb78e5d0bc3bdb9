//! Views of whole models: balls with soft light, from any side, cut open where wanted.

pub mod buffer;
pub mod camera;
pub mod cut;
pub mod occlusion;
pub mod render;
pub mod scenes;
pub mod shading;
pub mod survey;
pub mod triad;
pub mod window;
