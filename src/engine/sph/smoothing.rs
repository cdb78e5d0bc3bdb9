//! Smoothing lengths.

use model::{Body, Case, Sizes, SmoothingLength};
use particles::ParticleStore;
use particles::neighbours::SizeClasses;

/// Rule of smoothing lengths by densities (physics page, section 1).
#[derive(Debug, Clone)]
pub struct Smoothing {
    rule: SmoothingLength,
    dimension: usize,
    /// Length of each body at the start (m), where sizes differ of one of the spacing.
    reference: Vec<f64>,
    /// 1/ρ of each body at the start (m³/kg).
    inverse_density: Vec<f64>,
    sizes: Sizes,
    /// By body: factor of the reach of its particles, and the least one, of contact.
    stretch: Vec<f64>,
    widening: Vec<f64>,
    /// The longest length at the start (m).
    longest: f64,
}

impl Smoothing {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let inverse_density = |body| 1.0 / case.initial_density(body);
        let widening: Vec<f64> = case.bodies.iter().map(SizeClasses::widening).collect();
        Self {
            rule: case.sph.smoothing_length,
            dimension: case.extent(),
            reference: case.bodies.iter().map(|b| b.smoothing_length).collect(),
            inverse_density: case.bodies.iter().map(inverse_density).collect(),
            sizes: Sizes::new(case),
            stretch: widening.clone(),
            widening,
            longest: case
                .bodies
                .iter()
                .map(Body::longest_smoothing_length)
                .fold(0.0, f64::max),
        }
    }

    /// The length (m) of a particle of `body` with a mass (kg) at a density (kg/m³).
    #[inline]
    #[must_use]
    pub fn length(&self, body: usize, mass: f64, density: f64) -> f64 {
        let reference = self.at_start(body, mass);
        match self.rule {
            SmoothingLength::Constant => reference,
            SmoothingLength::Variable { min, max } => {
                let expansion = 1.0 / self.inverse_density[body] / density;
                let ratio = match self.dimension {
                    1 => expansion,
                    2 => expansion.sqrt(),
                    _ => libm::cbrt(expansion),
                };
                reference * ratio.clamp(min, max)
            }
        }
    }

    /// Half of the largest distance (m) at which particle `i` acts: sums take its length, contact
    /// that at the start.
    #[inline]
    #[must_use]
    pub fn reach(&self, particles: &ParticleStore, i: usize) -> f64 {
        let (body, length) = (particles.body[i] as usize, particles.smoothing_length[i]);
        match self.rule {
            // It has its length of the start.
            SmoothingLength::Constant => length * self.stretch[body],
            SmoothingLength::Variable { .. } => self.reach_of(body, particles.mass[i], length),
        }
    }

    /// The same of a particle of `body` with a mass (kg) and a length (m).
    #[inline]
    #[must_use]
    pub fn reach_of(&self, body: usize, mass: f64, length: f64) -> f64 {
        length.max(self.at_start(body, mass)) * self.stretch[body]
    }

    /// Sets how much farther the particles of a body reach than by their lengths.
    pub fn set_stretch(&mut self, body: usize, factor: f64) {
        self.stretch[body] = factor.max(self.widening[body]);
    }

    /// The length (m) of a particle of `body` with a mass (kg) at the start.
    #[inline]
    #[must_use]
    pub fn at_start(&self, body: usize, mass: f64) -> f64 {
        self.reference[body] * self.sizes.of(body, mass)
    }

    /// The longest length at the start (m).
    #[must_use]
    pub fn longest(&self) -> f64 {
        self.longest
    }
}
