//! Numerical failure limits: the ranges that a particle's state may not leave, and what follows if it
//! does.

use serde::Deserialize;

use super::Case;

/// The fate of a particle whose state is out of range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NumericalFailurePolicy {
    /// The run ends.
    Stop,
    /// The particle is taken out and its mass, momentum and energy are booked.
    Remove,
    /// The same, and it stays in the files, at rest where it was.
    Freeze,
}

/// Ranges of a particle's state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumericalLimits {
    /// The fate of particles outside of them.
    pub policy: NumericalFailurePolicy,
    /// Largest speed (m/s).
    pub speed_max: f64,
    /// Largest magnitude of the specific energy (J/kg).
    pub energy_max: f64,
    /// Smallest density over that of the body at the start.
    pub density_min: f64,
    /// Largest density over that of the body at the start.
    pub density_max: f64,
    /// Smallest time step (s).
    pub step_min: f64,
    /// Largest kinetic energy of the model over all energy that could drive it.
    pub gain_max: f64,
}

impl Default for NumericalLimits {
    /// The run ends at what is NaN, and at nothing else.
    fn default() -> Self {
        Self {
            policy: NumericalFailurePolicy::Stop,
            speed_max: f64::INFINITY,
            energy_max: f64::INFINITY,
            density_min: 0.0,
            density_max: f64::INFINITY,
            step_min: 0.0,
            gain_max: f64::INFINITY,
        }
    }
}

/// Largest speed over the natural one: jets reach a few times the speed of an impact.
const SPEEDS: f64 = 20.0;
/// Smallest step over the time in which the natural speed crosses the shortest smoothing length.
const STEPS: f64 = 1e-6;

impl NumericalLimits {
    /// Ranges of speed, energy and step that no healthy run of a case leaves, however violent: they are made of
    /// its own velocities, sound speeds, energies and lengths.
    #[must_use]
    pub fn natural(case: &Case) -> Self {
        let speed = Self::natural_speed(case);
        let shortest = case.bodies.iter().map(|b| b.smoothing_length);
        let shortest = shortest.fold(f64::INFINITY, f64::min);
        let speed_max = if speed > 0.0 {
            SPEEDS * speed
        } else {
            f64::INFINITY
        };
        Self {
            speed_max,
            energy_max: 0.5 * speed_max * speed_max,
            step_min: STEPS
                * (shortest / speed)
                    .min(case.time_step.max)
                    .min(case.run.end_time),
            ..Self::default()
        }
    }

    /// Speeds that a case itself names, added up (m/s): of bodies, loads and surfaces, of a fall to
    /// the end and onto all bodies in one, of sound, and of what the initial energy may drive.
    #[must_use]
    pub fn natural_speed(case: &Case) -> f64 {
        let largest = |speeds: &mut dyn Iterator<Item = f64>| speeds.fold(0.0, f64::max);
        let motions = (case.loads.velocities.iter().map(|load| &load.motion))
            .chain(case.loads.surfaces.iter().map(|surface| &surface.motion))
            .chain(case.bodies.iter().filter_map(|body| body.rigid.as_ref()));
        let driven = largest(&mut motions.map(crate::Motion::largest_speed));
        let moving = largest(
            &mut case
                .bodies
                .iter()
                .map(|body| body.velocity.norm() + body.speed_spread()),
        );
        let sound = case.fastest_sound();
        let deforming = case.bodies.iter().filter(|body| body.rigid.is_none());
        let hot = largest(&mut deforming.map(|b| (2.0 * case.initial_energy(b).abs()).sqrt()));
        let g = case.loads.gravity;
        let gravity = (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]).sqrt();
        // As much as a pressure gives a single layer.
        let pressed = largest(&mut case.loads.pressures.iter().map(|load| {
            let body = &case.bodies[load.body];
            let layer = case.initial_density(body) * body.lattice.spacing;
            load.pressure.largest_speed() / layer * case.run.end_time
        }));
        driven + moving + sound + hot + pressed + gravity * case.run.end_time + escape_speed(case)
    }
}

/// Escape speed (m/s) of a ball of all bodies with the density of the densest, zero without self-gravity.
fn escape_speed(case: &Case) -> f64 {
    let constant = case.loads.self_gravity.map_or(0.0, |own| own.constant);
    if constant == 0.0 {
        return 0.0;
    }
    let bodies = || 0..case.bodies.len();
    let mass = |b: usize| case.density_of(b) * case.bodies[b].shape.volume(case.dimension);
    let mass: f64 = bodies().map(mass).sum();
    let density = bodies().map(|b| case.density_of(b)).fold(0.0, f64::max);
    let radius = libm::cbrt(mass / (4.0 / 3.0 * std::f64::consts::PI * density));
    (2.0 * constant * mass / radius).sqrt()
}
