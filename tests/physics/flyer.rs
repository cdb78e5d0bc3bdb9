//! Symmetric flyer plates in uniaxial strain (`inputs/flyer-plate`) against the Hugoniot.
//!
//! 2024 aluminium without strength. Pressure and shock speed are within .2 % in the corrected form. In the
//! conventional one what is left of the error does not fall with the spacing: a lattice compressed from
//! h = 1.3 Δp differentiates a linear field with a factor `A(h/Δp)` of .977 to 1.024 instead of 1
//! (`Lattice` below), which [`leftover_is_the_lattice_sum`] holds to account.

use crate::physics_support::{
    crossing, lattice_factor, median, ready, run_to, run_with, slope, sorted_by, start,
};
use crate::release::free_surface_velocity;
use engine::step::Simulation;
use exact::hugoniot::{Impact, Medium, impact};

/// Of pressure and shock speed.
const BOUND: f64 = 0.002;
/// Thickness of each plate (m).
const THICKNESS: f64 = 4e-3;

/// A flyer of `cells` particles a plate at `speed` (km/s), and the exact answer.
struct Flyer {
    simulation: Simulation,
    medium: Medium,
    exact: Impact,
    /// When the shock reaches the free face (s).
    arrival: f64,
}

/// What a run shows.
struct Measured {
    pressure: f64,
    shock_speed: f64,
    /// Largest pressure of a particle that contact presses on, at any time, over the plateau's.
    peak: f64,
}

impl Flyer {
    fn new(speed: f64, cells: f64, more: &[&str]) -> Self {
        let spacing = format!("spacing=\"{} m\"", THICKNESS / cells);
        let velocity = format!("body.flyer.velocity=[\"{speed} km/s\"]");
        let mut overrides = vec![&*spacing, &*velocity, "run.end_time=\"1 us\""];
        overrides.extend(more);
        let case = ready("flyer-plate", &overrides);
        let medium = Medium::of(&case.materials[0]).expect("Mie-Grueneisen");
        let exact = impact(&medium, &medium, 1e3 * speed);
        Self {
            simulation: start(case),
            medium,
            exact,
            arrival: THICKNESS / exact.target.shock_speed,
        }
    }

    /// Runs until the shock is three quarters through the target.
    fn measure(&mut self) -> Measured {
        let (half, arrival) = (0.5 * self.exact.pressure, self.arrival);
        let spacing = self.simulation.case.bodies[0].lattice.spacing;
        let mut fronts = Vec::new();
        let (mut pressure, mut peak) = (0.0, 0.0_f64);
        let mut next = 0.3 * arrival;
        run_with(&mut self.simulation, 0.75 * arrival, |s| {
            for (&p, contact) in
                (s.particles.pressure.iter()).zip(&s.particles.contact_acceleration)
            {
                if contact[0] != 0.0 {
                    peak = peak.max(p);
                }
            }
            if s.state.time < next {
                return;
            }
            next += 0.03 * arrival;
            let x = |i: usize| s.particles.position[i][0];
            let order = sorted_by(s, 0, x);
            let front = crossing(s, &order, 0, half);
            fronts.push((s.state.time, front));
            let interface = x(order[0]);
            let plateau: Vec<f64> = order
                .iter()
                .filter(|&&i| x(i) > interface + 8.0 * spacing && x(i) < front - 8.0 * spacing)
                .map(|&i| s.particles.pressure[i])
                .collect();
            if plateau.len() >= 4 {
                pressure = median(plateau);
            }
        });
        Measured {
            pressure,
            shock_speed: slope(&fronts),
            peak: peak / pressure,
        }
    }
}

fn relative(value: f64, exact: f64) -> f64 {
    value / exact - 1.0
}

