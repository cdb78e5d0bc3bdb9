//! The hole that an impact leaves in a plate.
//!
//! Radius of the hole: where the areal density of what is left of the plate, averaged round the
//! axis, passes half of its first value. Only the plate's particles in a slab of twice its
//! thickness about its first mid-plane count, so that debris which has left the plate does not
//! close the hole.

use crate::numerics::exact_sum::ExactSum;

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
    #[must_use]
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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A plate on a lattice from z = 0 to z = 0.2 without what lies inside `hole`.
    #[allow(clippy::cast_possible_truncation, reason = "a few layers")]
    fn plate_with_hole(hole: f64, spacing: f64, quarter: bool) -> (Plate, Vec<[f64; 3]>) {
        let plate = Plate {
            centre: [0.0, 0.0, 0.1],
            axis: 2,
            thickness: 0.2,
            density: 3.0,
            spacing,
            angle: if quarter { TAU / 4.0 } else { TAU },
        };
        let n = (1.0 / spacing).round() as i32;
        let first = if quarter { 0 } else { -n };
        let at = |i: i32| (f64::from(i) + 0.5) * spacing;
        let mut positions = Vec::new();
        for i in first..n {
            for j in first..n {
                let r2 = at(i) * at(i) + at(j) * at(j);
                for k in 0..(0.2 / spacing).round() as i32 {
                    if r2 > hole * hole && r2 < 1.0 {
                        positions.push([at(i), at(j), at(k)]);
                    }
                }
            }
        }
        (plate, positions)
    }

    fn measure(plate: &Plate, positions: &[[f64; 3]]) -> Option<f64> {
        let mass = plate.density * plate.spacing * plate.spacing * plate.spacing;
        plate.hole_radius(positions.iter().map(|x| (x, mass)))
    }

    #[test]
    fn finds_the_radius_of_a_hole() {
        for hole in [0.3, 0.41, 0.52] {
            for quarter in [false, true] {
                let (plate, positions) = plate_with_hole(hole, 0.02, quarter);
                let found = measure(&plate, &positions).expect("a hole");
                assert!(
                    (found - hole).abs() < 0.2 * plate.spacing,
                    "{hole}: {found}"
                );
            }
        }
    }

    #[test]
    fn debris_off_the_plate_does_not_close_the_hole() {
        let (plate, mut positions) = plate_with_hole(0.4, 0.02, true);
        let whole = measure(&plate, &positions);
        let cover: Vec<_> = positions
            .iter()
            .map(|x| [x[0] - 0.4, x[1], x[2] - 0.5])
            .collect();
        positions.extend(cover);
        assert_eq!(measure(&plate, &positions), whole);
    }

    #[test]
    fn a_plate_without_hole_has_none() {
        let (plate, positions) = plate_with_hole(0.0, 0.02, true);
        assert_eq!(measure(&plate, &positions), None);
    }
}
