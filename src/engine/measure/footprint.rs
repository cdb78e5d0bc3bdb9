//! A struck body at the start, seen along its normal: its section and its faces.

use super::frame::Frame;
use super::matter::Matter;
use model::{Slab, Solid};
use particles::Mirrors;

/// A face is found to this part of the thickness.
const FOUND: f64 = 1e-9;

/// Most steps towards a face; each goes as far as nothing can be.
const MOST_STEPS: usize = 256;

/// The section of a body as it was at the start, half way between its faces.
pub struct Footprint {
    solid: Solid,
    frame: Frame,
    mirrors: Mirrors,
    height: f64,
    /// Heights (m) of the rear and of the front.
    ends: [f64; 2],
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
            ends: [slab.rear, slab.front],
            margin: rim.min(0.25 * slab.thickness()),
        }
    }

    /// True if a place of two coordinates (m) across the normal is within it.
    pub fn holds(&self, across: [f64; 2]) -> bool {
        self.distance(across, self.height) <= -self.margin
    }

    /// Distance (m) of a place from the body, of two coordinates (m) across the normal and a height (m).
    fn distance(&self, [u, w]: [f64; 2], height: f64) -> f64 {
        let x = self.frame.back(&[u, w, height]);
        let beyond = self.mirrors.beyond(&x);
        let kept = self.mirrors.reflect_position(&x, beyond);
        self.solid.distance(&kept.into())
    }

    /// Height (m) at which the body begins as seen from its front, and the cosine of the slope of its surface there,
    /// if it stands on that line.
    pub fn front(&self, across: [f64; 2]) -> Option<(f64, f64)> {
        let [rear, front] = self.ends;
        let height = self.face(across, front, rear)?;
        if height == front {
            return Some((front, 1.0));
        }
        let step = self.margin;
        let slope = (self.distance(across, height + step) - self.distance(across, height)) / step;
        Some((height, slope.clamp(0.0, 1.0)))
    }

    /// Height (m) at which it begins as seen from its rear.
    pub fn rear(&self, across: [f64; 2]) -> Option<f64> {
        let [rear, front] = self.ends;
        self.face(across, rear, front)
    }

    /// Height (m) at which the body begins on a line from one height (m) to another.
    fn face(&self, across: [f64; 2], from: f64, to: f64) -> Option<f64> {
        let length = (to - from).abs();
        let close = FOUND * length;
        let along = |way: f64| from + (to - from).signum() * way;
        let (mut way, mut before) = (0.0, 0.0);
        let is_met = (0..MOST_STEPS).any(|_| {
            let left = self.distance(across, along(way));
            if left > close && way <= length {
                before = way;
                way += left.max(1e-3 * length);
            }
            left <= close
        });
        if !is_met {
            return None;
        }
        // The last step may have gone a little into it.
        while way - before > close {
            let middle = 0.5 * (before + way);
            if self.distance(across, along(middle)) <= close {
                way = middle;
            } else {
                before = middle;
            }
        }
        Some(along(way))
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
