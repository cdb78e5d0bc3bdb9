//! The quarter model of the main job against the whole one, at the start of the impact.

use std::collections::BTreeMap;

use crate::physics_support::{ready, run_to, start};
use engine::step::Simulation;
use model::Vec3;

/// Positions by identity, which a particle of the quarter shares with its twin in the whole model.
fn positions(s: &Simulation) -> BTreeMap<u64, Vec3> {
    let place = |i: usize| (s.particles.id[i], Vec3::from(s.particles.position[i]));
    (0..s.particles.owned()).map(place).collect()
}

/// Mirror images must be worth as much as particles: 1e-9 Δp leaves room for the different order
/// of the sums and for nothing else.
#[test]
fn a_quarter_follows_the_whole_model() {
    let mut quarter = start(ready("quarter-impact", &["spacing=\"0.05 mm\""]));
    let mut whole = start(ready(
        "quarter-impact",
        &["spacing=\"0.05 mm\"", "symmetry=[]"],
    ));
    assert_eq!(4 * quarter.particles.owned(), whole.particles.owned());
    let first = positions(&quarter);
    run_to(&mut quarter, 0.01e-6);
    run_to(&mut whole, 0.01e-6);
    assert_eq!(quarter.state.step, whole.state.step);

    let spacing = quarter.case.bodies[0].lattice.spacing;
    let twins = positions(&whole);
    let (mut apart, mut moved) = (0.0_f64, 0.0_f64);
    for (id, x) in positions(&quarter) {
        apart = apart.max((x - twins[&id]).norm() / spacing);
        moved = moved.max((x - first[&id]).norm() / spacing);
    }
    println!(
        "{} particles, {} steps, moved {moved:.2} dp, apart {apart:.1e} dp",
        first.len(),
        quarter.state.step
    );
    assert!(moved > 0.5 && apart < 1e-9, "{apart} spacings apart");

    // The first contact is the stiffest of the run.
    assert_eq!(whole.state.worst.contact_limited_steps, 0);
    assert_eq!(whole.state.worst.interpenetrated, 0);

    let (quarter, whole) = (&quarter.state.totals, &whole.state.totals);
    let energy = 4.0 * quarter.kinetic_energy / whole.kinetic_energy - 1.0;
    let momentum = 4.0 * quarter.momentum[2] / whole.momentum[2] - 1.0;
    assert!(energy.abs().max(momentum.abs()) < 1e-9);
}
