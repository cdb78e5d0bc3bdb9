//! The hole that an impact leaves in a plate.
//!
//! Radius of the hole: where the areal density of what is left of the plate, averaged round the
//! axis, passes half of its first value. Only the plate's particles in a slab of twice its
//! thickness about its first mid-plane count, so that debris which has left the plate does not
//! close the hole.

use numerics::exact_sum::ExactSum;

/// A flat plate as it was before the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// A point of the mid-plane on the axis of the hole (m).
    pub centre: [f64; 3],
    /// Normal of the plate: 0, 1 or 2.
    pub axis: usize,
    /// Thickness (m).
    pub thickness: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Particle spacing (m).
    pub spacing: f64,
    /// Angle about the axis that the model keeps (rad): 2π for a whole model, π/2 for a quarter.
    pub angle: f64,
}

/// Steps by which the search goes inwards, in particle spacings.
const STEP: f64 = 0.25;
/// Halvings of the last step.
const HALVINGS: usize = 40;

impl Plate {
    /// Radius of the hole (m) from positions (m) and masses (kg) of the plate's particles; `None`
    /// without a hole of at least one spacing.
    ///
    /// The areal density at a radius is the mean over the ring about it, weighted with a hat of
    /// half-width two spacings; its half is sought from the rim inwards.
    pub fn hole_radius<'a>(
        &self,
        particles: impl IntoIterator<Item = (&'a [f64; 3], f64)>,
    ) -> Option<f64> {
        let [u, v] = [(self.axis + 1) % 3, (self.axis + 2) % 3];
        let rings: Vec<(f64, f64)> = particles
            .into_iter()
            .map(|(x, mass)| (std::array::from_fn(|a| x[a] - self.centre[a]), mass))
            .filter(|(r, _): &([f64; 3], f64)| r[self.axis].abs() < self.thickness)
            .map(|(r, mass)| ((r[u] * r[u] + r[v] * r[v]).sqrt(), mass))
            .collect();
        let half = 0.5 * self.density * self.thickness;
        let is_plate = |radius: f64| self.areal_density(&rings, radius) >= half;
        let rim = rings.iter().fold(0.0, |most, ring| f64::max(most, ring.0));
        let mut inside = rim;
        while !is_plate(inside) {
            inside -= STEP * self.spacing;
            if inside < self.spacing {
                return None;
            }
        }
        let mut hole = inside;
        while is_plate(hole) {
            (inside, hole) = (hole, hole - STEP * self.spacing);
            if hole < self.spacing {
                return None;
            }
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (hole + inside);
            if is_plate(middle) {
                inside = middle;
            } else {
                hole = middle;
            }
        }
        Some(0.5 * (hole + inside))
    }

    /// Areal density (kg/m²) about a radius (m) of particles at `(radius, mass)`.
    fn areal_density(&self, rings: &[(f64, f64)], radius: f64) -> f64 {
        let width = 2.0 * self.spacing;
        let mut mass = ExactSum::default();
        for &(r, m) in rings {
            let weight = 1.0 - (r - radius).abs() / width;
            if weight > 0.0 {
                // Each particle stands for an arc of its own ring.
                mass.add(m * weight / (r * self.angle * width));
            }
        }
        mass.value()
    }
}
