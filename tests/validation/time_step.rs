//! Tables of what the factors of the time step do: see `physics_time_step`.

use crate::physics_support::steps::{
    ANY, Factors, Outcome, SMALL, SOLID, growth_of_noise, plateau, plateau_3d,
};

/// The main job at two spacings; the rows of the book's table.
#[test]
#[ignore = "slow: make validation"]
fn impacts_keep_their_outcome() {
    for spacing in ["0.04 mm", "0.025 mm"] {
        let spacing = format!("spacing=\"{spacing}\"");
        let run = |factors: Factors| Outcome::of("quarter-impact", &[&spacing], factors);
        let exact = run(SOLID.courant(SMALL));
        for courant in [0.4, 0.5, 0.65, 0.7, 0.8, 1.0] {
            let (off, what) = run(SOLID.courant(courant)).differs(&exact);
            println!("  {what} off by {:.2} %", 1e2 * off);
        }
        for factors in [ANY, SOLID] {
            let outcome = run(factors);
            let (off, what) = outcome.differs(&exact);
            println!("  {what} off by {:.2} %", 1e2 * off);
            println!("  contact limits {} steps", outcome.contact_limited);
            assert!(outcome.energy_error <= 0.005 && off <= 0.005, "{what}");
            // Two of 200 at .025 mm with the factors of other matter: a hundredth.
            assert!(
                50 * outcome.contact_limited <= outcome.steps,
                "contact limited the step"
            );
        }
    }
}

/// Largest factor up to which the noise behind a shock is that of a small one; prints all.
fn largest_quiet(name: &str, factors: &[f64], noise: impl Fn(Factors) -> (f64, f64)) -> f64 {
    let (_, quiet) = noise(Factors::sound(SMALL));
    println!("{name}, {SMALL}: noise {quiet:.5}");
    let mut largest = SMALL;
    let mut failed = false;
    for &courant in factors {
        let (pressure, noise) = noise(Factors::sound(courant));
        println!("{name}, {courant}: {pressure:.4e} Pa, noise {noise:.5}");
        failed |= noise.is_nan() || noise > 1.5 * quiet;
        if !failed {
            largest = courant;
        }
    }
    println!("{name}: {largest}");
    largest
}

/// The sound criterion alone. What fails, fails by the viscosity: it sees velocities extrapolated
/// by half a step, and the criterion counts its quadratic part lightly.
#[test]
#[ignore = "slow: make validation"]
fn noise_behind_shocks_by_factor() {
    let factors = [
        0.4, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 1.0, 1.1, 1.2,
    ];
    for speed in [0.5, 2.0, 4.0, 7.0] {
        let name = format!("{speed} km/s");
        let largest = largest_quiet(&name, &factors, |f| plateau(speed, &[], f));
        assert!(largest >= 1.25 * ANY.courant);
    }
    for beta in [1.0, 4.0] {
        let beta = format!("sph.beta={beta:.1}");
        largest_quiet(&beta, &factors, |f| plateau(7.0, &[&beta], f));
    }
    let factors = [0.4, 0.6, 0.8, 1.0, 1.2];
    let largest = largest_quiet("three dimensions", &factors, plateau_3d);
    assert!(largest >= 1.25 * SOLID.courant);
}

/// Growth of random velocities on a bar, by viscosity and factor.
#[test]
#[ignore = "slow: make validation"]
fn short_waves_by_factor() {
    for alpha in [0.0, 0.1, 0.3, 1.0, 2.0] {
        for courant in [0.2, 0.4, 0.6, 0.8, 0.9, 1.0, 1.2, 1.4] {
            let growth = growth_of_noise(1.3, alpha, courant);
            println!("alpha {alpha}, {courant}: {growth:.1e}");
            assert!(alpha < 0.3 || courant > 0.8 || growth < 0.2);
        }
    }
}
