//! Christiansen's sizing of a Whipple shield: the thinnest bumper and wall that stop a sphere.
//!
//! E. L. Christiansen, Int. J. Impact Engng 14 (1993) 145–156; NASA/TM-2009-214785, chapter 4.

use std::f64::consts::PI;

use super::handbook::{CM, Flight, G_CM3, KSI, root};
use super::shield::Shot;

/// The range that it was made for.
pub const HOLDS: &str = "aluminium on aluminium, V cos θ of 7 km/s or more, S/d of 15 or more";
/// Slowest normal speed that it holds for (m/s).
pub const SLOWEST: f64 = 7e3;
/// Gap over diameter from which bumpers may be thinner.
const WIDE: f64 = 30.0;

/// A shield to be sized.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Task {
    /// Diameter of the sphere d (m).
    pub diameter: f64,
    /// Distance from bumper to wall S (m).
    pub gap: f64,
    /// Yield strength of the wall σ (Pa).
    pub yield_strength: f64,
    /// Density of the bumper ρ_b (kg/m³).
    pub bumper_density: f64,
}

/// Two thicknesses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sized {
    /// Of the bumper (m).
    pub bumper: f64,
    /// Of the wall (m).
    pub wall: f64,
}

/// `t_b = c_b d ρ_p/ρ_b`; `t_w = .16 d^½ (ρ_p ρ_b)^(1/6) M^(1/3) V_n S^(−½) (70/σ)^½` (cm), M the mass (g).
#[must_use]
pub fn sized(task: &Task, shot: &Shot) -> Sized {
    let flight = Flight::of(shot);
    let (diameter, gap) = (task.diameter / CM, task.gap / CM);
    let bumper_density = task.bumper_density / G_CM3;
    let wall = wall(
        diameter,
        gap,
        flight.density * bumper_density,
        flight.density,
        flight.normal_speed(),
        task.yield_strength / KSI,
    );
    Sized {
        bumper: bumper_share(gap / diameter) * diameter * flight.density / bumper_density * CM,
        wall: wall * CM,
    }
}

/// c_b: thickness over diameter of a bumper as heavy as the projectile.
pub(super) fn bumper_share(gap_over_diameter: f64) -> f64 {
    if gap_over_diameter < WIDE { 0.25 } else { 0.2 }
}

/// t_w (cm) behind such a bumper: diameter and gap (cm), ρ_p ρ_b, ρ_p (g/cm³), V_n (km/s), σ (ksi).
pub(super) fn wall(
    diameter: f64,
    gap: f64,
    densities: f64,
    density: f64,
    normal_speed: f64,
    yield_strength: f64,
) -> f64 {
    let mass = PI / 6.0 * density * diameter * diameter * diameter;
    0.16 * root(diameter, 1.0, 2.0)
        * root(densities, 1.0, 6.0)
        * root(mass, 1.0, 3.0)
        * normal_speed
        / root(gap, 1.0, 2.0)
        * root(70.0 / yield_strength, 1.0, 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values computed apart from this code to four digits.
    #[test]
    fn a_centimetre_at_seven_kilometres_a_second() {
        let task = Task {
            diameter: 0.01,
            gap: 0.3,
            yield_strength: 40.0 * KSI,
            bumper_density: 2700.0,
        };
        let shot = Shot {
            speed: 7e3,
            angle: 0.0,
            density: 2800.0,
        };
        let Sized { bumper, wall } = sized(&task, &shot);
        assert!((bumper - 2.074e-3).abs() < 0.6e-6, "{bumper}");
        assert!((wall - 4.305e-3).abs() < 0.6e-6, "{wall}");
        let near = Task { gap: 0.29, ..task };
        assert!((sized(&near, &shot).bumper - 2.593e-3).abs() < 0.6e-6);
    }
}
