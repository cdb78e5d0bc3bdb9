//! Sizes of particles.

use super::{Case, edge};

/// Sizes of particles over those of the spacing of their bodies, by their masses.
#[derive(Debug, Clone)]
pub struct Sizes {
    dimension: usize,
    /// One over the mass (kg) of a particle of size one, by body; zero where all are alike.
    inverse_masses: Vec<f64>,
}

impl Sizes {
    /// Of the bodies of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let inverse = |body: &super::Body| {
            let mass = case.particle_mass(body);
            body.lattice.sizes.map_or(0.0, |_| 1.0 / mass)
        };
        Self {
            dimension: case.dimension,
            inverse_masses: case.bodies.iter().map(inverse).collect(),
        }
    }

    /// Of a particle of a body with a mass (kg).
    #[inline]
    #[must_use]
    pub fn of(&self, body: usize, mass: f64) -> f64 {
        let inverse = self.inverse_masses[body];
        if inverse == 0.0 {
            return 1.0;
        }
        edge(mass * inverse, self.dimension)
    }
}
