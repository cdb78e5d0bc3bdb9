//! Diameters of the hole that a sphere makes in a thin plate: three published fits.
//!
//! C. J. Maiden & A. R. McMillan (AIAA J. 2 (1964) 1992–1998); R. D. Sawle (AIAA paper 69-378); S. A.
//! Hill, Int. J. Impact Engng 30 (2004) 303–318, whose constants are those of a public code.

use super::shield::Shot;

/// The data that they were fitted to.
pub const HOLDS: &str = "aluminium on aluminium, t/d of 0.02 to 0.5, some 4 to 8 km/s; \
    the three lie some 10 % about their mean";

/// A thin plate, and the sphere that holes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Diameter of the sphere (m).
    pub diameter: f64,
    /// Thickness of the plate (m).
    pub thickness: f64,
    /// Density of the plate ρ_t (kg/m³).
    pub density: f64,
    /// Speed of sound in the plate c_t (m/s).
    pub sound_speed: f64,
    /// Speed of sound in the sphere c_p (m/s).
    pub projectile_sound_speed: f64,
}

impl Pair {
    fn share(&self) -> f64 {
        self.thickness / self.diameter
    }
}

/// Maiden & McMillan: `D/d = 2.4 (V/c) (t/d)^(2/3) + .9` (m).
#[must_use]
pub fn maiden_mcmillan(pair: &Pair, shot: &Shot) -> f64 {
    let mach = shot.speed / pair.sound_speed;
    pair.diameter * (2.4 * mach * libm::pow(pair.share(), 2.0 / 3.0) + 0.9)
}

/// Sawle: `D/d = 3.2 [(ρ_p/ρ_t) (V/c)]^.22 (t/d)^(2/3) + 1` (m).
#[must_use]
pub fn sawle(pair: &Pair, shot: &Shot) -> f64 {
    let heavy = shot.density / pair.density * shot.speed / pair.sound_speed;
    let opened = 3.2 * libm::pow(heavy, 0.22) * libm::pow(pair.share(), 2.0 / 3.0);
    pair.diameter * (opened + 1.0)
}

/// Hill: `D/d = 2.8 (ρ_p/ρ_t)^(−.035) (V/c_t)^.335 (V/c_p)^.113 (t/d)^.516 cos^.026 θ + .6` (m).
#[must_use]
pub fn hill(pair: &Pair, shot: &Shot) -> f64 {
    let opened = 2.8
        * libm::pow(shot.density / pair.density, -0.035)
        * libm::pow(shot.speed / pair.sound_speed, 0.335)
        * libm::pow(shot.speed / pair.projectile_sound_speed, 0.113)
        * libm::pow(pair.share(), 0.516)
        * libm::pow(libm::cos(shot.angle), 0.026);
    pair.diameter * (opened + 0.6)
}

/// The three, in this order, and their mean (m).
#[must_use]
pub fn all(pair: &Pair, shot: &Shot) -> [f64; 4] {
    let [a, b, c] = [maiden_mcmillan, sawle, hill].map(|fit| fit(pair, shot));
    [a, b, c, (a + b + c) / 3.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Aluminium on aluminium at 6.7 km/s: values computed apart from this code to two decimals.
    #[test]
    fn three_fits_at_6_7_kilometres_a_second() {
        let shot = Shot {
            speed: 6.7e3,
            angle: 0.0,
            density: 2700.0,
        };
        let table = [
            (0.026, [1.16, 1.30, 1.07]),
            (0.049, [1.30, 1.45, 1.25]),
            (0.084, [1.48, 1.65, 1.46]),
            (0.163, [1.80, 2.00, 1.82]),
            (0.233, [2.04, 2.27, 2.06]),
            (0.424, [2.60, 2.90, 2.59]),
        ];
        for (share, expected) in table {
            let pair = Pair {
                diameter: 0.01,
                thickness: 0.01 * share,
                density: 2700.0,
                sound_speed: 5330.0,
                projectile_sound_speed: 5330.0,
            };
            let computed = all(&pair, &shot).map(|hole| hole / 0.01);
            for (computed, expected) in computed.iter().zip(expected) {
                assert!(
                    (computed - expected).abs() < 0.006,
                    "{share}: {computed} {expected}"
                );
            }
            let mean = expected.iter().sum::<f64>() / 3.0;
            assert!((computed[3] - mean).abs() < 0.01);
        }
    }
}
