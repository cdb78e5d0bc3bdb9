//! The work that many ranks share, on virtual ranks.

mod common;
mod physics_support;

use common::virtual_ranks::on_virtual_ranks;
use physics_support::ready;
use whipple::comm::{Comm, Machine};
use whipple::step::Simulation;

/// The quarter of the main job with this spacing on virtual ranks, with a look at each step.
fn run<T: Send>(
    ranks: usize,
    machine: Machine,
    (spacing, steps): (&str, usize),
    look: impl Fn(&Comm, &Simulation) -> T + Sync,
) -> Vec<Vec<T>> {
    let overrides = [
        &format!("spacing={spacing}") as &str,
        "domain.balance_every=4",
    ];
    on_virtual_ranks(ranks, machine, |comm| {
        let case = ready("quarter-impact", &overrides);
        let mut simulation = Simulation::start(case, comm).unwrap();
        let step = |_| {
            simulation.advance(comm).unwrap();
            look(comm, &simulation)
        };
        (0..steps).map(step).collect()
    })
}

/// Largest over mean.
#[allow(clippy::cast_precision_loss, reason = "a ratio")]
fn imbalance(shares: &[u64]) -> f64 {
    let most = shares.iter().max().unwrap();
    *most as f64 * shares.len() as f64 / shares.iter().sum::<u64>() as f64
}

/// No clock has a say here: all ranks are to have the same counted work.
#[test]
#[ignore = "slow: 2.7 million particles"]
fn ranks_of_ten_thousand_particles_have_the_same_work() {
    let counts = run(256, Machine::IDEAL, ("0.0052mm", 14), |_, simulation| {
        let counted = simulation
            .particles
            .work
            .iter()
            .map(|&work| u64::from(work));
        [counted.sum(), simulation.particles.owned() as u64]
    });
    let of = |step: usize, what: usize| -> Vec<u64> {
        counts.iter().map(|steps| steps[step][what]).collect()
    };
    for step in 0..counts[0].len() {
        let [work, particles] = [0, 1].map(|what| of(step, what));
        println!(
            "step {}: {} particles, work of the busiest rank {:.3} of the mean, particles {:.3}",
            step + 1,
            particles.iter().sum::<u64>(),
            imbalance(&work),
            imbalance(&particles)
        );
    }
    // Work is counted for the first time in the first step, and balanced at the fourth.
    for step in 4..counts[0].len() {
        let busiest = imbalance(&of(step, 0));
        assert!(busiest <= 1.10, "step {}: {busiest}", step + 1);
    }
}
