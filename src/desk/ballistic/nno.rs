//! Christiansen's new non-optimum equation of the Whipple shield.
//!
//! E. L. Christiansen, Int. J. Impact Engng 14 (1993) 145–156; Handbook for Designing MMOD Protection,
//! NASA/TM-2009-214785, eqs. 4-23 to 4-26. Aluminium on aluminium; made for walls with spall counted as failure.

use super::handbook::{Flight, Sizes, root};
use super::regime::{Limit, limit};
use super::shield::{Shield, Shot};

/// The data that it was fitted to.
pub const HOLDS: &str = "aluminium on aluminium, t_b/d at least some 0.2; failure is perforation or \
    detached spall; angles beyond 65° count as 65°";
/// Normal speeds between which projectiles shatter (km/s).
const NORMAL_SPEEDS: [f64; 2] = [3.0, 7.0];

/// The largest sphere that the shield stops.
#[must_use]
pub fn critical_diameter(shield: &Shield, shot: &Shot) -> Limit {
    let (sizes, flight) = (Sizes::of(shield), Flight::of(shot));
    limit(
        flight,
        NORMAL_SPEEDS.map(|speed| speed / flight.cosine),
        |flight| ballistic(&sizes, flight),
        |flight| hypervelocity(&sizes, flight),
    )
}

/// `d = {[t_w (σ/40)^½ + t_b] / [.6 cos^(5/3)θ ρ_p^½ V^(2/3)]}^(18/19)` (cm), eq. 4-23.
pub(super) fn ballistic(sizes: &Sizes, flight: Flight) -> f64 {
    let strong = sizes.wall * root(sizes.yield_strength / 40.0, 1.0, 2.0) + sizes.bumper;
    let blow = 0.6
        * root(flight.cosine, 5.0, 3.0)
        * root(flight.density, 1.0, 2.0)
        * root(flight.speed, 2.0, 3.0);
    root(strong / blow, 18.0, 19.0)
}

/// `d = 3.918 t_w^(2/3) S^(1/3) (σ/70)^(1/3) / [ρ_p^(1/3) ρ_b^(1/9) (V cos θ)^(2/3)]` (cm), eq. 4-25.
pub(super) fn hypervelocity(sizes: &Sizes, flight: Flight) -> f64 {
    let strong = root(sizes.wall, 2.0, 3.0)
        * root(sizes.gap, 1.0, 3.0)
        * root(sizes.yield_strength / 70.0, 1.0, 3.0);
    let blow = root(flight.density, 1.0, 3.0)
        * root(sizes.bumper_density, 1.0, 9.0)
        * root(flight.normal_speed(), 2.0, 3.0);
    3.918 * strong / blow
}

#[cfg(test)]
mod tests {
    use super::super::handbook::KSI;
    use super::*;

    /// Values computed apart from this code to four digits.
    #[test]
    fn it_gives_the_values_of_the_reference_shield() {
        let shield = Shield {
            bumper: 1.2e-3,
            wall: 3.2e-3,
            gap: 0.1,
            yield_strength: 40.0 * KSI,
            bumper_density: 2700.0,
            wall_density: 2700.0,
            stuffing: 0.0,
        };
        let speeds = [1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0];
        for (angle, expected) in [
            (
                0.0_f64,
                [0.4577, 0.2954, 0.2287, 0.3988, 0.5690, 0.4486, 0.3423],
            ),
            (
                45.0,
                [0.7911, 0.5106, 0.3953, 0.3512, 0.4401, 0.5652, 0.4313],
            ),
        ] {
            for (speed, expected) in speeds.into_iter().zip(expected) {
                let shot = Shot {
                    speed: speed * 1e3,
                    angle: angle.to_radians(),
                    density: 2800.0,
                };
                let computed = critical_diameter(&shield, &shot).diameter * 100.0;
                let what = format!("{speed} km/s, {angle}°: {computed}");
                assert!((computed - expected).abs() < 0.6e-4, "{what}");
            }
        }
    }

    #[test]
    fn angles_beyond_65_degrees_count_as_65() {
        let shield = Shield {
            bumper: 1e-3,
            wall: 2e-3,
            gap: 0.1,
            yield_strength: 3e8,
            bumper_density: 2700.0,
            wall_density: 2700.0,
            stuffing: 0.0,
        };
        let at = |angle: f64| {
            let shot = Shot {
                speed: 9e3,
                angle: angle.to_radians(),
                density: 2800.0,
            };
            critical_diameter(&shield, &shot)
        };
        assert_eq!(at(65.0), at(80.0));
    }
}
