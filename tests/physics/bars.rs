//! The paper's section 3.2: a steel bar on an aluminium bar, against the exact answers.

use crate::physics_support::bars::{axial_stress, force_on_right, in_order, interface_force};
use crate::physics_support::{median, ready, run_with, start};
use crate::shocks::{Shocks, impact};
use engine::step::Simulation;
use exact::finite_strain::Medium;

/// Final mean velocity of the aluminium in small strain (m/s).
const REBOUND: f64 = 386.1;
/// The interface in small strain: −stress (Pa) and velocity (m/s), at ±200 m/s.
const LINEAR: [f64; 2] = [0.049_04e11, 93.04];

/// How a case departs from the input.
#[derive(Clone, Copy, Debug)]
struct Variant {
    smoothing: f64,
    cells: u32,
    /// Linear viscosity α; β = 2α.
    alpha: f64,
    /// Velocity of each bar (m/s).
    speed: f64,
    mode: &'static str,
}

/// The input but for its resolution.
const INPUT: Variant = Variant {
    smoothing: 1.25,
    cells: 50,
    alpha: 1.0,
    speed: 200.0,
    mode: "overlap",
};

/// What is read off a run.
#[derive(Debug, Default)]
struct Outcome {
    /// At .6 µs: force across the interface, medians of −stress of the two bars from a sixteenth
    /// to a fifth of them from the interface (Pa), and of the velocity of both (m/s).
    plateau: [f64; 4],
    /// Last step with a contact force (s).
    last_force: f64,
    /// Least and largest force across the interface (Pa), compression positive.
    force: [f64; 2],
    /// Largest |stress| of the first particles at the interface after 2 µs over the plateau's.
    left: f64,
    /// Final mean velocity of the aluminium (m/s).
    rebound: f64,
    /// Energy at the end less that at the start, and the largest error, over the kinetic energy.
    energy: [f64; 2],
    momentum: f64,
}

impl Variant {
    fn run(self) -> Outcome {
        let Self { cells, alpha, .. } = self;
        let mut s = start(ready(
            "bar-impact",
            &[
                &format!("spacing=\"{} cm\"", 0.4 / f64::from(cells)),
                &format!("sph.smoothing={}", self.smoothing),
                &format!("sph.alpha={alpha}"),
                &format!("sph.beta={}", 2.0 * alpha),
                &format!("contact.mode={}", self.mode),
                &format!("body.steel.velocity=[\"{} m/s\"]", self.speed),
                &format!("body.aluminium.velocity=[\"-{} m/s\"]", self.speed),
            ],
        ));
        let half = cells as usize;
        let mut out = Outcome::default();
        run_with(&mut s, f64::INFINITY, |s| {
            let force = match self.mode {
                "kernel" => force_on_right(s, half),
                _ => interface_force(s),
            };
            out.force = [out.force[0].min(force), out.force[1].max(force)];
            if force > 0.0 {
                out.last_force = s.state.time;
            }
            if s.state.time > 0.6e-6 && out.plateau[0] == 0.0 {
                out.plateau = plateau(s, half, force);
            }
            if s.state.time > 2e-6 {
                let order = in_order(s);
                let stress = |k: usize| axial_stress(s, order[k]).abs() / out.plateau[1];
                out.left = out.left.max(stress(half - 1)).max(stress(half));
            }
        });
        let state = &s.state;
        let aluminium = &in_order(&s)[half..];
        let velocities = aluminium.iter().map(|&i| s.particles.velocity[i][0]);
        out.rebound = velocities.sum::<f64>() / f64::from(cells);
        let change = state.totals.energy() - state.initial.energy();
        let end = change.abs() / state.initial.kinetic_energy;
        out.energy = [end, state.worst.energy_error];
        out.momentum = state.worst.momentum_error[0];
        println!("{self:?}\n  {out:?}");
        out
    }
}

fn plateau(s: &Simulation, half: usize, force: f64) -> [f64; 4] {
    let order = in_order(s);
    let (from, to) = (half / 16, half / 5);
    let bars = [
        &order[half - to..half - from],
        &order[half + from..half + to],
    ];
    let [steel, aluminium] =
        bars.map(|bar| median(bar.iter().map(|&i| -axial_stress(s, i)).collect()));
    let both = bars.concat();
    let velocity = median(both.iter().map(|&i| s.particles.velocity[i][0]).collect());
    [force, steel, aluminium, velocity]
}

fn near(value: f64, exact: f64, bound: f64) {
    let off = value / exact - 1.0;
    assert!(off.abs() <= bound, "{value:e} is {off:+.4} from {exact:e}");
}

/// For the program's own law at ±200 m/s, and for small strain at a tenth. The pair forces of a
/// lattice carry its factor A times the stress of its particles, inside a bar and in contact, so
/// they are held where A = 1, at h = Δp.
#[test]
fn the_interface_has_its_stress_and_velocity() {
    let case = ready("bar-impact", &[]);
    let media = [0, 1].map(|m| Medium::of(&case.materials[m]).expect("linear elastic"));
    let exact = impact([&media[0], &media[1]], [200.0, -200.0]);
    let own = [-exact.stress, exact.interface_velocity];
    for smoothing in [1.0, INPUT.smoothing] {
        for (speed, exact, bound) in [(200.0, own, 0.01), (20.0, LINEAR.map(|x| 0.1 * x), 0.005)] {
            let variant = Variant {
                smoothing,
                speed,
                cells: 200,
                ..INPUT
            };
            let [force, steel, aluminium, velocity] = variant.run().plateau;
            let off = |x: f64| x / exact[0] - 1.0;
            println!(
                "  force {:+.4}, steel {:+.4}, aluminium {:+.4}, velocity {:+.4}",
                off(force),
                off(steel),
                off(aluminium),
                velocity / exact[1] - 1.0
            );
            near(velocity, exact[1], bound);
            near(steel, exact[0], bound);
            near(aluminium, exact[0], bound);
            if smoothing == 1.0 {
                near(force, exact[0], bound);
            }
        }
    }
}

#[test]
fn the_bars_part() {
    let case = ready("bar-impact", &[]);
    let media = [0, 1].map(|m| Medium::of(&case.materials[m]).expect("linear elastic"));
    let shock = impact([&media[0], &media[1]], [200.0, -200.0]).shocks[1];
    let tail = media[1].release(&shock, 0.004).tail;
    let (mut left, mut off) = (f64::INFINITY, f64::INFINITY);
    for cells in [50, 100, 200] {
        let out = Variant { cells, ..INPUT }.run();
        near(out.last_force, tail, 0.03);
        assert!(out.force[0] >= 0.0, "the bars pull");
        assert!(out.left < 0.25 && out.left < left, "{} is left", out.left);
        left = out.left;
        let [end, largest] = out.energy;
        assert!(end <= 0.001 && largest <= 0.01 && out.momentum < 1e-14);
        let miss = (out.rebound / REBOUND - 1.0).abs();
        assert!(miss < off, "the rebound does not converge");
        off = miss;
    }
    assert!(off <= 0.03, "{off} at 200 cells");
    let weak = Variant {
        alpha: 0.25,
        ..INPUT
    }
    .run();
    near(weak.rebound, REBOUND, 0.03);
}

/// The paper's "no contact": one continuum, which pulls where bars would part.
#[test]
fn one_continuum_pulls() {
    for cells in [50, 100, 200] {
        let out = Variant {
            cells,
            mode: "kernel",
            ..INPUT
        }
        .run();
        assert!(out.force[0] < -0.3 * out.force[1], "{:?}", out.force);
    }
}
