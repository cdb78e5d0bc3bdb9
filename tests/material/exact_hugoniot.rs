//! Plane impact of Mie–Grüneisen materials against tabulated figures and the jump conditions.

use crate::exact::release::free_surface_velocity;
use exact::hugoniot::{Medium, impact, meeting, shock};
use exact::plates::{Plate, profile};
use material::library;

fn medium(name: &str) -> Medium {
    Medium::of(&library::find(name).unwrap()).unwrap()
}

/// A figure printed to a number of digits holds to half a unit of the last one.
fn assert_printed(value: f64, printed: f64, unit: f64, what: &str) {
    assert!(
        (value - printed).abs() <= 0.5 * unit,
        "{what}: {value} is not {printed} as printed"
    );
}

#[test]
fn symmetric_impact_pressures() {
    let table = [
        (
            "aluminium-6061",
            [(8.03, 0.01), (17.95, 0.01), (43.5, 0.1), (95.9, 0.1)],
        ),
        (
            "aluminium-2024",
            [(8.35, 0.01), (18.6, 0.1), (44.6, 0.1), (97.6, 0.1)],
        ),
        (
            "copper",
            [(20.9, 0.1), (48.5, 0.1), (124.0, 1.0), (286.0, 1.0)],
        ),
        (
            "steel-304",
            [(21.0, 0.1), (47.9, 0.1), (119.0, 1.0), (271.0, 1.0)],
        ),
    ];
    for (name, pressures) in table {
        let metal = medium(name);
        for (speed, (pressure, unit)) in [1e3, 2e3, 4e3, 7e3].into_iter().zip(pressures) {
            let result = impact(&metal, &metal, speed);
            assert_printed(result.pressure * 1e-9, pressure, unit, name);
            assert!((result.interface_velocity - 0.5 * speed).abs() < 1e-9 * speed);
        }
    }
}

/// Shocks in any equation of state: on its surface, and by the jump conditions of a gas and of Mie–Grüneisen.
#[test]
fn shocks_meet_the_equation_of_state() {
    let air = library::find("air").unwrap();
    let (rho, p0, u) = (air.reference_density, 101_325.0, 1e3);
    let quarter = 0.25 * 2.4 * u;
    let speed = quarter + f64::hypot(quarter, (1.4 * p0 / rho).sqrt());
    let behind = shock(&air, u);
    assert!((behind.shock_speed / speed - 1.0).abs() < 1e-9);
    assert!((behind.pressure / (p0 + rho * speed * u) - 1.0).abs() < 1e-9);
    for name in ["water", "basalt-tillotson", "iron-tillotson", "air"] {
        let material = library::find(name).unwrap();
        let behind = shock(&material, 2e3);
        let at = (material.eos).at(
            material.reference_density,
            behind.density,
            behind.specific_energy,
        );
        assert!((at.pressure / behind.pressure - 1.0).abs() < 1e-6, "{name}");
    }
    let metals = ["copper", "aluminium-2024"].map(|name| library::find(name).unwrap());
    let [a, b] = meeting([&metals[0], &metals[1]], 7e3);
    assert!((a.pressure / b.pressure - 1.0).abs() < 1e-9);
    assert!((a.particle_velocity + b.particle_velocity - 7e3).abs() < 1e-6);
    let exact = impact(&medium("aluminium-2024"), &medium("copper"), 7e3);
    assert!((a.pressure / exact.pressure - 1.0).abs() < 1e-9);
}

#[test]
fn free_surface_velocity_ratios() {
    let table = [
        ("aluminium-2024", 1e3, 1.001),
        ("aluminium-2024", 2e3, 1.003),
        ("aluminium-2024", 4e3, 1.012),
        ("aluminium-2024", 7e3, 1.031),
        ("aluminium-6061", 7e3, 1.033),
        ("copper", 7e3, 1.055),
        ("steel-304", 7e3, 1.042),
    ];
    for (name, speed, ratio) in table {
        let metal = medium(name);
        let result = impact(&metal, &metal, speed);
        let surface = free_surface_velocity(&metal, &result);
        assert_printed(surface / speed, ratio, 0.001, name);
    }
}

