//! Spall at a point: failure with memory, and what it releases.
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]

use crate::support::{batch, equivalent, material, set_gradient, step};
use material::{
    AfterSpall, Effect, Elastic, Eos, LANES, Linear, LinearForm, Material, PointBatch, Spall,
    Strength, Value, library,
};
use nalgebra::Matrix3;

const RHO: f64 = 2700.0;
const K: f64 = 75e9;
const G: f64 = 27e9;
const LIMIT: f64 = -1.2e9;
const MODES: [AfterSpall; 3] = [AfterSpall::Failed, AfterSpall::Recompacts, AfterSpall::Hold];

/// Linear elastic metal.
fn metal(after: AfterSpall) -> Material {
    let eos = Eos::Linear(Linear {
        bulk_modulus: K,
        form: LinearForm::Logarithmic,
    });
    let mut metal = material(RHO, eos, Strength::Elastic(Elastic { shear_modulus: G }));
    metal.failure.spall = Some(Spall {
        pressure: LIMIT,
        after,
    });
    metal
}

/// One step of uniaxial strain, with this increment of the logarithmic strain.
fn strain(metal: &Material, points: &mut PointBatch, increment: f64) {
    // (1 + x)/(1 − x) of the midpoint rule is the exponential of `increment`.
    let x = libm::tanh(0.5 * increment);
    let l = Matrix3::new(2.0 * x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    step(metal, points, &l, 1.0);
}

/// Strain at which the pressure is the limit.
const BREAK: f64 = -LIMIT / K;

#[test]
fn constants_tell_the_choice() {
    for (after, word) in MODES.into_iter().zip(["failed", "recompacts", "hold"]) {
        let constants = metal(after).constants();
        let found = |key: &str| constants.iter().find(|c| c.key == key).unwrap().value;
        assert_eq!(found("failure.spall.after"), Value::Word(word));
        assert_eq!(found("failure.spall.pressure"), Value::Number(LIMIT, "Pa"));
    }
}

/// Matter whose pressure the limit has held says so, also where nothing has opened its cracks: forks of a run ask for it.
#[test]
fn held_matter_counts_as_damaged() {
    let mut metal = metal(AfterSpall::Failed);
    metal.failure.options.fracture_energy = 1e4;
    metal.failure.options.effect = Effect::Scaled;
    let mut points = batch(RHO, 0.0);
    points.mass = [RHO * 1e-9; LANES];
    strain(&metal, &mut points, 0.99 * BREAK);
    assert_eq!(points.damage, [0.0; LANES]);
    // Beyond the limit, and at rest: what heat does without expansion.
    points.density = points.density.map(|density| density * (1.0 - 0.02 * BREAK));
    strain(&metal, &mut points, 0.0);
    assert_eq!(points.pressure, [LIMIT; LANES]);
    assert!(
        points
            .damage
            .iter()
            .all(|&damage| 0.0 < damage && damage < 1e-20)
    );
}

#[test]
fn stretched_beyond_the_limit_matter_lets_go_at_once() {
    let whole = |points: &PointBatch| points.damage == [0.0; LANES];
    for after in MODES {
        let metal = metal(after);
        let mut points = batch(RHO, 0.0);
        let steps = 100;
        for n in 1..steps {
            strain(&metal, &mut points, BREAK / f64::from(steps));
            let wanted = -K * BREAK * f64::from(n) / f64::from(steps);
            assert!((points.pressure[0] / wanted - 1.0).abs() < 1e-12);
            assert!(whole(&points) && points.failure_energy == [0.0; LANES]);
        }
        let speed = |modulus: f64, points: &PointBatch| (modulus / points.density[0]).sqrt();
        let longitudinal = speed(K + 4.0 / 3.0 * G, &points);
        assert!((points.sound_speed[0] / longitudinal - 1.0).abs() < 1e-12);
        strain(&metal, &mut points, 2.0 * BREAK / f64::from(steps));
        if after == AfterSpall::Hold {
            assert_eq!(points.pressure[3].to_bits(), LIMIT.to_bits());
            assert!(whole(&points) && points.failure_energy == [0.0; LANES]);
            assert!(equivalent(&points) > 0.9 * 2.0 * G * BREAK);
            continue;
        }
        assert_eq!(points.damage, [1.0; LANES]);
        assert_eq!(points.pressure, [0.0; LANES]);
        assert!(equivalent(&points) == 0.0);
        assert!((points.sound_speed[0] / speed(K, &points) - 1.0).abs() < 1e-12);
        // Log strain e in uniaxial strain holds ½ M e² (a volume of now). S is that of the sum of
        // increments 2 tanh(½ Δe), which are 1e-9 short of Δe.
        let e = BREAK * f64::from(steps + 1) / f64::from(steps);
        let wanted = 0.5 * (K + 4.0 / 3.0 * G) * e * e / points.density[0];
        let released = points.failure_energy[5];
        assert!(
            (released / wanted - 1.0).abs() < 1e-8,
            "{released} {wanted}"
        );
        // It is released once.
        for increment in [0.01, 0.05, -0.02, 0.3] {
            strain(&metal, &mut points, increment);
            assert_eq!(points.failure_energy[5].to_bits(), released.to_bits());
            assert!(points.pressure[2] == 0.0 && equivalent(&points) == 0.0);
        }
    }
}

#[test]
fn recompacted_matter_is_whole_again_or_only_bears_pressure() {
    for after in [AfterSpall::Failed, AfterSpall::Recompacts] {
        let metal = metal(after);
        let mut points = batch(RHO, 0.0);
        strain(&metal, &mut points, 1.01 * BREAK);
        assert_eq!(points.damage, [1.0; LANES]);
        // Voids close at the reference density; from there on it is as stiff as before.
        strain(&metal, &mut points, -1.01 * BREAK);
        let mut pressed = 0.0;
        for _ in 0..30 {
            strain(&metal, &mut points, -0.05 * BREAK);
            pressed += 0.05 * BREAK;
            let (p, wanted) = (points.pressure[1], K * pressed);
            assert!((p / wanted - 1.0).abs() < 1e-9, "{p} {wanted}");
            let recovered = after == AfterSpall::Recompacts && p >= -LIMIT;
            assert_eq!(points.damage[1] == 0.0, recovered, "{after:?} at {p}");
            if !recovered {
                assert!(equivalent(&points) == 0.0);
            }
        }
        let sheared = equivalent(&points) / (2.0 * G * (pressed - BREAK));
        assert_eq!(sheared > 0.85, after == AfterSpall::Recompacts, "{sheared}");
        // What is whole bears tension.
        strain(&metal, &mut points, pressed + 0.9 * BREAK);
        let p = points.pressure[1];
        if after == AfterSpall::Recompacts {
            assert!((p / (0.9 * LIMIT) - 1.0).abs() < 1e-9, "{p}");
        } else {
            assert!(p == 0.0);
        }
    }
}

/// Vapour has pressure at any density, and stays what it is.
#[test]
fn pressure_without_density_recovers_nothing() {
    let mut metal = library::find("aluminium-tillotson").unwrap();
    metal.failure.spall = Some(Spall {
        pressure: LIMIT,
        after: AfterSpall::Recompacts,
    });
    let mut points = batch(0.9 * metal.reference_density, 0.0);
    metal.update(&mut points, 1e-9);
    assert_eq!(points.damage, [1.0; LANES]);
    points.specific_energy = [4e7; LANES];
    metal.update(&mut points, 1e-9);
    assert!(points.pressure[0] > -LIMIT && points.damage == [1.0; LANES]);
    points.density = [metal.reference_density; LANES];
    metal.update(&mut points, 1e-9);
    assert_eq!(points.damage, [0.0; LANES]);
}

/// Between failure and recovery lies a change of pressure of twice the limit: what swings by less
/// switches at most once, what swings by more switches twice in each cycle and releases as much
/// each time.
#[test]
fn noise_switches_nothing() {
    for (amplitude, switches) in [(0.9, 0), (1.1, 19)] {
        let metal = metal(AfterSpall::Recompacts);
        let mut points = batch(RHO, 0.0);
        let (mut seen, mut last) = (0, 0.0);
        let (steps, cycles) = (200, 10);
        let place = |n: i32| {
            let phase = f64::from(n) / f64::from(steps) * std::f64::consts::TAU;
            amplitude * BREAK * libm::sin(phase)
        };
        let mut energies = Vec::new();
        for n in 1..=steps * cycles {
            let energy = points.failure_energy[4];
            strain(&metal, &mut points, place(n) - place(n - 1));
            if points.damage[4].to_bits() != f64::to_bits(last) {
                seen += 1;
                last = points.damage[4];
                if last > 0.0 {
                    energies.push(points.failure_energy[4] - energy);
                }
            }
        }
        assert!(seen == switches || seen == switches + 1, "{seen}");
        // The first time it has not been sheared while it was failed.
        for pair in energies[1.min(energies.len())..].windows(2) {
            assert!((pair[1] / pair[0] - 1.0).abs() < 1e-6, "{energies:?}");
        }
    }
}

/// All strengths.
fn strengths() -> Vec<Material> {
    ["aluminium-2024", "rubber", "water"]
        .into_iter()
        .chain(["copper-johnson-cook", "copper-steinberg-guinan"])
        .map(|name| library::find(name).unwrap())
        .collect()
}

#[test]
fn failed_matter_of_any_strength_has_no_shear_and_counts_no_plastic_strain() {
    for mut material in strengths() {
        let modulus = material.eos.bulk_modulus(material.reference_density);
        material.failure.spall = Some(Spall {
            pressure: -1e-3 * modulus,
            after: AfterSpall::Failed,
        });
        let mut points = batch(material.reference_density, 0.0);
        let l = Matrix3::new(1.0, 0.5, 0.0, -0.2, 0.3, 0.1, 0.0, 0.4, 0.2);
        let dt = 1e-4;
        let mut failed = false;
        for _ in 0..30 {
            let before = points.plastic_strain;
            step(&material, &mut points, &l, dt);
            if failed {
                assert_eq!(points.plastic_strain, before, "{}", material.name);
            }
            failed = points.damage == [1.0; LANES];
            if failed {
                assert!(equivalent(&points) == 0.0, "{}", material.name);
                assert!(points.pressure == [0.0; LANES], "{}", material.name);
            }
        }
        assert!(failed, "{}", material.name);
        // Pressure it bears.
        points.density = [1.05 * material.reference_density; LANES];
        step(&material, &mut points, &l, dt);
        assert!(points.pressure[0] > 0.01 * modulus && equivalent(&points) == 0.0);
        // Nor does a step of no length bring shear.
        material.update(&mut points, 0.0);
        assert!(equivalent(&points) == 0.0, "{}", material.name);
    }
}

#[test]
fn a_step_of_no_length_changes_no_state() {
    for after in MODES {
        let metal = metal(after);
        for density in [0.95 * RHO, 1.1 * RHO] {
            for damage in [0.0, 1.0] {
                let mut points = batch(density, 0.0);
                points.damage = [damage; LANES];
                if damage < 1.0 {
                    points.deviatoric_stress[3] = [1e8; LANES];
                }
                let before = points;
                metal.update(&mut points, 0.0);
                assert_eq!(points.damage, before.damage);
                assert_eq!(points.failure_energy, before.failure_energy);
                assert_eq!(points.deviatoric_stress, before.deviatoric_stress);
                let bears = damage < 1.0 || after == AfterSpall::Hold;
                assert!(bears || points.pressure[0] >= 0.0);
            }
        }
    }
}

/// What a lane comes to does not depend on what others hold.
#[test]
fn lanes_do_not_meet() {
    for after in MODES {
        for strength in strengths() {
            let mut metal = strength;
            metal.failure.spall = Some(Spall {
                pressure: LIMIT,
                after,
            });
            let rho = metal.reference_density;
            let mut mixed = batch(rho, 1e3);
            let states = [0.9, 0.99, 1.0, 1.001, 1.01, 1.1, 1.5, 0.5];
            for (k, ratio) in states.into_iter().enumerate() {
                mixed.density[k] = rho * ratio;
                mixed.damage[k] = if k % 3 == 1 { 1.0 } else { 0.0 };
                mixed.deviatoric_stress[3][k] = if k % 3 == 1 { 0.0 } else { 1e7 };
            }
            set_gradient(&mut mixed, &Matrix3::from_element(1e3));
            for k in 0..LANES {
                let mut alone = mixed;
                let same = |lanes: &mut [f64; LANES]| *lanes = [lanes[k]; LANES];
                same(&mut alone.density);
                same(&mut alone.damage);
                same(&mut alone.deviatoric_stress[3]);
                metal.update(&mut alone, 1e-9);
                let mut all = mixed;
                metal.update(&mut all, 1e-9);
                let seen = |points: &PointBatch| {
                    [
                        points.pressure[k],
                        points.damage[k],
                        points.failure_energy[k],
                        points.deviatoric_stress[3][k],
                        points.plastic_strain[k],
                        points.sound_speed[k],
                    ]
                    .map(f64::to_bits)
                };
                assert_eq!(seen(&all), seen(&alone), "{} {after:?}", metal.name);
            }
        }
    }
}

#[test]
fn not_a_number_stays_one_and_fails_nobody_else() {
    for after in MODES {
        let metal = metal(after);
        let mut points = batch(0.99 * RHO, 0.0);
        points.density[5] = 0.9 * RHO;
        points.density[2] = f64::NAN;
        points.deviatoric_stress[3][5] = f64::NAN;
        (points.damage[7], points.density[7]) = (1.0, f64::NAN);
        metal.update(&mut points, 1e-9);
        for k in 0..LANES {
            assert_eq!(points.pressure[k].is_nan(), k == 2 || k == 7, "lane {k}");
            assert_eq!(points.deviatoric_stress[3][k].is_nan(), k == 5, "lane {k}");
            let failed = k == 7 || k == 5 && after != AfterSpall::Hold;
            assert_eq!(points.damage[k] >= 1.0, failed, "lane {k}");
        }
    }
}

/// Failed matter is pulled apart by a factor of a thousand: its density stays at a tenth, and grows from
/// there when it is pressed together again. What is held goes on expanding.
#[test]
fn spray_expands_to_a_tenth() {
    for after in MODES {
        let metal = metal(after);
        let mut points = batch(RHO, 0.0);
        for _ in 0..100 {
            strain(&metal, &mut points, 0.01 * 1000.0_f64.ln());
        }
        let spray = if after == AfterSpall::Hold {
            0.001
        } else {
            0.1
        };
        let found = points.density[0] / (spray * RHO);
        assert!((found - 1.0).abs() < 1e-9, "{after:?}: {found}");
        if after == AfterSpall::Hold {
            continue;
        }
        assert_eq!(points.pressure, [0.0; LANES]);
        for _ in 0..10 {
            strain(&metal, &mut points, -0.1 * 5.0_f64.ln());
        }
        let found = points.density[0] / (0.5 * RHO);
        assert!((found - 1.0).abs() < 1e-9, "{after:?}: {found}");
    }
}
