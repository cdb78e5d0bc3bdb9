//! The stuffed Whipple shield: Nextel and Kevlar (or their like) between bumper and wall.
//!
//! E. L. Christiansen & J. H. Kerr, Int. J. Impact Engng 26 (2001) 93–104; NASA/TM-2009-214785, chapter 4.

use super::handbook::{Flight, Sizes, root};
use super::regime::{Limit, limit};
use super::shield::{Shield, Shot};

/// The data that it was fitted to.
pub const HOLDS: &str = "aluminium bumper and wall, Nextel and Kevlar half way between them; angles \
    beyond 65° count as 65°";
/// Part of the shield's areal mass below which stuffing is thin.
const THIN: f64 = 0.15;

/// The largest sphere that the shield stops.
#[must_use]
pub fn critical_diameter(shield: &Shield, shot: &Shot) -> Limit {
    let (sizes, flight) = (Sizes::of(shield), Flight::of(shot));
    let speeds = [
        2.6 / root(flight.cosine, 1.0, 2.0),
        6.5 / root(flight.cosine, 3.0, 4.0),
    ];
    limit(
        flight,
        speeds,
        |flight| ballistic(&sizes, flight),
        |flight| hypervelocity(&sizes, flight),
    )
}

/// `d = 2.35 V^(−2/3) cos^(−4/3)θ ρ_p^(−½) [t_w (σ/40)^½ + .37 (t_b ρ_b + stuffing)]` (cm).
fn ballistic(sizes: &Sizes, flight: Flight) -> f64 {
    let front = sizes.bumper * sizes.bumper_density + sizes.stuffing;
    let strong = sizes.wall * root(sizes.yield_strength / 40.0, 1.0, 2.0) + 0.37 * front;
    let blow = root(flight.speed, 2.0, 3.0)
        * root(flight.cosine, 4.0, 3.0)
        * root(flight.density, 1.0, 2.0);
    2.35 * strong / blow
}

/// `d = k (t_w ρ_w)^(1/3) ρ_p^(−1/3) V^(−1/3) cos^(−½)θ S^(2/3) (σ/40)^(1/6)` (cm); k .6, of thin stuffing .45.
fn hypervelocity(sizes: &Sizes, flight: Flight) -> f64 {
    let wall = sizes.wall * sizes.wall_density;
    let all = wall + sizes.bumper * sizes.bumper_density + sizes.stuffing;
    let k = if sizes.stuffing > THIN * all {
        0.6
    } else {
        0.45
    };
    let strong = root(wall, 1.0, 3.0)
        * root(sizes.gap, 2.0, 3.0)
        * root(sizes.yield_strength / 40.0, 1.0, 6.0);
    let blow = root(flight.density * flight.speed, 1.0, 3.0) * root(flight.cosine, 1.0, 2.0);
    k * strong / blow
}

#[cfg(test)]
mod tests {
    use super::super::handbook::KSI;
    use super::*;

    /// A shield as of the International Space Station: .2 cm of aluminium, .8 g/cm² of stuffing, 11.4 cm,
    /// .48 cm of aluminium of 52 ksi, worked out by hand.
    #[test]
    fn both_ends_are_as_worked_out_by_hand() {
        let sizes = Sizes::of(&Shield {
            bumper: 2e-3,
            wall: 4.8e-3,
            gap: 0.114,
            yield_strength: 52.0 * KSI,
            bumper_density: 2700.0,
            wall_density: 2850.0,
            stuffing: 8.0,
        });
        let flight = Flight {
            speed: 2.0,
            cosine: 1.0,
            density: 2.8,
        };
        // 2.35 (.48 × 1.140 18 + .37 × 1.34)/(2^(2/3) √2.8).
        let expected = 2.35 * (0.547_28 + 0.495_8) / (1.587_40 * 1.673_32);
        assert!((ballistic(&sizes, flight) - expected).abs() < 1e-4);
        // .6 (1.368)^(1/3) 11.4^(2/3) 1.3^(1/6) / (19.6)^(1/3).
        let expected = 0.6 * 1.110_1 * 5.065_2 * 1.044_7 / 2.696_2;
        let computed = hypervelocity(&sizes, flight.at(7.0));
        assert!((computed - expected).abs() < 5e-4, "{computed} {expected}");
        let thin = Sizes {
            stuffing: 0.2,
            ..sizes
        };
        let part = hypervelocity(&thin, flight.at(7.0)) / computed;
        assert!((part - 0.75).abs() < 1e-12);
    }
}
