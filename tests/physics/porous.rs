//! Porous plates in uniaxial strain: the elastic precursor and the shock that crushes.
//!
//! The aluminium foam of Jutzi, Benz & Michel (2008), Icarus 198, 242, §5.1 (after Herrmann 1969): Tillotson, α₀ = 1.275,
//! `P_e = 80 MPa`, `P_s = 700 MPa`, `c_e = 4110 m/s`, without strength, pressed at 458 m/s. The exact answer is two shocks: one to the
//! elastic limit, and into that state one that leaves no pores, each by the jump conditions with the solid's equation of state.

use crate::physics_support::{crossing, inline, median, run_with, slope, sorted_by, start};
use engine::step::Simulation;
use exact::bisect;
use material::Tillotson;

/// Of pressure, density and both wave speeds.
const BOUND: f64 = 0.02;
/// Thickness of each plate (m).
const THICKNESS: f64 = 8e-3;
/// Particles through a plate.
const CELLS: f64 = 400.0;
/// Velocity of the interface relative to each plate (m/s).
const PISTON: f64 = 458.0;

const SOLID: f64 = 2700.0;
const ALPHA: f64 = 1.275;
const ELASTIC: f64 = 80e6;
const SOUND: f64 = 4110.0;

/// Tillotson's aluminium.
const ALUMINIUM: Tillotson = Tillotson {
    a: 0.5,
    b: 1.63,
    bulk_modulus: 75.2e9,
    quadratic_modulus: 65e9,
    alpha: 5.0,
    beta: 5.0,
    e0: 5e6,
    e_iv: 3e6,
    e_cv: 13.9e6,
    least_density: 0.0,
};

/// A state behind a shock.
#[derive(Debug)]
struct State {
    pressure: f64,
    density: f64,
    energy: f64,
    velocity: f64,
    /// Speed of the shock in the frame of the plate at rest.
    shock: f64,
}

/// Pressure of dense aluminium.
fn dense(density: f64, energy: f64) -> f64 {
    ALUMINIUM.response(SOLID, density, energy).pressure
}

/// The elastic limit: on the elastic line `α = α₀/(1 + β p)`.
fn precursor() -> State {
    let rho0 = SOLID / ALPHA;
    let h2 = SOUND * SOUND * SOLID / ALUMINIUM.bulk_modulus;
    let beta = ALPHA * (1.0 / h2 - 1.0) / ALUMINIUM.bulk_modulus;
    let alpha = ALPHA / (1.0 + beta * ELASTIC);
    let energy = |rho: f64| 0.5 * ELASTIC * (1.0 / rho0 - 1.0 / rho);
    let density = bisect(rho0, 1.1 * rho0, |rho| {
        dense(alpha * rho, energy(rho)) / alpha - ELASTIC
    });
    let velocity = (ELASTIC * (1.0 / rho0 - 1.0 / density)).sqrt();
    State {
        pressure: ELASTIC,
        density,
        energy: energy(density),
        velocity,
        shock: ELASTIC / (rho0 * velocity),
    }
}

/// The shock into the elastic limit that gives the matter the velocity of the piston.
fn crushed(first: &State) -> State {
    let jump = PISTON - first.velocity;
    let behind = |density: f64| {
        // ρ₁ (U − u₁) = ρ (U − u), with D = U − u₁.
        let speed = jump / (1.0 - first.density / density);
        let pressure = first.pressure + first.density * speed * jump;
        let energy = first.energy
            + 0.5 * (pressure + first.pressure) * (1.0 / first.density - 1.0 / density);
        (pressure, energy, speed)
    };
    let density = bisect(2500.0, 3500.0, |density| {
        let (pressure, energy, _) = behind(density);
        dense(density, energy) - pressure
    });
    let (pressure, energy, speed) = behind(density);
    State {
        pressure,
        density,
        energy,
        velocity: PISTON,
        shock: first.velocity + speed,
    }
}

/// Two plates of foam that meet at twice the speed of the piston.
fn plates(law: &str) -> Simulation {
    start(inline(&format!(
        "dimension = 1\nspacing = \"{} m\"\nrun.end_time = \"4 us\"\n\
         [material.foam]\nlibrary = \"aluminium-tillotson\"\nstrength = \"none\"\n\
         [material.foam.porosity]\ndistension = {ALPHA}\n{law}\n\
         [[body]]\nname = \"target\"\nmaterial = \"foam\"\n\
         shape.box = {{ lower = [0], upper = [\"{THICKNESS} m\"] }}\n\
         [[body]]\nname = \"flyer\"\nmaterial = \"foam\"\n\
         shape.box = {{ lower = [\"-{} m\"], upper = [\"-1 mm\"] }}\n\
         velocity = [\"{} m/s\"]\ntouch = {{ body = \"target\", direction = \"+x\" }}\n",
        THICKNESS / CELLS,
        THICKNESS + 1e-3,
        2.0 * PISTON,
    )))
}

