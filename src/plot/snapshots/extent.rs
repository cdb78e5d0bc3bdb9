//! The extent of particles, and the motion of bodies.

/// The extent of particles along an axis.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    pub lowest: f64,
    pub highest: f64,
    sum: f64,
    count: f64,
}

impl Default for Extent {
    fn default() -> Self {
        Self {
            lowest: f64::INFINITY,
            highest: f64::NEG_INFINITY,
            sum: 0.0,
            count: 0.0,
        }
    }
}

impl Extent {
    /// Adds a particle; one that is not finite lies nowhere.
    pub fn add(&mut self, coordinate: f64) {
        if coordinate.is_finite() {
            self.lowest = self.lowest.min(coordinate);
            self.highest = self.highest.max(coordinate);
            self.sum += coordinate;
            self.count += 1.0;
        }
    }

    /// Mean coordinate (m); 0 without particles.
    pub fn mean(&self) -> f64 {
        if self.count > 0.0 {
            self.sum / self.count
        } else {
            0.0
        }
    }
}

/// A body and its motion, as far as the choice of a plane needs them.
#[derive(Debug, Clone, Default)]
pub struct Mover {
    /// The extents of its particles.
    pub extents: [Extent; 3],
    /// Their number.
    pub particles: f64,
    /// Its mass at the start of the run (kg).
    pub mass: f64,
    /// Mean velocity (m/s).
    pub velocity: [f64; 3],
}
