//! What a longer time step does to a run: used by the tests of the step's factors.

use comm::Comm;
use engine::step::Simulation;
use engine::step::measurements;
use model::Case;

use super::impact::{SPHERE, hole_radius};
use super::{bars::BAR_MATERIALS, inline, median, ready, run_with, sorted_by, start};

/// Factors of the three criteria.
#[derive(Debug, Clone, Copy)]
pub struct Factors {
    /// Sound and viscosity.
    pub courant: f64,
    /// Acceleration.
    pub force: f64,
    /// Stiffness of contact.
    pub contact: f64,
}

/// The largest factors that hold in any dimension.
pub const ANY: Factors = Factors {
    courant: 0.5,
    force: 0.25,
    contact: 0.8,
};

/// The largest factors for impacts in three dimensions.
pub const SOLID: Factors = Factors {
    courant: 0.65,
    force: 0.2,
    contact: 1.0,
};

/// A factor so small that the time step is no source of error.
pub const SMALL: f64 = 0.1;

impl Factors {
    /// The same with another factor of sound and viscosity.
    pub fn courant(self, courant: f64) -> Self {
        Self { courant, ..self }
    }

    /// The criterion of sound and viscosity alone: the others never limit.
    pub fn sound(courant: f64) -> Self {
        Self {
            courant,
            force: 1e9,
            contact: 1e9,
        }
    }

    fn apply(self, mut case: Case) -> Case {
        let options = &mut case.time_step;
        (options.courant, options.force, options.contact) =
            (self.courant, self.force, self.contact);
        case
    }
}

/// What is left of an impact at its end.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    /// Steps.
    pub steps: u64,
    /// Those that contact limited.
    pub contact_limited: u64,
    /// Largest energy error over the run.
    pub energy_error: f64,
    /// Interpenetrated particles, largest number over the run.
    pub interpenetrated: i64,
    /// Kinetic energy over the first one.
    pub kinetic: f64,
    /// Largest mean pressure of the second body over the run (Pa).
    pub peak: f64,
    /// Mean velocity of the second body along z (m/s).
    pub velocity: f64,
    /// Radius of the hole (m), where there is one.
    pub hole: Option<f64>,
}

impl Outcome {
    /// Runs a ready case with a sphere for its second body to its end.
    pub fn of(name: &str, overrides: &[&str], factors: Factors) -> Self {
        let mut s = start(factors.apply(ready(name, overrides)));
        let mut peak = 0.0_f64;
        run_with(&mut s, f64::INFINITY, |s| peak = peak.max(mean_pressure(s)));
        let state = &s.state;
        let outcome = Self {
            steps: state.step,
            contact_limited: state.worst.contact_limited_steps,
            energy_error: state.worst.energy_error,
            interpenetrated: state.worst.interpenetrated,
            kinetic: state.totals.kinetic_energy / state.initial.kinetic_energy,
            peak,
            velocity: mean_velocity(&s),
            hole: (name == "quarter-impact")
                .then(|| hole_radius(&s))
                .flatten(),
        };
        println!("{name} {overrides:?} {factors:?}\n  {outcome:?}");
        outcome
    }

    /// Largest relative difference from another outcome, and of what.
    pub fn differs(&self, other: &Self) -> (f64, &'static str) {
        let relative = |a: f64, b: f64| (a / b - 1.0).abs();
        let mut all = vec![
            (relative(self.kinetic, other.kinetic), "kinetic energy"),
            (relative(self.peak, other.peak), "peak pressure"),
            (relative(self.velocity, other.velocity), "residual velocity"),
        ];
        if let (Some(a), Some(b)) = (self.hole, other.hole) {
            all.push((relative(a, b), "hole radius"));
        }
        all.into_iter()
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .expect("some")
    }
}

fn mean_pressure(s: &Simulation) -> f64 {
    let (mut force, mut volume) = (0.0, 0.0);
    for i in (0..s.particles.owned()).filter(|&i| s.particles.body[i] == SPHERE) {
        let v = s.particles.mass[i] / s.particles.density[i];
        force += s.particles.pressure[i] * v;
        volume += v;
    }
    force / volume
}

fn mean_velocity(s: &Simulation) -> f64 {
    let (mut momentum, mut mass) = (0.0, 0.0);
    for i in (0..s.particles.owned()).filter(|&i| s.particles.body[i] == SPHERE) {
        momentum += s.particles.mass[i] * s.particles.velocity[i][2];
        mass += s.particles.mass[i];
    }
    momentum / mass
}