/// Fronts, and the medians of pressure, density, energy and distension behind the shock.
struct Measured {
    precursor: f64,
    shock: f64,
    behind: [f64; 4],
    elastic: f64,
    energy_error: f64,
}

fn measure(law: &str) -> Measured {
    let mut s = plates(law);
    let end = 0.8 * THICKNESS / SOUND;
    let (mut first, mut second) = (Vec::new(), Vec::new());
    let mut next = 0.35 * end;
    run_with(&mut s, end, |s| {
        if s.state.time < next {
            return;
        }
        next += 0.03 * end;
        let order = sorted_by(s, 0, |i| s.particles.position[i][0]);
        first.push((s.state.time, crossing(s, &order, 0, 0.5 * ELASTIC)));
        second.push((s.state.time, crossing(s, &order, 0, 0.5 * 1.96e9)));
    });
    let spacing = THICKNESS / CELLS;
    let order = sorted_by(&s, 0, |i| s.particles.position[i][0]);
    let x = |i: usize| s.particles.position[i][0];
    let (ahead, front, interface) = (
        first.last().unwrap().1,
        second.last().unwrap().1,
        x(order[0]),
    );
    let within = |low: f64, high: f64, field: &dyn Fn(usize) -> f64| {
        let some = order.iter().filter(|&&i| x(i) > low && x(i) < high);
        let some: Vec<f64> = some.map(|&i| field(i)).collect();
        if some.is_empty() {
            f64::NAN
        } else {
            median(some)
        }
    };
    let behind = |field: &dyn Fn(usize) -> f64| {
        within(interface + 8.0 * spacing, front - 8.0 * spacing, field)
    };
    let p = &s.particles;
    Measured {
        precursor: slope(&first),
        shock: slope(&second),
        behind: [
            behind(&|i| p.pressure[i]),
            behind(&|i| p.density[i]),
            behind(&|i| p.specific_energy[i]),
            behind(&|i| p.distension[i]),
        ],
        elastic: within(front + 20.0 * spacing, ahead - 20.0 * spacing, &|i| {
            p.pressure[i]
        }),
        energy_error: s.state.worst.energy_error,
    }
}

#[test]
fn crushing_shock_and_its_precursor_are_those_of_the_hugoniot() {
    let first = precursor();
    let exact = crushed(&first);
    println!("exact {first:?}\n      {exact:?}");
    // The figures of the publication's own case.
    assert!(
        (exact.shock / 1983.0 - 1.0).abs() < 2e-3 && (exact.pressure / 1.960e9 - 1.0).abs() < 2e-3
    );
    let measured = measure(
        "p_alpha = { elastic_pressure = \"80 MPa\", solid_pressure = \"700 MPa\", sound_speed = \"4110 m/s\" }",
    );
    let [pressure, density, energy, distension] = measured.behind;
    println!(
        "precursor {:.0} m/s, {:.2} MPa; shock {:.0} m/s, {:.4} GPa, {:.1} kg/m3, {:.2} kJ/kg, alpha {distension}; \
         energy error {:.4} %",
        measured.precursor,
        1e-6 * measured.elastic,
        measured.shock,
        1e-9 * pressure,
        density,
        1e-3 * energy,
        1e2 * measured.energy_error
    );
    for (name, value, exact) in [
        ("precursor", measured.precursor, first.shock),
        ("elastic limit", measured.elastic, ELASTIC),
        ("shock", measured.shock, exact.shock),
        ("pressure", pressure, exact.pressure),
        ("density", density, exact.density),
        ("energy", energy, exact.energy),
    ] {
        assert!(
            (value / exact - 1.0).abs() < BOUND,
            "{name}: {value} for {exact}"
        );
    }
    assert_eq!(distension, 1.0);
    assert!(measured.energy_error < 0.003);
}

/// With the strain law of the same foam, whose curve ends in the same dense matter, the shock is the same within its
/// own precursor: none, since pores crush from the beginning.
#[test]
fn the_law_of_strain_crushes_to_the_same_state() {
    let rest = State {
        pressure: 0.0,
        density: SOLID / ALPHA,
        energy: 0.0,
        velocity: 0.0,
        shock: 0.0,
    };
    let exact = crushed(&rest);
    let measured = measure("epsilon_alpha = { transition_strain = -0.24, kappa = 0.99 }");
    let [pressure, density, energy, distension] = measured.behind;
    println!(
        "exact {exact:?}\nshock {:.0} m/s, {:.4} GPa, {density:.1} kg/m3, {energy:.0} J/kg, alpha {distension}; energy error {:.4} %",
        measured.shock,
        1e-9 * pressure,
        1e2 * measured.energy_error
    );
    for (name, value, exact) in [
        ("shock", measured.shock, exact.shock),
        ("pressure", pressure, exact.pressure),
        ("density", density, exact.density),
        ("energy", energy, exact.energy),
    ] {
        assert!(
            (value / exact - 1.0).abs() < BOUND,
            "{name}: {value} for {exact}"
        );
    }
    assert_eq!(distension, 1.0);
    assert!(measured.energy_error < 0.003);
}
