//! Pictures: sections of models, to scale.

pub mod bar;
pub mod cells;
pub mod figure;
pub mod layout;
pub mod pictures;
pub mod raster;
pub mod section;
pub mod sheet;
mod table;
pub mod titles;
pub mod view;