/// Pressure behind the shock of `inputs/flyer-plate` with overrides: mean (Pa), and its scatter
/// over the mean. Not a number when the run has gone to pieces.
pub fn plateau(speed: f64, overrides: &[&str], factors: Factors) -> (f64, f64) {
    let velocity = format!("body.flyer.velocity=[\"{speed} km/s\"]");
    let mut all = vec![&*velocity, "run.end_time=\"1 us\""];
    all.extend(overrides);
    // Beyond the start-up error at the interface, which scatters more than any factor does.
    shock(ready("flyer-plate", &all), 0, 0.3e-6, [20.0, 8.0], factors)
}

/// The same for a quarter of two blocks in three dimensions at 7 km/s, near their axis.
pub fn plateau_3d(factors: Factors) -> (f64, f64) {
    let plane = |axis: &str| format!("[[symmetry]]\naxis = \"{axis}\"\n");
    let block = |name: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"aluminium\"\n\
             shape.box = {{ size = [\"1.52 mm\", \"1.52 mm\", \"0.6 mm\"] }}\n"
        )
    };
    let case = inline(&format!(
        "dimension = 3\nspacing = \"0.02 mm\"\n[run]\nend_time = \"1 us\"\n\
         [material.aluminium]\nlibrary = \"aluminium-2024\"\nstrength = \"none\"\n{}{}\
         velocity = [0, 0, \"7 km/s\"]\ntouch = {{ body = \"target\", direction = \"+z\" }}\n{}{}",
        block("target"),
        block("flyer"),
        plane("x"),
        plane("y"),
    ));
    // The release from the sides is still on its way.
    shock(case, 2, 0.048e-6, [6.0, 5.0], factors)
}

/// Runs two bodies that meet along `axis` to `end` (s) and looks at the first one near the axis of
/// impact: between places so many spacings (`within`) from the interface and behind the front.
fn shock(case: Case, axis: usize, end: f64, within: [f64; 2], factors: Factors) -> (f64, f64) {
    let mut s = start(factors.apply(case));
    let comm = Comm::solo();
    while s.state.time < end {
        // A run that falls to pieces takes ever shorter steps.
        if s.advance(&comm).is_err() || s.state.step > 5000 {
            return (f64::NAN, f64::NAN);
        }
    }
    let spacing = s.case.bodies[0].lattice.spacing;
    let x = |i: usize| s.particles.position[i][axis];
    let mut order = sorted_by(&s, 0, x);
    order.retain(|&i| {
        let place = &s.particles.position[i];
        (0..3).all(|a| a == axis || place[a] < 3.0 * spacing)
    });
    let pressures = order.iter().map(|&i| s.particles.pressure[i]);
    let level = 0.5 * median(pressures.filter(|&p| p > 1e9).collect());
    let front = order
        .iter()
        .copied()
        .filter(|&i| s.particles.pressure[i] > level);
    let front = front.map(x).fold(f64::NEG_INFINITY, f64::max);
    let behind = x(order[0]) + within[0] * spacing..front - within[1] * spacing;
    let pressures = order.iter().filter(|&&i| behind.contains(&x(i)));
    scatter(
        &pressures
            .map(|&i| s.particles.pressure[i])
            .collect::<Vec<f64>>(),
    )
}

#[allow(clippy::cast_precision_loss, reason = "few")]
fn scatter(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|v| (v / mean - 1.0) * (v / mean - 1.0));
    (mean, (square.sum::<f64>() / n).sqrt())
}

/// Kinetic energy after 400 steps over that of the first, of a free elastic bar of 100 particles
/// with random velocities: what happens to the shortest waves.
pub fn growth_of_noise(smoothing: f64, alpha: f64, courant: f64) -> f64 {
    let case = Factors::sound(courant).apply(inline(&format!(
        "dimension = 1\nspacing = \"1 cm\"\n[sph]\nsmoothing = {smoothing}\nalpha = {alpha}\n\
         beta = {beta}\n[run]\nend_time = \"1 s\"\n{BAR_MATERIALS}\n[[body]]\nname = \"bar\"\n\
         material = \"steel\"\nshape.box = {{ lower = [0], upper = [\"100 cm\"] }}\n",
        beta = 2.0 * alpha,
    )));
    let mut s = start(case);
    let comm = Comm::solo();
    // A linear congruential generator (Knuth, MMIX): the same noise everywhere.
    let mut word = 12345_u64;
    for velocity in &mut s.particles.velocity {
        word = word
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        #[allow(clippy::cast_precision_loss, reason = "noise")]
        let fraction = (word >> 33) as f64 / f64::from(1_u32 << 31);
        velocity[0] = 1e-3 * (2.0 * fraction - 1.0);
    }
    let mut first = 0.0;
    for n in 0..400 {
        if s.advance(&comm).is_err() {
            return f64::INFINITY;
        }
        measurements::diagnose(&mut s, &comm);
        let kinetic = s.state.totals.kinetic_energy;
        if n == 0 {
            first = kinetic;
        } else if kinetic > 1e6 * first {
            return f64::INFINITY;
        }
    }
    s.state.totals.kinetic_energy / first
}
