//! Section of a struck body at the start, seen along its normal.

use super::frame::Frame;
use super::matter::Matter;
use model::{Slab, Solid};
use particles::Mirrors;

/// The section of a body as it was at the start, half way between its faces.
pub struct Footprint {
    solid: Solid,
    frame: Frame,
    mirrors: Mirrors,
    height: f64,
    /// Thickness (m) of the rim that does not count.
    margin: f64,
}

impl Footprint {
    /// Of a slab, without a rim (m): the outermost voxels of a filling may be less than half full.
    pub fn new(slab: &Slab, frame: &Frame, rim: f64, matter: &Matter) -> Self {
        let shape = &matter.case.bodies[slab.body].shape;
        Self {
            solid: shape.solid(matter.case.dimension),
            frame: *frame,
            mirrors: matter.mirrors,
            height: 0.5 * (slab.front + slab.rear),
            margin: rim.min(0.25 * slab.thickness()),
        }
    }

    /// True if a place of two coordinates (m) across the normal is within it.
    pub fn holds(&self, [u, w]: [f64; 2]) -> bool {
        let x = self.frame.back(&[u, w, self.height]);
        let beyond = self.mirrors.beyond(&x);
        let kept = self.mirrors.reflect_position(&x, beyond);
        self.solid.distance(&kept.into()) <= -self.margin
    }

    /// True if the straight way on which a particle at a place (m) flies at a velocity (m/s) has led through it, if
    /// the particle flies away to the rear; else whether it is behind it.
    pub fn let_through(&self, place: &[f64; 3], velocity: &[f64; 3]) -> bool {
        let [u, w, height] = self.frame.turned(place);
        let [along_u, along_w, away] = self.frame.turned(velocity);
        let time = if away < 0.0 {
            (height - self.height) / away
        } else {
            0.0
        };
        self.holds([u - time * along_u, w - time * along_w])
    }
}