#[test]
fn shocked_state_lies_on_the_equation_of_state() {
    // The Hugoniot and the equation of state are the same function written twice: round-off.
    let mut curved = medium("aluminium-2024");
    curved.eos.s2 = 0.3;
    curved.eos.s3 = -0.2;
    for metal in [medium("steel-304"), curved] {
        for u in [10.0, 500.0, 3500.0, 6000.0] {
            let shock = metal.shock(u);
            let at = metal.eos.response(
                metal.reference_density,
                shock.density,
                shock.specific_energy,
            );
            assert!(
                (at.pressure / shock.pressure - 1.0).abs() < 1e-11,
                "{u} m/s"
            );
            let mass = shock.density * (shock.shock_speed - u);
            assert!((mass / (metal.reference_density * shock.shock_speed) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn asymmetric_impact_matches_pressures() {
    let (copper, aluminium) = (medium("copper"), medium("aluminium-2024"));
    let result = impact(&copper, &aluminium, 5e3);
    assert!((result.flyer.pressure / result.target.pressure - 1.0).abs() < 1e-12);
    // The stiffer flyer pushes the interface beyond half its speed.
    assert!(result.interface_velocity > 2.5e3);
    // Seen from the flyer it is the same impact.
    let reversed = impact(&aluminium, &copper, 5e3);
    assert!((reversed.pressure / result.pressure - 1.0).abs() < 1e-12);
    assert!((reversed.interface_velocity + result.interface_velocity - 5e3).abs() < 1e-8);
}

#[test]
fn weak_impact_is_acoustic() {
    // p = ρ₀ c₀ u and u_fs = 2u up to relative terms of order s₁ u/c₀ ≈ 3e-6 at u = 0.01 m/s.
    let metal = medium("aluminium-6061");
    let result = impact(&metal, &metal, 0.02);
    let acoustic = metal.reference_density * metal.eos.c0 * 0.01;
    assert!((result.pressure / acoustic - 1.0).abs() < 1e-5);
    assert!((free_surface_velocity(&metal, &result) / 0.02 - 1.0).abs() < 1e-5);
}

#[test]
fn plates_carry_their_shocks_from_a_gap_on() {
    let (copper, aluminium) = (medium("copper"), medium("aluminium-2024"));
    let plate = |medium, left, velocity| Plate {
        medium,
        left,
        length: 4e-3,
        velocity,
    };
    let (left, right) = (plate(copper, 0.0, 3e3), plate(aluminium, 5e-3, -1e3));
    let result = impact(&copper, &aluminium, 4e3);
    // They meet after 1 mm at 4 km/s.
    let before = profile([&left, &right], 2e-7).unwrap();
    assert!(before.iter().flatten().all(|s| s.pressure == 0.0));
    let after = profile([&left, &right], 5e-7).unwrap();
    let (a, b) = (&after[0], &after[1]);
    assert_eq!(a[3].position, b[0].position);
    assert!((a[3].position - (4.75e-3 + (result.interface_velocity - 1e3) * 2.5e-7)).abs() < 1e-12);
    assert!((a[3].pressure / b[0].pressure - 1.0).abs() < 1e-12);
    assert_eq!(a[3].velocity, b[0].velocity);
    // Mass, momentum and energy (at equal areas) are those of the start.
    let sum = |f: &dyn Fn(&exact::Sample) -> f64| -> f64 {
        let fragments = after.iter().flat_map(|line| line.windows(2));
        fragments
            .map(|p| 0.5 * (f(&p[0]) + f(&p[1])) * (p[1].position - p[0].position))
            .sum()
    };
    let start = |f: &dyn Fn(f64) -> f64| 4e-3 * (8930.0 * f(3e3) + 2785.0 * f(-1e3));
    let ratios = [
        sum(&|s| s.density) / start(&|_| 1.0),
        sum(&|s| s.density * s.velocity) / start(&|v| v),
        sum(&|s| s.density * (0.5 * s.velocity * s.velocity + s.specific_energy))
            / start(&|v| 0.5 * v * v),
    ];
    for ratio in ratios {
        assert!((ratio - 1.0).abs() < 1e-12, "{ratios:?}");
    }
    let released = profile([&left, &right], 2e-6).unwrap_err();
    assert!(released.since > 5e-7 && released.since < 2e-6);
}
