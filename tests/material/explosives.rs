//! Explosives: the state of Chapman and Jouguet, isentropes of the products, and the burn.

use material::{Burn, Eos, Jwl, LANES, Material, PointBatch, UNLIT, library};

fn explosives() -> Vec<(Material, Jwl)> {
    let all = library::names().into_iter().filter_map(|name| {
        let material = library::find(name)?;
        let Eos::Jwl(law) = material.eos else {
            return None;
        };
        Some((material, law))
    });
    all.collect()
}

/// Pressure of the products on the Hugoniot of detonation at the relative volume `v`:
/// `e = e₀ + p (1 − v)/(2 ρ₀)`.
fn hugoniot(law: &Jwl, rho0: f64, v: f64) -> f64 {
    let cold = law.response(rho0, rho0 / v, 0.0).pressure;
    let gain = law.omega * rho0 / v;
    (cold + gain * law.e0) / (1.0 - gain * (1.0 - v) / (2.0 * rho0))
}

/// Volume, pressure and speed of the detonation of least speed.
fn chapman_jouguet(law: &Jwl, rho0: f64) -> [f64; 3] {
    let square = |v: f64| hugoniot(law, rho0, v) / (rho0 * (1.0 - v));
    let (mut low, mut high) = (0.55, 0.9);
    for _ in 0..200 {
        let third = (high - low) / 3.0;
        if square(low + third) < square(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    let v = 0.5 * (low + high);
    [v, hugoniot(law, rho0, v), square(v).sqrt()]
}

/// The constants of a table and its measured columns agree.
#[test]
fn detonations_have_the_speed_and_pressure_of_their_tables() {
    let all = explosives();
    assert_eq!(all.len(), 9);
    for (material, law) in all {
        let [v, pressure, speed] = chapman_jouguet(&law, material.reference_density);
        let name = &material.name;
        println!(
            "{name}: {:.1} m/s, {:.3} GPa, V {v:.4}",
            speed,
            1e-9 * pressure
        );
        assert!(
            (speed / law.detonation_velocity - 1.0).abs() < 1e-3,
            "{name} {speed}"
        );
        assert!(
            (pressure / law.cj_pressure - 1.0).abs() < 1.1e-3,
            "{name} {pressure}"
        );
        assert!((law.cj_volume(material.reference_density) / v - 1.0).abs() < 1.5e-3);
    }
}

/// Burnt at once.
fn burnt(material: &Material, density: f64, energy: f64) -> PointBatch {
    let mut point = PointBatch {
        density: [density; LANES],
        specific_energy: [energy; LANES],
        burn: [1.0; LANES],
        ..PointBatch::ZERO
    };
    material.update(&mut point, 0.0);
    point
}

/// From the state of Chapman and Jouguet to twenty times the volume in small steps without heat: the law's own isentrope
/// `A exp(−R₁ V) + B exp(−R₂ V) + C V^{−(1 + ω)}`, and the sound speed is its slope.
#[test]
fn products_expand_along_their_isentrope() {
    for (material, law) in explosives() {
        let rho0 = material.reference_density;
        let [first, pressure, _] = chapman_jouguet(&law, rho0);
        let terms = |v: f64| law.a * (-law.r1 * v).exp() + law.b * (-law.r2 * v).exp();
        let c = (pressure - terms(first)) * first.powf(1.0 + law.omega);
        let isentrope = |v: f64| terms(v) + c * v.powf(-1.0 - law.omega);
        let mut energy = law.e0 + 0.5 * pressure * (1.0 - first) / rho0;
        let (mut v, steps) = (first, 20_000);
        let factor = (20.0 / first).powf(1.0 / f64::from(steps));
        for _ in 0..steps {
            let (middle, next) = (v * factor.sqrt(), v * factor);
            // Midpoint rule.
            let half =
                energy - burnt(&material, rho0 / v, energy).pressure[0] * (middle - v) / rho0;
            energy -= burnt(&material, rho0 / middle, half).pressure[0] * (next - v) / rho0;
            v = next;
        }
        let point = burnt(&material, rho0 / v, energy);
        let found = point.pressure[0];
        assert!(
            (found / isentrope(v) - 1.0).abs() < 1e-5,
            "{}: {found}",
            material.name
        );
        // At the density of the unburnt matter, where no floor of the sound speed acts.
        let v = 1.0;
        let internal =
            (isentrope(v) - law.response(rho0, rho0 / v, 0.0).pressure) * v / (law.omega * rho0);
        let speed = burnt(&material, rho0 / v, internal).sound_speed[0];
        let slope = (isentrope(v * (1.0 + 1e-6)) - isentrope(v * (1.0 - 1e-6))) / (2e-6 * v);
        let exact = (-slope * v * v / rho0).sqrt();
        assert!(
            (speed / exact - 1.0).abs() < 1e-6,
            "{}: {speed} {exact}",
            material.name
        );
    }
}

/// A point burns from its lighting time on, over the width of its front, and stays burnt.
#[test]
fn points_burn_as_the_front_passes() {
    let material = library::find("tnt").unwrap();
    let Eos::Jwl(law) = material.eos else {
        panic!()
    };
    let rho0 = material.reference_density;
    let size = 1e-4;
    let mut point = PointBatch {
        density: [rho0; LANES],
        specific_energy: [law.e0; LANES],
        lighting_time: [1e-7; LANES],
        mass: [rho0 * size * size * size; LANES],
        ..PointBatch::ZERO
    };
    let dt = 1e-9;
    let width = law.width * size / law.detonation_velocity;
    for n in 1..=200 {
        material.update(&mut point, dt);
        let since = f64::from(n) * dt - 1e-7;
        let share = (since / width).clamp(0.0, 1.0);
        assert!(
            (point.burn[0] - share).abs() < 1e-9,
            "{n}: {} {share}",
            point.burn[0]
        );
        let products = law.response(rho0, rho0, law.e0).pressure;
        assert!((point.pressure[0] - share * products).abs() < 1e-6 * products);
        assert!(
            point.sound_speed[0] > 3000.0,
            "steps are short before the front"
        );
    }
    let before = point;
    material.update(&mut point, 0.0);
    assert_eq!(
        (point.burn, point.lighting_time),
        (before.burn, before.lighting_time)
    );
    assert_eq!(point.pressure, before.pressure);
}

/// Without a detonation nothing burns, but by compression towards the state of Chapman and Jouguet.
#[test]
fn compression_burns_what_may_burn_by_it() {
    for burn in [Burn::Programmed, Burn::Compression, Burn::Either] {
        let mut material = library::find("lx-14").unwrap();
        let Eos::Jwl(law) = &mut material.eos else {
            panic!()
        };
        law.burn = burn;
        law.bulk_modulus = 10e9;
        let law = *law;
        let rho0 = material.reference_density;
        let at = |v: f64| {
            let mut point = PointBatch {
                density: [rho0 / v; LANES],
                specific_energy: [law.e0; LANES],
                lighting_time: [UNLIT; LANES],
                mass: [1e-9; LANES],
                ..PointBatch::ZERO
            };
            material.update(&mut point, 1e-9);
            point
        };
        let end = law.cj_volume(rho0);
        for share in [0.0, 0.3, 1.0, 1.5] {
            let v = 1.0 - share * (1.0 - end);
            let point = at(v);
            let exact = if burn == Burn::Programmed {
                0.0
            } else {
                share.min(1.0)
            };
            assert!((point.burn[0] - exact).abs() < 1e-12, "{burn:?} {share}");
            let unburnt = 10e9 * (1.0 / v - 1.0);
            let products = law.response(rho0, rho0 / v, law.e0).pressure;
            let pressure = exact * products + (1.0 - exact) * unburnt;
            assert!((point.pressure[0] - pressure).abs() < 1e-9 * products);
        }
        assert_eq!(at(1.2).pressure[0], 0.0, "unburnt matter bears no tension");
    }
}