#[test]
fn reaches_the_hugoniot_at_7_km_s() {
    for cells in [100.0, 200.0, 400.0] {
        let mut flyer = Flyer::new(7.0, cells, &[]);
        let measured = flyer.measure();
        let pressure = relative(measured.pressure, 97.6e9);
        let speed = relative(measured.shock_speed, flyer.exact.target.shock_speed);
        let worst = &flyer.simulation.state.worst;
        println!(
            "{cells} cells: {:.2} GPa ({:+.3} %), {:.0} m/s ({:+.3} %), peak {:.3}, energy error {:.4} %",
            measured.pressure * 1e-9,
            1e2 * pressure,
            measured.shock_speed,
            1e2 * speed,
            measured.peak,
            1e2 * worst.energy_error
        );
        assert!(pressure.abs() < BOUND, "pressure off by {pressure}");
        assert!(speed.abs() < BOUND, "shock speed off by {speed}");
        assert!(measured.peak < 1.1, "{}", measured.peak);
        assert!(worst.energy_error < 0.005 && worst.contact_defect < 0.001);
        assert_eq!(worst.interpenetrated, 0);
        assert_eq!(worst.contact_limited_steps, 0);
    }
}

#[test]
fn reaches_the_hugoniot_at_other_speeds() {
    for speed in [1.0, 2.0, 4.0] {
        let mut flyer = Flyer::new(speed, 200.0, &[]);
        let measured = flyer.measure();
        let pressure = relative(measured.pressure, flyer.exact.pressure);
        let shock = relative(measured.shock_speed, flyer.exact.target.shock_speed);
        println!(
            "{speed} km/s: {:.3} GPa ({:+.3} %), {:.0} m/s ({:+.3} %), peak {:.3}",
            measured.pressure * 1e-9,
            1e2 * pressure,
            measured.shock_speed,
            1e2 * shock,
            measured.peak
        );
        assert!(pressure.abs() < BOUND, "{speed} km/s: pressure {pressure}");
        assert!(shock.abs() < BOUND, "{speed} km/s: shock speed {shock}");
        // As the plates begin to meet; later it is below one, where the conventional form keeps 1.6.
        assert!(measured.peak < 1.15, "{}", measured.peak);
    }
}

#[test]
fn variable_smoothing_length_keeps_the_bounds_at_7_km_s() {
    let mut flyer = Flyer::new(7.0, 200.0, &["sph.smoothing_length=variable"]);
    let measured = flyer.measure();
    let pressure = relative(measured.pressure, 97.6e9);
    let speed = relative(measured.shock_speed, flyer.exact.target.shock_speed);
    println!(
        "variable h: {:+.2} %, {:+.2} %",
        1e2 * pressure,
        1e2 * speed
    );
    assert!(pressure.abs() < BOUND && speed.abs() < BOUND);
}

/// The free face moves at the velocity behind the shock plus that of the isentropic release.
/// A tenth of a percent: the median of twelve particles once the release has passed them.
#[test]
fn free_surface_velocity_follows_the_isentrope() {
    for speed in [1.0, 2.0, 4.0, 7.0] {
        let mut flyer = Flyer::new(speed, 200.0, &[]);
        let s = &mut flyer.simulation;
        run_to(s, 1.3 * flyer.arrival);
        let order = sorted_by(s, 0, |i| -s.particles.position[i][0]);
        let outer = order[..12].iter().map(|&i| s.particles.velocity[i][0]);
        let measured = median(outer.collect());
        let exact = free_surface_velocity(&flyer.medium, &flyer.exact);
        println!(
            "{speed} km/s: u_fs/V = {:.4}, exact {:.4}",
            measured / (1e3 * speed),
            exact / (1e3 * speed)
        );
        assert!(relative(measured, exact).abs() < 0.001);
    }
}

/// The shock that the sums carry on a one-dimensional lattice, without any other error.
///
/// The density follows `d ln ρ = A d ln(1/Δp)` instead of the spacing, and the lattice carries
/// the pressure `p A (ρ_true/ρ)²`, with the `A` of [`lattice_factor`].
struct Lattice<'a> {
    medium: &'a Medium,
    /// h/Δp at the start.
    ratio: f64,
}

