//! The breaking dam, `inputs/dam-break`, and what is measured on it.

use engine::step::Simulation;
use plot::largest_reaches;

use super::{ready, run_with, start};

/// Length of the tank and height of its walls (m).
const TANK: [f64; 2] = [0.584, 0.73];
/// Width of the column of water (m).
const WIDTH: f64 = 0.146;
/// `√(a/2g)` of Martin & Moyce (1952) for this column (s).
const TIME: f64 = 0.08626;
/// Distance of the front over the width of the column, and Martin & Moyce's time of it.
const MEASURED: [[f64; 2]; 3] = [[2.0, 1.71], [3.0, 2.52], [4.0, 3.21]];
/// The index of the water.
const WATER: u32 = 0;

/// What a run of the dam shows.
pub struct Dam {
    pub simulation: Simulation,
    /// Times of the front at two, three and four widths over those of Martin & Moyce.
    pub arrivals: [f64; 3],
    /// Largest change of the volume of water, over the first.
    pub volume: f64,
    /// Smallest distance of a particle of water from the face of a wall, in spacings.
    pub wall: f64,
}

/// Runs the dam with overrides to `end` (s), with a look at every tenth step.
pub fn run(overrides: &[&str], end: f64) -> Dam {
    let mut simulation = start(ready("dam-break", overrides));
    let spacing = simulation.case.bodies[0].lattice.spacing;
    let first = volume(&simulation);
    let (mut arrivals, mut worst, mut wall) = ([f64::NAN; 3], 0.0_f64, f64::INFINITY);
    run_with(&mut simulation, end, |s| {
        if !s.state.step.is_multiple_of(10) {
            return;
        }
        worst = worst.max((volume(s) / first - 1.0).abs());
        wall = wall.min(distance_to_walls(s) / spacing);
        if arrivals[2].is_nan() {
            // Water that touches the far wall stands a trifle before it.
            let front = (front(s, spacing) + 0.05 * spacing) / WIDTH;
            for (arrival, [z, time]) in arrivals.iter_mut().zip(MEASURED) {
                if arrival.is_nan() && front >= z {
                    *arrival = s.state.time / TIME / time;
                }
            }
        }
    });
    Dam {
        simulation,
        arrivals,
        volume: worst,
        wall,
    }
}

fn water(s: &Simulation) -> impl Iterator<Item = usize> {
    (0..s.particles.owned()).filter(|&i| s.particles.body[i] == WATER)
}

/// Area of the water (m²).
fn volume(s: &Simulation) -> f64 {
    water(s)
        .map(|i| s.particles.mass[i] / s.particles.density[i])
        .sum()
}

/// Smallest distance of a particle of water from floor or walls (m); negative behind them.
fn distance_to_walls(s: &Simulation) -> f64 {
    let distance = |i: usize| {
        let [x, y, _] = s.particles.position[i];
        assert!(y < TANK[1], "water leaves over the walls");
        x.min(TANK[0] - x).min(y)
    };
    water(s).map(distance).fold(f64::INFINITY, f64::min)
}

/// How far the bulk of the water reaches (m).
fn front(s: &Simulation, spacing: f64) -> f64 {
    let points: Vec<[f64; 3]> = water(s).map(|i| s.particles.position[i]).collect();
    largest_reaches(&points, 0, spacing).expect("there is water")
}

/// One line for people.
pub fn report(dam: &Dam) {
    let state = &dam.simulation.state;
    println!(
        "front over measured times {:.3?}, volume {:.4}, wall {:.2} dp, energy error {:.1e}, \
         {} steps to {:.3} s",
        dam.arrivals, dam.volume, dam.wall, state.worst.energy_error, state.step, state.time
    );
}
