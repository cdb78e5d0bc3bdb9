//! What a cloud costs that has spread far beyond the body it comes from.

use std::time::Instant;

use crate::common::outcome::{advance, start};
use crate::common::{body, case};
use engine::step::Simulation;
use model::{Shape, Vec3};

/// Spacings across the body.
const ACROSS: f64 = 100.0;

/// Seconds that the quickest of some steps takes.
fn seconds_a_step(simulation: &mut Simulation) -> f64 {
    advance(simulation, 1);
    let steps = (0..3).map(|_| {
        let begin = Instant::now();
        advance(simulation, 1);
        begin.elapsed().as_secs_f64()
    });
    steps.fold(f64::INFINITY, f64::min)
}

#[test]
#[ignore = "slow: a million particles"]
fn a_cloud_over_a_hundred_body_sizes_costs_what_the_body_does() {
    let half = Vec3::repeat(0.5 * ACROSS * 1e-4);
    let cube = Shape::Box {
        lower: -half,
        upper: half,
    };
    let mut simulation = start(case(3, vec![body("cube", cube, 1e-4, Vec3::zeros())], 1.0));
    // The sums of a body at rest too, as a cloud in flight has them.
    simulation.search.lists.spare_quiescent = false;
    let count = simulation.particles.owned();
    let compact = seconds_a_step(&mut simulation);
    for factor in [2.0, 10.0, 50.0, 100.0] {
        // Lattices of other spacings, which meet nobody.
        let widest = simulation.particles.position[..count]
            .iter()
            .fold(0.0, |most: f64, x| most.max(x[0]));
        let spread = factor * half[0] / widest;
        for x in &mut simulation.particles.position[..count] {
            *x = x.map(|x| spread * x);
        }
        let spread = seconds_a_step(&mut simulation);
        println!(
            "{count} particles over {factor} body sizes: {:.3} of {compact:.3} s, {:.2}",
            spread,
            spread / compact
        );
        assert!(spread <= 1.2 * compact, "{factor}: {spread} for {compact}");
    }
}
