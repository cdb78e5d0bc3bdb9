//! The modified new non-optimum equation of the Whipple shield.
//!
//! E. L. Christiansen & J. H. Kerr, Int. J. Impact Engng 26 (2001) 93–104.

use super::handbook::{Flight, Sizes, root};
use super::regime::{Limit, limit};
use super::shield::{Shield, Shot};

/// The data that it was fitted to.
pub const HOLDS: &str = "aluminium on aluminium; failure is perforation or detached spall; angles \
    beyond 65° count as 65°";
/// `t_b / (t_w^(2/3) S^(1/3))` from which a thicker bumper helps.
const THICK: f64 = 0.126;

/// The largest sphere that the shield stops.
#[must_use]
pub fn critical_diameter(shield: &Shield, shot: &Shot) -> Limit {
    let (sizes, flight) = (Sizes::of(shield), Flight::of(shot));
    let speeds = [3.0 / root(flight.cosine, 3.0, 2.0), 7.0 / flight.cosine];
    limit(
        flight,
        speeds,
        |flight| ballistic(&sizes, flight),
        |flight| hypervelocity(&sizes, flight),
    )
}

/// `d = 1.9 [t_w (σ/40)^½ + .37 t_b ρ_b] / [cos^(11/6)θ ρ_p^½ V^(2/3)]` (cm).
fn ballistic(sizes: &Sizes, flight: Flight) -> f64 {
    let strong = sizes.wall * root(sizes.yield_strength / 40.0, 1.0, 2.0)
        + 0.37 * sizes.bumper * sizes.bumper_density;
    let blow = root(flight.cosine, 11.0, 6.0)
        * root(flight.density, 1.0, 2.0)
        * root(flight.speed, 2.0, 3.0);
    1.9 * strong / blow
}

/// `d = k (t_w ρ_w)^(2/3) S^½ (σ/70)^(1/3) / [ρ_p^(1/3) ρ_b^(1/9) (V cos θ)^(2/3)]` (cm).
fn hypervelocity(sizes: &Sizes, flight: Flight) -> f64 {
    let strong = root(sizes.wall * sizes.wall_density, 2.0, 3.0)
        * root(sizes.gap, 1.0, 2.0)
        * root(sizes.yield_strength / 70.0, 1.0, 3.0);
    let blow = root(flight.density, 1.0, 3.0)
        * root(sizes.bumper_density, 1.0, 9.0)
        * root(flight.normal_speed(), 2.0, 3.0);
    coefficient(sizes) * strong / blow
}

/// k: 1.35, and `7.451 x + .411` from `x = t_b / (t_w^(2/3) S^(1/3)) = .126` on, where both agree.
fn coefficient(sizes: &Sizes) -> f64 {
    let x = sizes.bumper / (root(sizes.wall, 2.0, 3.0) * root(sizes.gap, 1.0, 3.0));
    if x < THICK { 1.35 } else { 7.451 * x + 0.411 }
}

#[cfg(test)]
mod tests {
    use super::super::handbook::KSI;
    use super::*;

    fn sizes(bumper: f64) -> Sizes {
        Sizes::of(&Shield {
            bumper,
            wall: 3.2e-3,
            gap: 0.1,
            yield_strength: 40.0 * KSI,
            bumper_density: 2700.0,
            wall_density: 2700.0,
            stuffing: 0.0,
        })
    }

    /// The formulas worked out by hand: t_w .32, t_b .12, S 10 cm, σ 40 ksi, ρ 2.8 on 2.7 g/cm³.
    #[test]
    fn both_ends_are_as_worked_out_by_hand() {
        let flight = Flight {
            speed: 1.0,
            cosine: 1.0,
            density: 2.8,
        };
        // 1.9 (.32 + .37 × .12 × 2.7)/√2.8.
        assert!((ballistic(&sizes(1.2e-3), flight) - 0.499_5).abs() < 2e-4);
        // 1.35 (.864)^(2/3) √10 (4/7)^(1/3) / (2.8^(1/3) 2.7^(1/9) 7^(2/3)).
        let expected = 1.35 * 0.907_12 * 3.162_28 * 0.829_83 / (1.409_46 * 1.116_69 * 3.659_31);
        let computed = hypervelocity(&sizes(1.2e-3), flight.at(7.0));
        assert!((computed - expected).abs() < 1e-4, "{computed} {expected}");
    }

    #[test]
    fn the_coefficient_has_no_jump() {
        let at = THICK * root(0.32, 2.0, 3.0) * root(10.0, 1.0, 3.0) * 1e-2;
        let [below, above] = [0.9999, 1.0001].map(|part| coefficient(&sizes(at * part)));
        assert!((above - below).abs() < 2e-3, "{below} {above}");
    }
}
