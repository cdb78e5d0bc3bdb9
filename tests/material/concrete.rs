//! Concrete of the library: its crush curve, unloading, damage by crushed pores, energy of a cycle, strength and sound.

use crate::support::{equivalent, set_gradient, step};
use material::{
    Compaction, HolmquistJohnsonCookCompaction, LANES, Material, PointBatch, Porosity, Rest,
    library,
};
use nalgebra::{Matrix3, Vector3};

/// Density of the whole (kg/m³), `[μ_crush, μ_lock]`, `[p_crush, p_lock]` (Pa), K₁ (Pa) of Holmquist, Johnson & Cook (1993).
const RHO: f64 = 2440.0;
const STRAINS: [f64; 2] = [0.001, 0.1];
const PRESSURES: [f64; 2] = [16e6, 0.8e9];
const K1: f64 = 85e9;

fn concrete() -> Material {
    library::find("concrete-48").unwrap()
}

/// Pressure (Pa) of concrete without pores.
fn solid(mu: f64) -> f64 {
    let dense = (mu - STRAINS[1]) / (1.0 + STRAINS[1]);
    K1 * dense - 171e9 * dense * dense + 208e9 * dense * dense * dense
}

/// `μ_plock`, by halves.
fn locked() -> f64 {
    let [mut low, mut high] = [STRAINS[1], 2.0 * STRAINS[1]];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if solid(middle) < PRESSURES[1] {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Pressure (Pa) of the first compression to `mu`, and the modulus (Pa) of release from there.
fn loading(mu: f64) -> [f64; 2] {
    let elastic = PRESSURES[0] / STRAINS[0];
    let x = (mu - STRAINS[0]) / (locked() - STRAINS[0]);
    if x <= 0.0 {
        [elastic * mu, elastic]
    } else if x < 1.0 {
        let pressure = PRESSURES[0] + x * (PRESSURES[1] - PRESSURES[0]);
        [pressure, elastic + x * (K1 - elastic)]
    } else {
        [solid(mu), K1]
    }
}

/// Isotropic compression to `mu` in one step.
fn press(concrete: &Material, points: &mut PointBatch, mu: f64) -> f64 {
    let before = points.density[0].max(1.0) / RHO;
    let rate = Matrix3::identity() * (-((1.0 + mu) / before).ln() / 3e-6);
    set_gradient(points, &rate);
    points.density = [RHO * (1.0 + mu); LANES];
    concrete.update(points, 1e-6);
    points.pressure[3]
}

fn virgin() -> PointBatch {
    PointBatch {
        density: [RHO; LANES],
        ..PointBatch::ZERO
    }
}

#[test]
fn pores_crush_along_their_curve_and_unload_along_lines() {
    let concrete = concrete();
    assert!((concrete.reference_density / RHO - 1.0).abs() < 1e-15);
    assert!(Rest::of(&concrete).is_some());
    for most in [0.0005, 0.001, 0.004, 0.03, 0.08, 0.11, 0.15, 0.2] {
        let mut points = virgin();
        let mut mu: f64 = 0.0;
        while mu < most {
            mu = f64::min(mu + 0.0005, most);
            let [exact, _] = loading(mu);
            let found = press(&concrete, &mut points, mu);
            assert!((found / exact - 1.0).abs() < 1e-9, "{mu}: {found} {exact}");
        }
        // Back to a fifth of the pressure, and up again.
        let [top, modulus] = loading(most);
        for share in [0.8, 0.5, 0.2, 0.7, 1.0] {
            let (mu, exact) = if most > locked() {
                let mu = STRAINS[1] + share * (most - STRAINS[1]);
                (mu, solid(mu))
            } else {
                (most - (1.0 - share) * top / modulus, share * top)
            };
            let found = press(&concrete, &mut points, mu);
            assert!(
                (found / exact - 1.0).abs() < 1e-9,
                "{most} {share}: {found} {exact}"
            );
        }
        // Beyond it, the first compression goes on.
        let found = press(&concrete, &mut points, most + 0.01);
        assert!(
            (found / loading(most + 0.01)[0] - 1.0).abs() < 1e-9,
            "{most}"
        );
    }
}

/// Whatever the constants round to.
#[test]
fn virgin_concrete_has_no_pressure_to_the_bit() {
    for n in 1..50 {
        let mut concrete = concrete();
        let distension = 1.0 + 0.003 * f64::from(n);
        let law = HolmquistJohnsonCookCompaction {
            crush_pressure: 0.7e6 * f64::from(n),
            crush_strain: 0.000_13 * f64::from(n),
            lock_pressure: 0.8e9,
        };
        let law = Compaction::HolmquistJohnsonCookCompaction(law);
        let pores = Porosity::new(distension, law, 2700.0, &concrete.eos);
        concrete.reference_density = pores.density;
        concrete.porosity = Some(pores);
        assert_eq!(
            concrete.virgin(concrete.reference_density, 0.0).pressure,
            0.0
        );
    }
}

/// Tension ends at `T (1 − D)`, and what is torn bears again at the density without pressure.
#[test]
fn torn_concrete_bears_its_tension_alone() {
    for most in [0.0, 0.08, 0.2] {
        let concrete = concrete();
        let mut points = virgin();
        press(&concrete, &mut points, most);
        let found = press(&concrete, &mut points, -0.01);
        let exact = -4e6 * (1.0 - points.damage[0]);
        assert!((found - exact).abs() < 1.0, "{most}: {found} {exact}");
        if most == 0.2 {
            assert_eq!(points.compaction[0], 1.0);
        }
        let (mu, exact) = if most > locked() {
            (0.15, solid(0.15))
        } else {
            (most + 1e-4, loading(most + 1e-4)[0])
        };
        let again = press(&concrete, &mut points, mu);
        assert!(
            (again / exact - 1.0).abs() < 1e-9,
            "{most}: {again} {exact}"
        );
    }
}

/// `D = μ_p/ε_f`, with a failure strain that follows the pressure: the sum over the steps by hand.
#[test]
fn crushed_pores_are_damage() {
    let concrete = concrete();
    let mut points = virgin();
    let (mut exact, mut before, mut mu) = (0.0, 0.0, 0.0);
    while mu < 0.1 {
        mu += 0.0005;
        let [pressure, modulus] = loading(mu);
        let permanent = mu - pressure / modulus;
        let strain = f64::max(0.04 * (pressure + 4e6) / 48e6, 0.01);
        exact += f64::max(permanent - before, 0.0) / strain;
        before = permanent;
        press(&concrete, &mut points, mu);
        let found = points.damage[4];
        assert!(
            (found - exact.min(1.0)).abs() < 1e-9,
            "{mu}: {found} {exact}"
        );
        assert_eq!(points.plastic_strain[4], 0.0);
    }
    assert!(exact > 0.1);
    // No pore opens again, and none crushes twice.
    let damage = points.damage[4];
    press(&concrete, &mut points, 0.09);
    press(&concrete, &mut points, 0.1);
    assert_eq!(points.damage[4], damage);
}

/// Integral of `p dρ/ρ²` (J/kg) over a straight line of the pressure, from `a` to `b`.
fn work(from: [f64; 2], to: [f64; 2]) -> f64 {
    let slope = (to[1] - from[1]) / (to[0] - from[0]);
    let level = from[1] - slope * from[0];
    let at = |mu: f64| -(level - slope) / (1.0 + mu) + slope * (1.0 + mu).ln();
    (at(to[0]) - at(from[0])) / RHO
}

#[test]
fn a_cycle_takes_the_energy_between_its_lines_once() {
    let concrete = concrete();
    let most = 0.06;
    let [top, modulus] = loading(most);
    let free = most - top / modulus;
    let crush = [STRAINS[0], PRESSURES[0]];
    let exact = work([0.0, 0.0], crush) + work(crush, [most, top]) + work([most, top], [free, 0.0]);
    let mut points = virgin();
    let (mut last, mut energy) = ([0.0, 0.0], 0.0);
    let mut go = |points: &mut PointBatch, to: f64| {
        let (steps, from) = (2000, last[0]);
        for n in 1..=steps {
            let mu = from + (to - from) * f64::from(n) / f64::from(steps);
            let pressure = press(&concrete, points, mu);
            energy +=
                0.5 * (last[1] + pressure) * (mu - last[0]) / (RHO * (1.0 + mu) * (1.0 + last[0]));
            last = [mu, pressure];
        }
        energy
    };
    go(&mut points, most);
    let once = go(&mut points, free);
    assert!((once / exact - 1.0).abs() < 1e-4, "{once} {exact}");
    go(&mut points, most);
    let twice = go(&mut points, free);
    assert!((twice - once).abs() < 1e-9 * once, "{once} {twice}");
}

/// Strength over the compressive strength at four pressures of virgin and crushed concrete.
#[test]
fn strength_follows_the_pressure_of_the_pores() {
    let mut concrete = concrete();
    concrete.failure.holmquist_johnson_cook = None;
    for mu in [0.0005, 0.01, 0.05, 0.15] {
        let [pressure, _] = loading(mu);
        let mut points = virgin();
        press(&concrete, &mut points, mu);
        let l = Matrix3::from_diagonal(&Vector3::new(-0.1, 0.05, 0.05));
        step(&concrete, &mut points, &l, 1.0);
        let normalised = f64::min(0.79 + 1.6 * libm::pow(pressure / 48e6, 0.61), 7.0);
        let found = equivalent(&points) / 48e6;
        assert!(
            (found - normalised).abs() < 1e-6,
            "{mu}: {found} {normalised}"
        );
    }
}

/// Sound is that of release, with the shear modulus, and never slower than that of virgin matter.
#[test]
fn sound_is_as_fast_as_release() {
    let concrete = concrete();
    for mu in [0.0, 0.0005, 0.03, 0.08, 0.11] {
        let mut points = virgin();
        press(&concrete, &mut points, mu);
        let [_, modulus] = loading(mu);
        let stiff = modulus / RHO + 4.0 / 3.0 * 14.86e9 / (RHO * (1.0 + mu));
        let found = points.sound_speed[1];
        assert!(
            found * found > 0.999 * stiff,
            "{mu}: {found} {}",
            stiff.sqrt()
        );
    }
    let mut points = virgin();
    press(&concrete, &mut points, 0.2);
    let slope = (solid(0.2 + 1e-6) - solid(0.2 - 1e-6)) / 2e-6 / RHO;
    assert!(points.sound_speed[1] * points.sound_speed[1] > slope);
}
