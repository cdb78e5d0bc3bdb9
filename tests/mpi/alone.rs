//! What one thread visits while the others of its rank wait: nothing that grows with the particles of a
//! rank.

use crate::common::outcome::CASES;
use crate::ranks::on_each;
use comm::Comm;
use engine::step::Simulation;
use model::Case;
use numerics::alone::visited;

/// Steps of each case: balances, searches for parts and the order of the store come in them.
const STEPS: u64 = 22;

/// Visits by one thread over particles times steps, of all ranks.
#[allow(clippy::cast_precision_loss, reason = "a share")]
fn share(case: Case, comm: &Comm) -> f64 {
    let mut simulation = Simulation::start(case, comm).expect("it starts");
    let (before, updates) = (visited(), simulation.timers.updates);
    for _ in 0..STEPS {
        simulation.advance(comm).expect("a step");
    }
    let mut sums = [visited() - before, simulation.timers.updates - updates];
    comm.sum_u64(&mut sums);
    sums[0] as f64 / sums[1] as f64
}

fn count(comm: &Comm) {
    for case in CASES {
        let case = case();
        let title = case.title.clone();
        let share = share(case, comm);
        println!("{title}: {share}");
        // Small cases have most of their particles near faces, which some cross in each step. A walk over all
        // at every balance would be .05 and more.
        assert!(share < 0.04, "{title}: {share}");
    }
}

#[test]
fn one_thread_alone_visits_next_to_nothing() {
    on_each(
        "alone::one_thread_alone_visits_next_to_nothing",
        &[1, 2, 3],
        count,
    );
}
