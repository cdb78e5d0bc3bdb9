//! Runs of the ready cases in one process, and what is measured on them.

pub mod absorbing;
pub mod bars;
pub mod dam;
pub mod hole;
pub mod impact;
pub mod slope;
pub mod steps;

use comm::Comm;
use engine::step::Simulation;
use engine::step::measurements;
use files::input;
use model::Case;
use numerics::kernel::Kernel;

/// The case `inputs/<name>/case.toml` with overrides.
pub fn ready(name: &str, overrides: &[&str]) -> Case {
    let path = crate::project::root()
        .join("inputs")
        .join(name)
        .join("case.toml");
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    input::load(&path, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// A case from a text, which names files from the project's folder.
pub fn inline(text: &str) -> Case {
    crate::project::enter();
    input::parse("test.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// A case at time zero.
pub fn start(case: Case) -> Simulation {
    crate::common::threads::stay_alone();
    Simulation::start(case, &Comm::solo()).expect("the case starts")
}

/// Steps until `time` (s) is reached or passed, with sums after each step.
pub fn run_to(simulation: &mut Simulation, time: f64) {
    run_with(simulation, time, |_| {});
}

/// As [`run_to`], with a look at each step.
pub fn run_with(simulation: &mut Simulation, time: f64, mut look: impl FnMut(&Simulation)) {
    let comm = Comm::solo();
    while !simulation.is_finished() && simulation.state.time < time {
        simulation.advance(&comm).expect("a step");
        measurements::diagnose(simulation, &comm);
        look(simulation);
    }
}

/// The middle value; the mean of two for an even number.
pub fn median(mut values: Vec<f64>) -> f64 {
    assert!(!values.is_empty(), "a median of nothing");
    values.sort_by(f64::total_cmp);
    let n = values.len();
    0.5 * (values[(n - 1) / 2] + values[n / 2])
}

/// Slope of the least-squares line through points (t, x).
pub fn slope(points: &[(f64, f64)]) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "few points")]
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (t, x) = (mean(|p| p.0), mean(|p| p.1));
    let (above, below) = points.iter().fold((0.0, 0.0), |(a, b), p| {
        (a + (p.0 - t) * (p.1 - x), b + (p.0 - t) * (p.0 - t))
    });
    above / below
}

/// `A = Σ V_j r_ij |W'_ij|`: the factor with which the sums of a one-dimensional lattice
/// differentiate a linear field, for a smoothing length of `ratio` spacings.
pub fn lattice_factor(ratio: f64) -> f64 {
    let kernel = Kernel::new(1);
    (1..=8_i32)
        .map(f64::from)
        .map(|r| -2.0 * r * kernel.slope(r, ratio))
        .sum()
}

/// Where the pressure falls through `level` (Pa) at the front, between two of the particles
/// `order`, sorted along `axis` (m).
pub fn crossing(s: &Simulation, order: &[usize], axis: usize, level: f64) -> f64 {
    let (x, p) = (
        |k: usize| s.particles.position[order[k]][axis],
        |k: usize| s.particles.pressure[order[k]],
    );
    let k = (0..order.len() - 1)
        .rev()
        .find(|&k| p(k) > level && p(k + 1) <= level)
        .expect("a front");
    x(k) + (p(k) - level) / (p(k) - p(k + 1)) * (x(k + 1) - x(k))
}

/// Owned particles of a body, in the order of `key`.
pub fn sorted_by(simulation: &Simulation, body: u32, key: impl Fn(usize) -> f64) -> Vec<usize> {
    let particles = &simulation.particles;
    let mut indices: Vec<usize> = (0..particles.owned())
        .filter(|&i| particles.body[i] == body)
        .collect();
    indices.sort_by(|&a, &b| key(a).total_cmp(&key(b)));
    indices
}
