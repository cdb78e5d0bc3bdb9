//! The main job, `inputs/quarter-impact`, and what is measured on it.

use std::f64::consts::TAU;

use engine::step::Simulation;
use model::Shape;

use super::hole::Plate;
use super::{median, ready, start};

/// Bodies of the input, in its order.
pub const PLATE: u32 = 0;
/// See [`PLATE`].
pub const SPHERE: u32 = 1;

/// The main job with overrides, at time zero.
pub fn main_job(overrides: &[&str]) -> Simulation {
    start(ready("quarter-impact", overrides))
}

/// Radius of the hole in the plate (m).
pub fn hole_radius(s: &Simulation) -> Option<f64> {
    let body = &s.case.bodies[PLATE as usize];
    let Shape::Cylinder {
        centre,
        axis,
        length,
        ..
    } = body.shape
    else {
        panic!("the plate is a cylinder");
    };
    let plate = Plate {
        centre: centre.into(),
        axis: axis.index(),
        thickness: length,
        density: s.case.materials[body.material].reference_density,
        spacing: body.lattice.spacing,
        angle: s.case.symmetry.iter().fold(TAU, |angle, _| 0.5 * angle),
    };
    let particles = &s.particles;
    plate.hole_radius(
        (0..particles.owned())
            .filter(|&i| particles.body[i] == PLATE)
            .map(|i| (&particles.position[i], particles.mass[i])),
    )
}

/// The particles near the axis of impact by layers, as they were at time zero: counted from the
/// face that the bodies touch at.
pub struct Layers {
    /// Identities: two bodies, then layers from the surface inwards.
    pub ids: [Vec<Vec<u64>>; 2],
}

impl Layers {
    /// Eight layers of both bodies within half of the sphere's radius from the axis.
    pub fn new(s: &Simulation) -> Self {
        let spacing = s.case.bodies[0].lattice.spacing;
        let Shape::Sphere { centre, radius } = s.case.bodies[SPHERE as usize].shape else {
            panic!("the sphere is a sphere");
        };
        let Shape::Cylinder {
            centre: plate,
            length,
            ..
        } = s.case.bodies[PLATE as usize].shape
        else {
            panic!("the plate is a cylinder");
        };
        let mut ids = [vec![Vec::new(); 8], vec![Vec::new(); 8]];
        for i in 0..s.particles.owned() {
            let [x, y, z] = s.particles.position[i];
            if x * x + y * y > 0.25 * radius * radius {
                continue;
            }
            let depth = if s.particles.body[i] == PLATE {
                plate.z + 0.5 * length - z
            } else if z < centre.z {
                radius - (x * x + y * y + (z - centre.z) * (z - centre.z)).sqrt()
            } else {
                continue;
            };
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "few layers"
            )]
            let layer = (depth / spacing).max(0.0) as usize;
            if let Some(layer) = ids[s.particles.body[i] as usize].get_mut(layer) {
                layer.push(s.particles.id[i]);
            }
        }
        for layer in ids.iter_mut().flatten() {
            layer.sort_unstable();
        }
        Self { ids }
    }

    /// Smallest and median distance (in spacings) from the particles of a body's layer to their
    /// nearest neighbour in the same body.
    pub fn nearest(&self, s: &Simulation, body: u32, layer: usize) -> (f64, f64) {
        let particles = &s.particles;
        let wanted = &self.ids[body as usize][layer];
        let own: Vec<&[f64; 3]> = (0..particles.owned())
            .filter(|&i| particles.body[i] == body)
            .map(|i| &particles.position[i])
            .collect();
        let spacing = s.case.bodies[body as usize].lattice.spacing;
        let distances: Vec<f64> = (0..particles.owned())
            .filter(|&i| wanted.binary_search(&particles.id[i]).is_ok())
            .map(|i| {
                let x = &particles.position[i];
                let square = |y: &[f64; 3]| (0..3).map(|a| (x[a] - y[a]) * (x[a] - y[a])).sum();
                let least = own
                    .iter()
                    .map(|y| square(y))
                    .filter(|&d: &f64| d > 0.0)
                    .fold(f64::INFINITY, f64::min);
                least.sqrt() / spacing
            })
            .collect();
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        (least, median(distances))
    }
}
