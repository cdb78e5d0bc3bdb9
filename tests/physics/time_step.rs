//! How long a time step may be: the factors of the step's criteria against what runs show.
//!
//! The rule: four fifths of the smallest factor that fails, where a factor fails when waves or
//! shocks turn noisy, the energy error passes .5 %, or an outcome moves by .5 % from that of a
//! small factor. Tables in the book's page on time integration; the slow `validation_time_step`
//! prints them.

use crate::physics_support::steps::{
    ANY, Factors, Outcome, SMALL, SOLID, growth_of_noise, plateau,
};
use crate::physics_support::{inline, ready, start};
use comm::Comm;
use engine::step::measurements;

/// Beyond the recommended factor by the margin of the rule.
const MARGIN: f64 = 1.25;

/// A change of a default that leaves what is established here needs new evidence.
#[test]
fn the_defaults_are_no_larger_than_what_is_established() {
    let case = inline(
        "dimension = 1\nspacing = \"1 cm\"\n[run]\nend_time = \"1 us\"\n\
         [material.aluminium]\nlibrary = \"aluminium-2024\"\n[[body]]\nname = \"bar\"\n\
         material = \"aluminium\"\nshape.box = { lower = [0], upper = [\"10 cm\"] }\n",
    );
    let main_job = ready("quarter-impact", &[]);
    for (options, most) in [(&case.time_step, ANY), (&main_job.time_step, SOLID)] {
        assert!(options.courant <= most.courant, "{}", options.courant);
        assert!(options.contact <= most.contact, "{}", options.contact);
        assert!(options.force <= ANY.force, "{}", options.force);
    }
}

/// The main job at a coarse spacing.
#[test]
#[ignore = "slow"]
fn the_main_job_keeps_its_outcome_at_the_largest_factors() {
    let coarse = ["spacing=\"0.04 mm\""];
    let exact = Outcome::of("quarter-impact", &coarse, ANY.courant(SMALL));
    let half = Outcome::of("quarter-impact", &coarse, ANY.courant(0.5 * ANY.courant));
    let any = Outcome::of("quarter-impact", &coarse, ANY);
    let solid = Outcome::of("quarter-impact", &coarse, SOLID);
    for outcome in [any, solid] {
        assert!(outcome.energy_error <= 0.005, "{}", outcome.energy_error);
        let (off, what) = outcome.differs(&exact);
        // Measured at the largest factors: .56 %, of the peak pressure.
        assert!(off <= 0.006, "{what} off by {off}");
        assert_eq!(outcome.interpenetrated, exact.interpenetrated);
        assert_eq!(outcome.contact_limited, 0, "contact limited the step");
    }
    // Contact's error is of second order, less the kinks where particles come into touch.
    let order = (any.energy_error / half.energy_error).log2();
    println!("order {order:.2}");
    assert!((1.2..2.5).contains(&order), "order {order}");
    assert!(2 * any.steps <= half.steps + 10 && solid.steps < any.steps);
}

/// Shocks are the first to turn noisy: the sound criterion alone, with the margin, against a
/// small factor. A quarter more, as the plateau holds few particles.
#[test]
fn shocks_stay_free_of_noise_with_a_margin() {
    for speed in [0.5, 4.0, 7.0] {
        let (pressure, noise) = plateau(speed, &[], Factors::sound(SMALL));
        let (longer, noisier) = plateau(speed, &[], Factors::sound(MARGIN * ANY.courant));
        println!(
            "{speed} km/s: {:.3} GPa, noise {noise:.5}; {:.3} GPa, noise {noisier:.5}",
            1e-9 * pressure,
            1e-9 * longer
        );
        assert!(noisier <= 1.25 * noise, "{noise} grew to {noisier}");
        assert!((longer / pressure - 1.0).abs() <= 0.001);
    }
}

/// Waves of any length die down with the margin, for little, usual and much viscosity.
#[test]
fn short_waves_die_down_with_a_margin() {
    for smoothing in [1.0, 1.3, 2.1] {
        for alpha in [0.3, 1.0, 2.0] {
            let left = growth_of_noise(smoothing, alpha, MARGIN * ANY.courant);
            println!("h = {smoothing} dp, alpha {alpha}: {left:.1e}");
            assert!(left < 0.2, "h = {smoothing} dp, alpha {alpha}: {left}");
        }
    }
}

/// An elastic impact: the energy error, the bounce.
#[test]
fn an_elastic_impact_keeps_its_bounce_at_the_largest_factors() {
    let exact = Outcome::of("elastic-impact", &[], ANY.courant(SMALL));
    for factors in [ANY, SOLID] {
        let outcome = Outcome::of("elastic-impact", &[], factors);
        assert!(outcome.energy_error <= 0.005, "{}", outcome.energy_error);
        let (off, what) = outcome.differs(&exact);
        assert!(off <= 0.005, "{what} off by {off}");
        assert_eq!(outcome.contact_limited, 0, "contact limited the step");
    }
}

/// Blocks of a liquid whose sound is much slower than they are, with and without viscosity for
/// shocks, in touch and apart: they meet, and no step makes energy.
#[test]
fn bodies_much_faster_than_sound_meet() {
    for (speed, gap, beta) in [
        (10, 0, 0.0),
        (40, 0, 0.0),
        (40, 7, 0.0),
        (40, 7, 2.0),
        (400, 7, 2.0),
    ] {
        let (lower, upper) = (10 + gap, 20 + gap);
        let case = inline(&format!(
            "dimension = 2\nspacing = \"1 mm\"\n[run]\nend_time = \"1 s\"\n\
             [sph]\nbeta = {beta:?}\n[material.water]\nlibrary = \"water\"\n\
             eos.tait.sound_speed = \"25 m/s\"\n[[body]]\nname = \"lower\"\n\
             material = \"water\"\nshape.box = {{ lower = [0, 0], upper = [\"20 mm\", \"10 mm\"] }}\n\
             [[body]]\nname = \"upper\"\nmaterial = \"water\"\n\
             shape.box = {{ lower = [\"5 mm\", \"{lower} mm\"], upper = [\"15 mm\", \"{upper} mm\"] }}\n\
             velocity = [0, \"-{} m/s\"]\n",
            25 * speed
        ));
        let mut simulation = start(case);
        let comm = Comm::solo();
        // Until the back of the upper one would have reached the face of the lower one.
        let end = f64::from(10 + gap) * 1e-3 / f64::from(25 * speed);
        while simulation.state.time < end {
            simulation.advance(&comm).unwrap();
            measurements::diagnose(&mut simulation, &comm);
        }
        let state = &simulation.state;
        let given = state.pairs[0].impulse[1].abs() / state.initial.momentum[1].abs();
        let error = state.worst.energy_error;
        let closest = state.worst.closest.unwrap_or(f64::INFINITY);
        let what = format!("{speed} c, gap {gap}, beta {beta}");
        println!("{what}: impulse {given:.3}, closest {closest:.3}, energy error {error:.4}");
        assert!(given > 0.0 && closest < 0.8, "{what}: not met");
        assert!(error < 0.05, "{what}: energy error {error}");
    }
}
