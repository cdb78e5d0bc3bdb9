//! The Riemann problem and Noh's implosion against published values and the jump conditions.

use crate::exact::noh::Noh;
use exact::riemann::{Gas, Riemann};

fn gas(density: f64, velocity: f64, pressure: f64) -> Gas {
    Gas {
        density,
        velocity,
        pressure,
    }
}

#[test]
fn star_states_of_toros_tests() {
    // Toro (2009), tables 4.1 and 4.2 with densities of table 4.3: p*, u*, ρ*L, ρ*R. Test 1 is
    // Sod's problem; test 2's near-vacuum, 3 and 4 the two blast waves, 5 their collision.
    let table = [
        (
            [gas(1.0, 0.0, 1.0), gas(0.125, 0.0, 0.1)],
            [0.30313, 0.92745, 0.42632, 0.26557],
        ),
        (
            [gas(1.0, -2.0, 0.4), gas(1.0, 2.0, 0.4)],
            [0.00189, 0.0, 0.02185, 0.02185],
        ),
        (
            [gas(1.0, 0.0, 1000.0), gas(1.0, 0.0, 0.01)],
            [460.894, 19.5975, 0.57506, 5.99924],
        ),
        (
            [gas(1.0, 0.0, 0.01), gas(1.0, 0.0, 100.0)],
            [46.0950, -6.19633, 5.99242, 0.57511],
        ),
        (
            [
                gas(5.99924, 19.5975, 460.894),
                gas(5.99242, -6.19633, 46.0950),
            ],
            [1691.64, 8.68975, 14.2823, 31.0426],
        ),
    ];
    for (sides, [p, u, left, right]) in table {
        let found = Riemann::new(1.4, sides[0], sides[1]).unwrap();
        let close = |value: f64, printed: f64| {
            // Five or six digits as printed.
            (value - printed).abs() <= 1e-5 * printed.abs().max(1.0)
        };
        assert!(close(found.star_pressure, p), "{} {p}", found.star_pressure);
        assert!(close(found.star_velocity, u), "{} {u}", found.star_velocity);
        assert!(
            close(found.star_densities[0], left),
            "{:?}",
            found.star_densities
        );
        assert!(
            close(found.star_densities[1], right),
            "{:?}",
            found.star_densities
        );
    }
}

#[test]
fn sod_has_its_waves_and_a_profile() {
    let sod = Riemann::new(1.4, gas(1.0, 0.0, 1.0), gas(0.125, 0.0, 0.1)).unwrap();
    // Head and tail of the rarefaction and the shock at t = 0.25 about x = 0.5: well-known.
    let [[head, tail], [shock, same]] = sod.waves();
    assert!((head + 1.183_216).abs() < 1e-6);
    assert!((tail + 0.070_273).abs() < 1e-6);
    assert!((shock - 1.752_156).abs() < 1e-6);
    assert_eq!(shock, same);
    // Inside the fan u − c = x/t and the entropy is that of the left side.
    for speed in [-1.1, -0.7, -0.1] {
        let at = sod.at(speed);
        let c = (1.4 * at.pressure / at.density).sqrt();
        assert!((at.velocity - c - speed).abs() < 1e-12);
        assert!((at.pressure / at.density.powf(1.4) - 1.0).abs() < 1e-12);
    }
    let profile = sod.profile(0.5, 0.25, [0.0, 1.0]);
    assert!(profile.is_sorted_by(|a, b| a.position <= b.position));
    assert_eq!(
        (profile[0].density, profile[profile.len() - 1].density),
        (1.0, 0.125)
    );
    // Mass, and momentum given by the difference of the pressures at the ends, by trapezia.
    let integral = |f: &dyn Fn(&exact::Sample) -> f64| -> f64 {
        let pairs = profile.windows(2);
        pairs
            .map(|p| 0.5 * (f(&p[0]) + f(&p[1])) * (p[1].position - p[0].position))
            .sum()
    };
    assert!((integral(&|s| s.density) - 0.5625).abs() < 1e-5);
    assert!((integral(&|s| s.density * s.velocity) - 0.9 * 0.25).abs() < 1e-5);
    let start = sod.profile(0.5, 0.0, [0.0, 1.0]);
    assert_eq!(
        start.iter().map(|s| s.density).collect::<Vec<_>>(),
        [1.0, 1.0, 0.125, 0.125]
    );
}

#[test]
fn mirrored_problems_have_mirrored_solutions() {
    let (a, b) = (
        gas(5.99924, 19.5975, 460.894),
        gas(5.99242, -6.19633, 46.0950),
    );
    let one = Riemann::new(1.4, a, b).unwrap();
    let flip = |g: Gas| gas(g.density, -g.velocity, g.pressure);
    let other = Riemann::new(1.4, flip(b), flip(a)).unwrap();
    assert!((one.star_pressure / other.star_pressure - 1.0).abs() < 1e-12);
    for speed in [-30.0, -5.0, 3.0, 8.0, 9.0, 12.0, 40.0] {
        assert!((one.at(speed).density / other.at(-speed).density - 1.0).abs() < 1e-12);
    }
}

#[test]
fn gases_that_part_too_fast_leave_a_vacuum() {
    // 2 (c_l + c_r)/(γ − 1) = 2 · 2 √1.4/0.4 = 11.83.
    let at = |v: f64| Riemann::new(1.4, gas(1.0, -v, 1.0), gas(1.0, v, 1.0));
    assert!(at(5.9).is_some());
    assert!(at(5.92).is_none());
}

#[test]
fn the_plane_implosion_is_a_riemann_problem() {
    let gamma = 5.0 / 3.0;
    let noh = Noh {
        dimension: 1,
        gamma,
        density: 2.0,
        speed: 3.0,
    };
    let cold = |v: f64| gas(2.0, v, 0.0);
    let found = Riemann::new(gamma, cold(3.0), cold(-3.0)).unwrap();
    let inside = noh.at(0.1, 1.0);
    assert!((found.star_pressure / inside.pressure - 1.0).abs() < 1e-12);
    assert!((found.star_densities[0] / inside.density - 1.0).abs() < 1e-12);
    assert!((found.waves()[1][0] / noh.shock_speed() - 1.0).abs() < 1e-12);
}

#[test]
fn implosions_keep_their_mass_and_known_values() {
    // γ = 5/3, |v| = 1: the shock runs at 1/3; densities 4, 16, 64 behind it.
    for (dimension, behind) in [(1, 4.0), (2, 16.0), (3, 64.0)] {
        let noh = Noh {
            dimension,
            gamma: 5.0 / 3.0,
            density: 1.0,
            speed: 1.0,
        };
        assert!((noh.shock_speed() - 1.0 / 3.0).abs() < 1e-15);
        assert!((noh.at(0.1, 0.6).density / behind - 1.0).abs() < 1e-12);
        assert!((noh.at(0.1, 0.6).pressure / (behind / 3.0) - 1.0).abs() < 1e-12);
        // What is now within r was within r + t: exact, but for the trapezia ahead of the shock.
        let profile = noh.profile(0.6, 0.5);
        let power = i32::from(dimension);
        let volume = |r: f64| r.powi(power);
        let mass: f64 = profile
            .windows(2)
            .map(|p| {
                0.5 * (p[0].density + p[1].density)
                    * (volume(p[1].position) - volume(p[0].position))
            })
            .sum();
        assert!((mass / volume(1.1) - 1.0).abs() < 1e-4, "{mass}");
    }
}
