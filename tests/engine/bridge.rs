//! Two blocks that hang together by a bridge, and sleep while it goes.

use std::collections::BTreeSet;

use comm::Comm;
use engine::step::Simulation;
use files::input;
use model::Case;

pub const STEPS: usize = 60;

/// The case.
pub fn case() -> Case {
    let text = include_str!("../common/bridge.toml");
    input::parse("tests/common/bridge.toml", text, &[]).unwrap()
}

/// One step more, before one of which the bridge flies off, out of the box of interest.
pub fn advance(simulation: &mut Simulation, comm: &Comm) {
    if simulation.state.step == 27 {
        let bridge = |x: &&mut [f64; 3]| x[0].abs() < 0.9e-3 && x[1] < 3e-3;
        let owned = simulation.particles.owned();
        let positions = simulation.particles.position[..owned].iter_mut();
        positions.filter(bridge).for_each(|x| x[1] += 0.03);
    }
    simulation.advance(comm).unwrap();
}

/// Both blocks are there, each by itself, and else next to nothing: `parts` are the labels of all particles.
pub fn assert_apart(parts: &[u64]) {
    let count = |label: &u64| parts.iter().filter(|&part| part == label).count();
    let labels: BTreeSet<u64> = parts.iter().copied().collect();
    let large = labels.iter().filter(|label| count(label) > 7_000);
    assert_eq!(large.count(), 2, "{labels:?}");
    assert!(parts.len() < 26_652, "nothing has left");
}
