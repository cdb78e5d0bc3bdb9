//! Cour-Palais' crater in a single wall, and what the wall's rear does.
//!
//! B. G. Cour-Palais, as in NASA/TM-2009-214785, eq. 4-1 and those that follow.

use super::handbook::{CM, G_CM3, KM_S, root};
use super::shield::Shot;

/// The data that it was fitted to.
pub const HOLDS: &str = "aluminium walls, some 2 to 10 km/s";
/// Density of projectile over wall from which it counts more.
const HEAVY: f64 = 1.5;

/// A single wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// Density ρ_t (kg/m³).
    pub density: f64,
    /// Brinell hardness.
    pub hardness: f64,
    /// Speed of sound C (m/s).
    pub sound_speed: f64,
}

/// A failure of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// Spall that stays on.
    AttachedSpall,
    /// Spall that comes off.
    DetachedSpall,
    /// A hole.
    Perforation,
}

impl Failure {
    /// Thickness over the depth of the crater that is just enough.
    #[must_use]
    pub fn depths(self) -> f64 {
        match self {
            Self::AttachedSpall => 3.0,
            Self::DetachedSpall => 2.2,
            Self::Perforation => 1.8,
        }
    }
}

/// Depth (m) of the crater of a sphere of a diameter (m) in a wall without an end:
/// `P = 5.24 d^(19/18) BHN^(−¼) (ρ_p/ρ_t)^½ (V cos θ/C)^(2/3)` (cm); `(ρ_p/ρ_t)^(2/3)` from 1.5 on.
#[must_use]
pub fn depth(wall: &Wall, diameter: f64, shot: &Shot) -> f64 {
    CM * coefficient(wall, shot) * root(diameter / CM, 19.0, 18.0)
}

/// The largest sphere (m) of which a wall of a thickness (m) does not fail so.
#[must_use]
pub fn critical_diameter(wall: &Wall, thickness: f64, failure: Failure, shot: &Shot) -> f64 {
    let deepest = thickness / CM / failure.depths();
    CM * root(deepest / coefficient(wall, shot), 18.0, 19.0)
}

fn coefficient(wall: &Wall, shot: &Shot) -> f64 {
    let heavier = shot.density / G_CM3 / (wall.density / G_CM3);
    let power = if heavier < HEAVY { 0.5 } else { 2.0 / 3.0 };
    let normal = shot.speed * libm::cos(shot.angle) / KM_S;
    5.24 / root(wall.hardness, 1.0, 4.0)
        * libm::pow(heavier, power)
        * root(normal / (wall.sound_speed / KM_S), 2.0, 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: Wall = Wall {
        density: 2700.0,
        hardness: 95.0,
        sound_speed: 5100.0,
    };

    fn shot(density: f64) -> Shot {
        Shot {
            speed: 7e3,
            angle: 0.0,
            density,
        }
    }

    /// 6061-T6, a centimetre at 7 km/s: 5.24 / 95^¼ (2.8/2.7)^½ (7/5.1)^(2/3), by hand.
    #[test]
    fn a_crater_is_as_worked_out_by_hand() {
        let expected = 5.24 / 3.122_0 * 1.018_35 * 1.235_02;
        let computed = depth(&WALL, 0.01, &shot(2800.0)) * 100.0;
        assert!((computed - expected).abs() < 2e-4, "{computed} {expected}");
        let steel = depth(&WALL, 0.01, &shot(7850.0)) * 100.0;
        let ratio = root(7850.0 / 2700.0, 2.0, 3.0) / 1.018_35;
        assert!((steel / computed - ratio).abs() < 1e-4);
    }

    #[test]
    fn the_critical_diameter_makes_the_deepest_crater() {
        for failure in [
            Failure::AttachedSpall,
            Failure::DetachedSpall,
            Failure::Perforation,
        ] {
            let diameter = critical_diameter(&WALL, 0.02, failure, &shot(2800.0));
            let thickness = failure.depths() * depth(&WALL, diameter, &shot(2800.0));
            assert!((thickness - 0.02).abs() < 1e-12);
        }
    }
}
