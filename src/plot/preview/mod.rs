//! The filled model before a run: a section through its particles, and what is seen of them along the
//! axes, with symmetry planes, rigid surfaces, the box of interest and velocities.

mod extent;
mod image;
mod marks;
pub mod page;
mod panel;
mod sites;
mod surfaces;
