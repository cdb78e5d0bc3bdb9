//! The new non-optimum equation for bumpers that are too thin to break a projectile up: NASA's JSC
//! Whipple shield equation.
//!
//! H.-G. Reimerdes, D. Nölke & F. Schäfer, Int. J. Impact Engng 33 (2006) 645–654; S. Ryan & E. L.
//! Christiansen, NASA/TM-2009-214789 and Acta Astronautica 69 (2011) 245–257. The speed from which
//! projectiles shatter is A. J. Piekutowski's.

use super::handbook::{Flight, Sizes, root};
use super::regime::{Limit, limit};
use super::shield::{Shield, Shot};
use super::{nno, sizing};

/// The data that it was fitted to.
pub const HOLDS: &str = "aluminium on aluminium; failure is perforation or detached spall; angles \
    beyond 65° count as 65°";
/// Normal speed from which the cloud is molten (km/s).
const HYPERVELOCITY: f64 = 7.0;
/// Thickness of the bumper over diameter from which projectiles shatter at [`ONSET`].
const THICK: f64 = 0.16;
/// Slowest normal speed at which a projectile shatters (km/s).
const ONSET: f64 = 2.6;
/// Halvings of a bracket: more than a double can resolve.
const BISECTIONS: usize = 200;

/// The largest sphere that the shield stops.
#[must_use]
pub fn critical_diameter(shield: &Shield, shot: &Shot) -> Limit {
    let (sizes, flight) = (Sizes::of(shield), Flight::of(shot));
    limit(
        flight,
        [onset(&sizes, flight), HYPERVELOCITY].map(|speed| speed / flight.cosine),
        |flight| nno::ballistic(&sizes, flight),
        |flight| hypervelocity(&sizes, flight),
    )
}

/// Normal speed (km/s) from which the critical projectile shatters: `1.436 (t_b/d)^(−1/3)`, 2.60 if
/// `t_b/d ≥ .16`; never beyond [`HYPERVELOCITY`].
fn onset(sizes: &Sizes, flight: Flight) -> f64 {
    let share = |speed: f64| sizes.bumper / nno::ballistic(sizes, flight.at(speed / flight.cosine));
    // A faster critical projectile is smaller, so that the difference grows.
    let speed = bisect([ONSET, HYPERVELOCITY], |speed| {
        speed - 1.436 * root(share(speed), -1.0, 3.0)
    });
    if share(speed) >= THICK { ONSET } else { speed }
}

/// `d = F^(−2/3) d_NNO` (cm), which hangs on d itself.
fn hypervelocity(sizes: &Sizes, flight: Flight) -> f64 {
    let thick = nno::hypervelocity(sizes, flight);
    bisect([0.0, thick], |diameter| {
        diameter - root(derating(sizes, flight, diameter), -2.0, 3.0) * thick
    })
}

/// F: 1 for `t_b/d ≥ c_b`, else `r − 2x (r − 1) + x² (r − 1)` with `x = (t_b/d)/c_b` and r the wall without
/// a bumper over the wall behind one of c_b, both at 7 km/s; at least 1.
fn derating(sizes: &Sizes, flight: Flight, diameter: f64) -> f64 {
    let x = sizes.bumper / diameter / sizing::bumper_share(sizes.gap / diameter);
    if x >= 1.0 || diameter <= 0.0 {
        return 1.0;
    }
    let single = 0.6
        * root(diameter, 19.0, 18.0)
        * root(flight.cosine, 5.0, 3.0)
        * root(flight.density, 1.0, 2.0)
        * root(HYPERVELOCITY, 2.0, 3.0)
        / root(sizes.yield_strength / 40.0, 1.0, 2.0);
    let behind = sizing::wall(
        diameter,
        sizes.gap,
        flight.density * sizes.bumper_density,
        flight.density,
        HYPERVELOCITY * flight.cosine,
        sizes.yield_strength,
    );
    let r = (single / behind).max(1.0);
    1.0 + (r - 1.0) * (1.0 - x) * (1.0 - x)
}

/// The zero of an increasing function; an end if there is none.
fn bisect([mut low, mut high]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::super::handbook::KSI;
    use super::*;

    fn shield(bumper: f64) -> Shield {
        Shield {
            bumper,
            wall: 3.2e-3,
            gap: 0.1,
            yield_strength: 40.0 * KSI,
            bumper_density: 2700.0,
            wall_density: 2700.0,
            stuffing: 0.0,
        }
    }

    fn shot(speed: f64) -> Shot {
        Shot {
            speed,
            angle: 0.0,
            density: 2800.0,
        }
    }

    #[test]
    fn a_thick_bumper_is_that_of_the_non_optimum_equation() {
        // t_b/d .35 at 7 km/s.
        let shield = shield(2e-3);
        let [computed, nno] = [critical_diameter, nno::critical_diameter]
            .map(|limit| limit(&shield, &shot(9e3)).diameter);
        assert!((computed / nno - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_thin_bumper_stops_less_down_to_none_at_all() {
        let at = |bumper: f64| critical_diameter(&shield(bumper), &shot(8e3)).diameter;
        let [none, thin, thick] = [1e-9, 0.4e-3, 2e-3].map(at);
        assert!(none < thin && thin < thick, "{none} {thin} {thick}");
        // The diameter solves its own equation.
        let (sizes, flight) = (Sizes::of(&shield(0.4e-3)), Flight::of(&shot(8e3)));
        let again = nno::hypervelocity(&sizes, flight)
            * root(derating(&sizes, flight, thin * 100.0), -2.0, 3.0);
        assert!((again / (thin * 100.0) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn shattering_begins_where_the_critical_projectile_says() {
        let flight = Flight::of(&shot(1e3));
        // t_b/d .16 and more.
        assert!((onset(&Sizes::of(&shield(1.2e-3)), flight) - 2.6).abs() < 1e-12);
        let sizes = Sizes::of(&shield(0.2e-3));
        let speed = onset(&sizes, flight);
        let share = sizes.bumper / nno::ballistic(&sizes, flight.at(speed));
        assert!((speed - 1.436 * root(share, -1.0, 3.0)).abs() < 1e-9);
        assert!(speed > 2.65 && speed < 7.0, "{speed}");
    }
}
