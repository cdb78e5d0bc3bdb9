//! The work that many ranks share, on virtual ranks.

use crate::common::virtual_ranks::on_virtual_ranks;
use crate::physics_support::ready;
use comm::Machine;
use engine::step::Simulation;

/// The quarter of the main job with this spacing on virtual ranks: in each step the counted work and the
/// number of particles of each rank.
fn run(ranks: usize, spacing: &str, steps: usize) -> Vec<Vec<[u64; 2]>> {
    let overrides = [&format!("spacing={spacing}") as &str];
    on_virtual_ranks(ranks, Machine::IDEAL, |comm| {
        let case = ready("quarter-impact", &overrides);
        let mut simulation = Simulation::start(case, comm).unwrap();
        let step = |_| {
            simulation.advance(comm).unwrap();
            let work = simulation.particles.work.iter();
            let counted = work.map(|&work| u64::from(work)).sum();
            [counted, simulation.particles.owned() as u64]
        };
        (0..steps).map(step).collect()
    })
}

/// Largest over mean.
#[allow(clippy::cast_precision_loss, reason = "a ratio")]
fn imbalance(shares: impl Iterator<Item = u64>) -> f64 {
    let shares: Vec<u64> = shares.collect();
    let most = shares.iter().max().unwrap();
    *most as f64 * shares.len() as f64 / shares.iter().sum::<u64>() as f64
}

/// The time that all steps but the first take if work is time, over what they would with even work.
#[allow(clippy::cast_precision_loss, reason = "a ratio")]
fn lost(counts: &[Vec<[u64; 2]>]) -> f64 {
    let steps = counts[0].len();
    let mut lost = 0.0;
    for step in 0..steps {
        let [work, particles] =
            [0, 1].map(|what| imbalance(counts.iter().map(|rank| rank[step][what])));
        println!(
            "step {}: work of the busiest rank {work:.3} of the mean, particles {particles:.3}",
            step + 1
        );
        // Work is counted for the first time in the first step.
        if step > 0 {
            lost += work;
        }
    }
    let mean = lost / (steps - 1) as f64;
    println!("mean {mean:.3}");
    mean
}

/// No clock has a say here: all ranks are to have the same counted work.
#[test]
#[ignore = "slow: 155 thousand particles"]
fn sixteen_ranks_of_ten_thousand_particles_share_the_work() {
    let mean = lost(&run(16, "0.0135mm", 300));
    assert!(mean <= 1.05, "{mean}");
}

/// A cut does not go through a layer of the lattice, and 10⁴ particles are 21 layers: a layer is 5 % of
/// their work, and each of three levels cuts between two. As the shock sets out, a rank's work grows by as
/// much again in each step.
#[test]
#[ignore = "slow: 2.7 million particles"]
fn ranks_of_ten_thousand_particles_have_the_same_work() {
    let mean = lost(&run(256, "0.0052mm", 40));
    assert!(mean <= 1.20, "{mean}");
}
