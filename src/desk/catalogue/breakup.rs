//! The size distribution of NASA's standard breakup model, for collisions.
//!
//! Johnson, Krisko, Liou & Anz-Meador (2001), NASA's new breakup model of EVOLVE 4.0, Adv. Space Res. 28, 1377–1384:
//! `N(L) = 0.1 M^0.75 L^−1.71` pieces are as long as L (m) or longer. M is the mass of both bodies (kg) if the kinetic energy of the
//! smaller, relative to the larger, is 40 J or more for each gram of the larger: both break up. Else it is the mass of the smaller (kg) times
//! the square of its speed (km/s).

/// Energy (J/kg) from which on a collision is catastrophic.
const CATASTROPHIC: f64 = 40e3;

/// A collision of two bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// Masses (kg) of the smaller and of the larger body.
    pub masses: [f64; 2],
    /// Relative speed (m/s).
    pub speed: f64,
}

impl Collision {
    /// Energy of the smaller body over the mass of the larger (J/kg).
    #[must_use]
    pub fn specific_energy(&self) -> f64 {
        let [small, large] = self.masses;
        0.5 * small * self.speed * self.speed / large
    }

    /// True if both bodies break up.
    #[must_use]
    pub fn is_catastrophic(&self) -> bool {
        self.specific_energy() >= CATASTROPHIC
    }

    /// Number of pieces as long as a length (m), or longer.
    #[must_use]
    pub fn number(&self, length: f64) -> f64 {
        let [small, large] = self.masses;
        let mass = if self.is_catastrophic() {
            small + large
        } else {
            small * (1e-3 * self.speed) * (1e-3 * self.speed)
        };
        0.1 * libm::pow(mass, 0.75) * libm::pow(length, -1.71)
    }
}

#[cfg(test)]
mod tests {
    use super::Collision;

    /// The curve of a catastrophic collision of 1,000 kg has 1,000^.75 × .1 × .1^−1.71 = 912 pieces of 10 cm.
    #[test]
    fn numbers_are_those_of_the_paper() {
        let collision = Collision {
            masses: [10.0, 990.0],
            speed: 10e3,
        };
        assert!(collision.is_catastrophic());
        assert!((collision.number(0.1) / 912.0 - 1.0).abs() < 1e-3);
        let crater = Collision {
            masses: [1e-3, 1000.0],
            speed: 10e3,
        };
        assert!(!crater.is_catastrophic());
        let expected = 0.1 * 0.1_f64.powf(0.75) * 0.01_f64.powf(-1.71);
        assert!((crater.number(0.01) / expected - 1.0).abs() < 1e-12);
    }
}