impl Lattice<'_> {
    /// Shock speed (m/s) at a particle velocity (m/s).
    fn shock_speed(&self, velocity: f64) -> f64 {
        let steps = 400_i32;
        let rho_0 = self.medium.reference_density;
        // Bisection for the compressed spacing over the first one.
        let (mut low, mut high) = (0.4, 0.99);
        for _ in 0..60 {
            let s = 0.5 * (low + high);
            let width = (1.0 - s) / f64::from(steps);
            let logarithm: f64 = (0..steps)
                .map(|k| s + (f64::from(k) + 0.5) * width)
                .map(|t| lattice_factor(self.ratio / t) * width / t)
                .sum();
            let density = rho_0 * logarithm.exp();
            let response = self
                .medium
                .eos
                .response(rho_0, density, 0.5 * velocity * velocity);
            let carried = response.pressure
                * lattice_factor(self.ratio / s)
                * (rho_0 / (s * density)).powi(2);
            if carried > rho_0 * velocity * velocity / (1.0 - s) {
                low = s;
            } else {
                high = s;
            }
        }
        velocity / (1.0 - 0.5 * (low + high))
    }
}

/// What the convergence of the shock speed ends at in the conventional form is the lattice sum, not the exact Hugoniot.
/// 0.15 %: the front itself still converges at 400 cells.
#[test]
fn leftover_is_the_lattice_sum() {
    for speed in [1.0, 2.0, 4.0, 7.0] {
        let mut flyer = Flyer::new(speed, 400.0, &["sph.form=conventional"]);
        let measured = flyer.measure().shock_speed;
        let lattice = Lattice {
            medium: &flyer.medium,
            ratio: 1.3,
        };
        let expected = lattice.shock_speed(500.0 * speed);
        let exact = flyer.exact.target.shock_speed;
        println!(
            "{speed} km/s: measured {:+.2} %, lattice {:+.2} %",
            1e2 * relative(measured, exact),
            1e2 * relative(expected, exact)
        );
        assert!(relative(measured, expected).abs() < 0.0015);
    }
}

/// Distance of the target's two outermost particles at the interface, over the median of the bulk
/// behind the shock.
fn outermost_spacing(s: &Simulation) -> f64 {
    let x = |i: usize| s.particles.position[i][0];
    let order = sorted_by(s, 0, x);
    let gap = |k: usize| x(order[k + 1]) - x(order[k]);
    gap(0) / median((10..30).map(gap).collect())
}

/// Four metals at four speeds: pressure, shock speed and the velocity of the free surface; with variable h
/// the outermost spacing at least half of the bulk's.
#[test]
#[ignore = "slow: make validation"]
fn four_metals_reach_their_hugoniots() {
    let percent = |value: f64, exact: f64| 1e2 * relative(value, exact);
    let mut missed = Vec::new();
    for h in ["constant", "variable"] {
        for metal in ["aluminium-6061", "aluminium-2024", "copper", "steel-304"] {
            for speed in [1.0, 2.0, 4.0, 7.0] {
                let material = format!("material.aluminium.library={metal}");
                let length = format!("sph.smoothing_length={h}");
                let mut flyer = Flyer::new(speed, 200.0, &[&material, &length]);
                let measured = flyer.measure();
                let outermost = outermost_spacing(&flyer.simulation);
                let s = &mut flyer.simulation;
                run_to(s, 1.3 * flyer.arrival);
                let order = sorted_by(s, 0, |i| -s.particles.position[i][0]);
                let outer = order[..12].iter().map(|&i| s.particles.velocity[i][0]);
                let free = free_surface_velocity(&flyer.medium, &flyer.exact);
                let errors = [
                    percent(measured.pressure, flyer.exact.pressure),
                    percent(measured.shock_speed, flyer.exact.target.shock_speed),
                    percent(median(outer.collect()), free),
                ];
                println!(
                    "{h} {metal} {speed} km/s: {:.2} GPa {errors:+.2?} %, outermost {outermost:.2}",
                    1e-9 * flyer.exact.pressure,
                );
                assert!(h == "constant" || outermost >= 0.5, "{outermost}");
                let bound = if h == "constant" { 0.2 } else { 0.25 };
                if errors.iter().any(|e| e.abs() > bound) {
                    missed.push(format!("{h} {metal} {speed} km/s"));
                }
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}
