//! What one thread visits while the others wait, in all inputs.

use crate::common::process::in_its_own;
use crate::project;
use comm::Comm;
use engine::step::Simulation;
use files::input;
use numerics::alone::visited;

/// Steps of each: balances, searches for parts and the order of the store come in them.
const STEPS: u64 = 22;

/// The ready inputs, as they are.
const INPUTS: &[&str] = &[
    "bar-impact",
    "block-impact",
    "blunt-on-weldox",
    "bumper-hole",
    "ceramic-tile",
    "crater",
    "dam-break",
    "elastic-impact",
    "flyer-plate",
    "flyer-spall",
    "grady-kipp-bar",
    "hertz-cylinder",
    "hertz-disc",
    "hiermaier-1997",
    "honeycomb-panel",
    "laminate-impact",
    "nakamura-1991",
    "noh",
    "oblique-30",
    "ogive-on-concrete",
    "ogive-on-weldox",
    "protoplanets",
    "punch",
    "quarter-impact",
    "raindrop",
    "ricochet",
    "rod-into-concrete",
    "rubber-rings",
    "sand-crater",
    "sedov",
    "sliding-block",
    "sod",
    "stuffed-shield",
    "taylor-bar",
    "tension-strip",
    "wave-pulse",
    "wave-step",
    "whipple-shield",
];

#[test]
#[ignore = "slow: all inputs at full size"]
fn one_thread_alone_visits_next_to_nothing_of_any_input() {
    let name = "alone::one_thread_alone_visits_next_to_nothing_of_any_input";
    in_its_own(name, check_all);
}

#[allow(clippy::cast_precision_loss, reason = "a share")]
fn check_all() {
    let comm = Comm::solo();
    for name in INPUTS {
        let path = project::root().join(format!("inputs/{name}/case.toml"));
        let case = input::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
        let mut simulation = Simulation::start(case, &comm).expect("it starts");
        let (before, updates) = (visited(), simulation.timers.updates);
        for _ in 0..STEPS {
            simulation.advance(&comm).expect("a step");
        }
        let updates = simulation.timers.updates - updates;
        let share = (visited() - before) as f64 / updates as f64;
        println!("{name}: {updates} updates, {share:.5}");
        assert!(share < 0.01, "{name}: {share}");
    }
}
