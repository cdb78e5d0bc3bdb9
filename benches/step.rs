//! `make bench`: nanoseconds a particle and step, by phase, of the quarter impact in its shocked
//! state and of a block at rest, on one rank with all threads of this machine.

use std::time::Instant;

use whipple::comm::Comm;
use whipple::input;
use whipple::step::Simulation;

const STEPS: u32 = 30;

const BLOCK: &str = r#"
title = "Block at rest"
dimension = 3
spacing = "0.02 mm"

[run]
end_time = "1 s"

[material.aluminium]
library = "aluminium-2024"

[[body]]
name = "block"
material = "aluminium"
shape.box = { size = ["0.94 mm", "0.94 mm", "0.94 mm"] }
"#;

fn main() {
    let quarter = std::fs::read_to_string("inputs/quarter-impact/case.toml").expect("the input");
    println!(
        "{} threads, {STEPS} steps each",
        rayon::current_num_threads()
    );
    measure("block at rest", BLOCK, 5);
    measure("quarter impact, shocked", &quarter, 80);
}

/// Times steps after `warm` others.
fn measure(name: &str, text: &str, warm: u32) {
    let comm = Comm::solo();
    let case = input::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::start(case, &comm).expect("it starts");
    let mut advance = |count: u32| {
        for _ in 0..count {
            simulation.advance(&comm).expect("a step");
        }
        let phases: Vec<(&str, f64)> = simulation.timers.report().collect();
        (simulation.store.owned(), simulation.memory(), phases)
    };
    let (_, _, before) = advance(warm);
    let start = Instant::now();
    let (particles, memory, after) = advance(STEPS);
    let wall = start.elapsed().as_secs_f64();
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    let (updates, threads) = (
        particles as f64 * f64::from(STEPS),
        rayon::current_num_threads() as f64,
    );
    println!(
        "{name}: {particles} particles, {:.3} M updates/s/core, {} bytes/particle",
        updates * 1e-6 / wall / threads,
        memory / particles,
    );
    for ((phase, before), (_, after)) in before.iter().zip(&after) {
        let nanoseconds = (after - before) * threads / updates * 1e9;
        if nanoseconds >= 0.05 {
            println!("  {phase:<32} {nanoseconds:8.1} ns");
        }
    }
}
