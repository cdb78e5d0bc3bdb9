//! Laws of failure at a point: Johnson and Cook's damage, plastic strain, principal stress; what they
//! share: fading, softening by fracture energy, scatter, melting.
#![allow(clippy::many_single_char_names, reason = "formulas as on paper")]
#![allow(clippy::cast_precision_loss, reason = "counts")]

use crate::support::{batch, equivalent, material, step, stress};
use material::{
    AfterSpall, Coupling, Effect, Elastic, Eos, JohnsonCookFailure, LANES, Linear, LinearForm,
    Material, Molten, PlasticStrain, PrincipalStress, RateForm, Spall, Strength, Thermal,
    ThermalConstants, VonMises, library,
};
use nalgebra::Matrix3;

const RHO: f64 = 2700.0;
const K: f64 = 75e9;
const G: f64 = 27e9;
const YIELD: f64 = 0.3e9;

fn linear(bulk_modulus: f64) -> Eos {
    Eos::Linear(Linear {
        bulk_modulus,
        form: LinearForm::Logarithmic,
    })
}

/// Perfectly plastic metal.
fn metal() -> Material {
    let law = VonMises {
        shear_modulus: G,
        yield_stress: YIELD,
        hardening_modulus: 0.0,
    };
    material(RHO, linear(K), Strength::VonMises(law))
}

/// D₁ to D₅, reference rate.
fn ductile([d1, d2, d3, d4, d5]: [f64; 5]) -> JohnsonCookFailure {
    JohnsonCookFailure {
        d1,
        d2,
        d3,
        d4,
        d5,
        reference_rate: 1.0,
        rate_form: RateForm::Logarithm,
        least_strain: 1e-4,
        spall_stress: 0.0,
        coupling: Coupling::Uncoupled,
    }
}

const HEAT: ThermalConstants = ThermalConstants {
    specific_heat: 900.0,
    reference_temperature: 300.0,
    melting_temperature: Some(900.0),
    taylor_quinney: 1.0,
};

const AL_2024_T351: [f64; 5] = [0.13, 0.13, -1.5, 0.011, 0.0];
const AL_6061: [f64; 5] = [-0.77, 1.45, -0.47, 0.0, 1.60];

/// Failure strains at the triaxialities −1/3, 0, 1/3, 1, worked out apart from the program; beyond they stay.
#[test]
fn failure_strains_are_those_of_the_published_constants() {
    let table: [([f64; 5], [f64; 4]); 7] = [
        (AL_2024_T351, [0.3443, 0.2600, 0.2088, 0.1590]),
        (
            [0.112, 0.123, -1.5, 0.007, 0.0],
            [0.3148, 0.2350, 0.1866, 0.1394],
        ),
        (AL_6061, [0.9259, 0.6800, 0.4697, 0.1363]),
        (
            [0.54, 4.89, -3.03, 0.014, 1.12],
            [13.97, 5.430, 2.321, 0.7763],
        ),
        (
            [0.05, 3.44, -2.12, 0.002, 0.61],
            [7.024, 3.490, 1.747, 0.4629],
        ),
        (
            [0.0705, 1.732, -0.54, -0.0123, 0.0],
            [2.144, 1.8025, 1.517, 1.080],
        ),
        (
            [-0.09, 0.25, -0.5, 0.014, 3.87],
            [0.2053, 0.1600, 0.1216, 0.0616],
        ),
    ];
    for (constants, strains) in table {
        let law = ductile(constants);
        for (eta, wanted) in [-1.0 / 3.0, 0.0, 1.0 / 3.0, 1.0].into_iter().zip(strains) {
            let q = 0.7e9;
            let found = law.failure_strain([-eta * q, q], 1.0, 300.0, &HEAT);
            assert!(
                (found / wanted - 1.0).abs() < 1e-3,
                "{constants:?} at {eta}: {found}"
            );
        }
        // Tension breaks sooner, and compression beyond the uniaxial one never.
        let at = |p: f64| law.failure_strain([p, 1e9], 1.0, 300.0, &HEAT);
        assert!(at(-1e9) < at(0.0) && at(0.0) < at(0.3e9));
        assert_eq!(at(0.34e9), f64::INFINITY);
        assert_eq!([at(-1.5e9), at(-3e9)], [at(-1e9); 2]);
        assert_eq!(law.failure_strain([-1e9, 0.0], 1.0, 300.0, &HEAT), at(-1e9));
    }
}

#[test]
fn rate_heat_and_high_tension_move_the_failure_strain() {
    let mut law = ductile([0.05, 3.44, -2.12, 0.002, 0.61]);
    let at = |law: &JohnsonCookFailure, eta: f64, rate: f64, t: f64| {
        law.failure_strain([-eta * 1e9, 1e9], rate, t, &HEAT)
    };
    let plain = at(&law, 0.0, 1.0, 300.0);
    assert!((at(&law, 0.0, 1e4, 300.0) / plain - (1.0 + 0.002 * 1e4_f64.ln())).abs() < 1e-12);
    assert_eq!(at(&law, 0.0, 1e-4, 300.0), plain);
    assert!((at(&law, 0.0, 1.0, 600.0) / plain - 1.305).abs() < 1e-12);
    assert!((at(&law, 0.0, 1.0, 5000.0) / plain - 1.61).abs() < 1e-12);
    assert_eq!(at(&law, 0.0, 1.0, 0.0), plain);
    law.rate_form = RateForm::Power;
    assert!((at(&law, 0.0, 1e4, 300.0) / plain - 10_001_f64.powf(0.002)).abs() < 1e-12);
    // From a triaxiality of one to the spall stress, linearly in the mean tension.
    law.rate_form = RateForm::Logarithm;
    law.spall_stress = 2.5e9;
    let [first, middle, last] = [1.0, 1.75, 2.5].map(|eta| at(&law, eta, 1.0, 300.0));
    assert!((first - 0.4629).abs() < 1e-4);
    assert!((middle - 0.5 * (first + 1e-4)).abs() < 1e-12 && last == 1e-4);
    assert_eq!(at(&law, 3.0, 1.0, 300.0), 1e-4);
}

/// Velocity gradient of a bar that is drawn along x and keeps its volume.
fn drawn(rate: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&nalgebra::Vector3::new(rate, -0.5 * rate, -0.5 * rate))
}

#[test]
fn damage_adds_up_to_one_at_the_failure_strain() {
    for (constants, factor) in [(AL_2024_T351, 1.0 + 0.011 * 1e4_f64.ln()), (AL_6061, 1.0)] {
        let mut metal = metal();
        metal.failure.johnson_cook = Some(ductile([
            constants[0],
            constants[1],
            constants[2],
            constants[3],
            0.0,
        ]));
        let mut points = batch(RHO, 0.0);
        // Isochoric flow has no pressure: η = 0.
        let strain = (constants[0] + constants[1]) * factor;
        let (dt, rate) = (1e-8, 1e4);
        let mut steps = 0;
        while points.damage[0] < 1.0 {
            step(&metal, &mut points, &drawn(rate), dt);
            steps += 1;
            assert!(steps < 20_000);
            if points.damage[0] < 1.0 {
                assert!(
                    (equivalent(&points) / YIELD - 1.0).abs() < 1e-9
                        || points.plastic_strain[0] == 0.0
                );
            }
        }
        assert!(
            (points.plastic_strain[0] / strain - 1.0).abs() < 1e-3,
            "{}",
            points.plastic_strain[0]
        );
        assert_eq!(points.damage, [1.0; LANES]);
        assert_eq!(equivalent(&points), 0.0);
        // The elastic energy of the yield stress.
        let held = YIELD * YIELD / (6.0 * G) / points.density[0];
        assert!((points.failure_energy[3] / held - 1.0).abs() < 1e-6);
    }
}

#[test]
fn compression_does_no_damage() {
    let mut metal = metal();
    metal.failure.johnson_cook = Some(ductile(AL_2024_T351));
    let mut points = batch(RHO, 0.0);
    for _ in 0..100 {
        step(
            &metal,
            &mut points,
            &Matrix3::from_diagonal(&nalgebra::Vector3::new(-1e4, 0.0, 0.0)),
            1e-7,
        );
    }
    assert!(points.plastic_strain[0] > 0.05 && points.damage == [0.0; LANES]);
}

#[test]
fn a_plastic_strain_is_the_limit_and_scatters_by_particle() {
    let mut metal = metal();
    metal.failure.plastic_strain = Some(PlasticStrain { limit: 0.2 });
    let strains = |metal: &Material, first: u64| {
        let mut points = batch(RHO, 0.0);
        points.id = std::array::from_fn(|k| first + k as u64);
        let mut strains = [0.0; LANES];
        for _ in 0..1000 {
            let before = points;
            step(metal, &mut points, &drawn(1e4), 1e-7);
            for k in 0..LANES {
                if points.damage[k] >= 1.0 && before.damage[k] < 1.0 {
                    strains[k] = points.plastic_strain[k];
                }
            }
        }
        strains
    };
    assert!(strains(&metal, 0).iter().all(|s| (s - 0.2).abs() < 1.1e-3));
    metal.failure.options.scatter = 8.0;
    let mut all: Vec<f64> = (0..40).flat_map(|n| strains(&metal, 8 * n)).collect();
    assert_eq!(all[8..16], strains(&metal, 8));
    all.sort_by(f64::total_cmp);
    // Weibull's distribution of modulus eight: its median, and the share below .8 of it.
    let below = |x: f64| all.iter().filter(|s| **s < 0.2 * x).count() as f64 / all.len() as f64;
    assert!((below(1.0) - 0.5).abs() < 3.0 * 0.5 / (all.len() as f64).sqrt());
    let wanted = 1.0 - 0.5_f64.powf(0.8_f64.powi(8));
    assert!(
        (below(0.8) - wanted).abs() < 3.0 * (wanted / all.len() as f64).sqrt(),
        "{}",
        below(0.8)
    );
}

/// Elastic glass.
fn brittle(shear_modulus: f64, bulk_modulus: f64, density: f64) -> Material {
    material(
        density,
        linear(bulk_modulus),
        Strength::Elastic(Elastic { shear_modulus }),
    )
}

#[test]
fn the_largest_principal_stress_breaks_or_is_released() {
    let turned = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1).into_inner();
    for effect in [Effect::StrengthLost, Effect::TensionLost] {
        let mut glass = brittle(G, K, RHO);
        glass.failure.principal_stress = Some(PrincipalStress { limit: 0.5e9 });
        glass.failure.options.effect = effect;
        let mut points = batch(RHO, 0.0);
        // Tension along one axis, compression along another.
        let l = turned
            * Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, -0.6, 0.0))
            * turned.transpose();
        let mut last = 0.0;
        while points.damage[0] < 1.0 {
            let total =
                stress(&points) - Matrix3::identity() * points.pressure[LANES - 1].max(-1e99);
            if points.pressure[0].is_finite() {
                last = total.symmetric_eigenvalues().max();
                assert!(last <= 0.5e9);
            }
            step(&glass, &mut points, &l, 1e-5);
        }
        assert!(last > 0.49e9);
        assert!(points.failure_energy[0] > 0.0);
        let total = stress(&points) - Matrix3::identity() * points.pressure[LANES - 1];
        let values = turned.transpose() * total * turned;
        if effect == Effect::StrengthLost {
            assert!(equivalent(&points) == 0.0 && points.pressure[0] >= 0.0);
        } else {
            // The compression stays, and nothing is pulled.
            assert!((values[(1, 1)] + 0.0626e9).abs() < 1e6, "{values}");
            assert!(total.symmetric_eigenvalues().max() < 1.0, "{values}");
            // It bears more of it.
            let before = values[(1, 1)];
            step(&glass, &mut points, &l, 1e-4);
            let total = stress(&points) - Matrix3::identity() * points.pressure[LANES - 1];
            let values = turned.transpose() * total * turned;
            assert!(values[(1, 1)] < before && total.symmetric_eigenvalues().max() < 1.0);
        }
    }
}

/// Tension, drawn until it has failed, takes the fracture energy over the size of the particle.
#[test]
fn softening_takes_the_fracture_energy() {
    let energy = 1e4;
    for size in [0.1e-3, 0.4e-3] {
        let mut metal = metal();
        metal.failure.spall = Some(Spall {
            pressure: -1e9,
            after: AfterSpall::Failed,
        });
        metal.failure.options.fracture_energy = energy;
        metal.failure.options.effect = Effect::Scaled;
        let mut points = batch(RHO, 0.0);
        points.mass = [RHO * size * size * size; LANES];
        let l = Matrix3::identity() * 1e4;
        let dt = 1e-9;
        let (mut work, mut onset) = (0.0, false);
        let mut tension = Vec::new();
        for n in 0.. {
            let before = points;
            step(&metal, &mut points, &l, dt);
            // At the mean of the stresses before and after.
            let p = 0.5 * (before.pressure[0] + points.pressure[0]);
            if onset && points.damage[0] < 1.0 {
                work -= p * 3e4 * dt;
                tension.push(-points.pressure[0]);
            }
            onset |= points.damage[0] > 0.0;
            if points.damage[0] >= 1.0 {
                break;
            }
            assert!(n < 1_000_000);
        }
        assert!(
            (work * size / energy - 1.0).abs() < 0.01,
            "{}",
            work * size / energy
        );
        // Linear in the opening, down to nothing.
        assert!(tension.windows(2).all(|w| w[1] < w[0]));
        assert!((tension[tension.len() / 2] / 0.5e9 - 1.0).abs() < 0.01);
        assert_eq!(points.pressure, [0.0; LANES]);
    }
}

/// Tension counts once where both a failure strain and the limit of tension have been reached.
#[test]
fn two_laws_take_the_fracture_energy_once() {
    let (energy, size) = (1e4, 0.2e-3);
    let mut metal = metal();
    metal.failure.spall = Some(Spall {
        pressure: -1e9,
        after: AfterSpall::Failed,
    });
    metal.failure.johnson_cook = Some(ductile([0.1, 0.0, 0.0, 0.0, 0.0]));
    metal.failure.options.fracture_energy = energy;
    metal.failure.options.effect = Effect::Scaled;
    let mut points = batch(RHO, 0.0);
    points.mass = [RHO * size * size * size; LANES];
    points.failure_onset = [1.0; LANES];
    points.pressure = [0.0; LANES];
    let dt = 1e-9;
    let mut work = 0.0;
    while points.damage[0] < 1.0 {
        let before = points.pressure[0];
        step(&metal, &mut points, &(Matrix3::identity() * 1e4), dt);
        work -= 0.5 * (before + points.pressure[0]) * 3e4 * dt;
        assert!(work < 1e12);
    }
    assert!(
        (work * size / energy - 1.0).abs() < 0.01,
        "{}",
        work * size / energy
    );
}

/// At the limit of tension expansion opens cracks. Shear does not, nor does tension below what damage
/// has left of the limit.
#[test]
fn shear_opens_no_cracks_of_spall() {
    let mut metal = metal();
    metal.failure.spall = Some(Spall {
        pressure: -1e9,
        after: AfterSpall::Failed,
    });
    metal.failure.options.fracture_energy = 1e4;
    metal.failure.options.effect = Effect::Scaled;
    let mut points = batch(RHO, 0.0);
    points.mass = [RHO * 1e-12; LANES];
    let (opens, closes) = (Matrix3::identity() * 1e4, Matrix3::identity() * -1e4);
    let mut shear = Matrix3::zeros();
    shear[(0, 1)] = 1e6;
    let dt = 1e-9;
    while points.damage[0] < 0.3 {
        step(&metal, &mut points, &opens, dt);
    }
    let damage = points.damage;
    for l in [shear, closes, shear] {
        for _ in 0..100 {
            step(&metal, &mut points, &l, dt);
        }
        assert_eq!(points.damage, damage);
    }
    assert!(points.plastic_strain[0] > 0.05);
}

/// Sheared beyond its failure strain, metal softens and takes the same energy; unloaded in between,
/// it is as soft as it was left.
#[test]
fn ductile_damage_softens_too() {
    let (energy, size) = (2e4, 0.2e-3);
    let mut metal = metal();
    metal.failure.johnson_cook = Some(ductile([0.1, 0.0, 0.0, 0.0, 0.0]));
    metal.failure.options.fracture_energy = energy;
    metal.failure.options.effect = Effect::Scaled;
    let mut points = batch(RHO, 0.0);
    points.mass = [RHO * size * size * size; LANES];
    let mut l = Matrix3::zeros();
    l[(0, 1)] = 1e4;
    let dt = 1e-8;
    let mut work = 0.0;
    while points.damage[0] < 1.0 {
        let before = stress(&points)[(0, 1)];
        step(&metal, &mut points, &l, dt);
        if points.failure_onset[0] >= 1.0 {
            work += 0.5 * (before + stress(&points)[(0, 1)]) * 1e4 * dt;
        } else {
            assert_eq!(points.damage[0], 0.0);
        }
        assert!(work < 1e12);
        if (0.4..0.6).contains(&points.damage[0]) {
            let kept = 1.0 - points.damage[0];
            assert!((equivalent(&points) / (YIELD * kept) - 1.0).abs() < 1e-2);
        }
    }
    assert!((points.plastic_strain[0] - 0.1) > 0.2);
    assert!(
        (work * size / energy - 1.0).abs() < 0.01,
        "{}",
        work * size / energy
    );
}

#[test]
fn molten_matter_fails_when_nothing_presses_it() {
    for molten in [Molten::Fails, Molten::Holds] {
        let mut metal = metal();
        metal.failure.johnson_cook = Some(ductile(AL_6061));
        metal.failure.options.molten = Some(molten);
        metal.thermal = Some(Thermal::new(HEAT, RHO, &metal.eos));
        let mut points = batch(1.05 * RHO, 0.0);
        points.specific_energy = [metal.energy(1.05 * RHO, 950.0).unwrap(); LANES];
        metal.update(&mut points, 1e-9);
        assert_eq!(points.damage, [0.0; LANES]);
        points.density = [0.99 * RHO; LANES];
        metal.update(&mut points, 1e-9);
        let fails = molten == Molten::Fails;
        assert_eq!(points.damage, [f64::from(u8::from(fails)); LANES]);
        assert_eq!(points.pressure[0] == 0.0, fails);
    }
}

/// The melting temperature is that of the strength where this has its own, and follows the density.
#[test]
fn matter_melts_where_its_strength_says() {
    let mut metal = library::find("copper-steinberg-guinan").unwrap();
    let rho = metal.reference_density;
    let Strength::SteinbergGuinan(law) = metal.strength.clone() else {
        panic!("of Steinberg and Guinan")
    };
    let melting = metal.melting_temperature(0.95 * rho, 0.0).unwrap();
    assert_eq!(melting, law.melting_temperature(0.95));
    metal.failure.spall = Some(Spall {
        pressure: -1e12,
        after: AfterSpall::Failed,
    });
    for (share, damage) in [(0.98, 0.0), (1.02, 1.0)] {
        let (mut density, temperature) = (0.95 * rho, share * melting);
        // Under some tension, and still at this density's own melting temperature.
        let pressure = |density: f64| {
            let energy = metal.energy(density, temperature).unwrap();
            metal.eos.at(rho, density, energy).pressure
        };
        while pressure(density) > -1e8 {
            density *= 0.999;
        }
        let share = temperature / law.melting_temperature(density / rho);
        let mut points = batch(density, metal.energy(density, temperature).unwrap());
        metal.update(&mut points, 1e-9);
        let expected = if share >= 1.0 { 1.0 } else { damage };
        assert_eq!(points.damage, [expected; LANES], "{share}");
    }
}

/// A material of which nothing else follows the temperature fails when molten, if that is said.
#[test]
fn what_is_said_of_molten_matter_holds_for_any_material() {
    for (molten, damage) in [(None, 0.0), (Some(Molten::Fails), 1.0)] {
        let mut metal = metal();
        metal.failure.spall = Some(Spall {
            pressure: -1e12,
            after: AfterSpall::Failed,
        });
        metal.failure.options.molten = molten;
        metal.thermal = Some(Thermal::new(HEAT, RHO, &metal.eos));
        let mut points = batch(0.99 * RHO, metal.energy(0.99 * RHO, 950.0).unwrap());
        metal.update(&mut points, 1e-9);
        assert_eq!(points.damage, [damage; LANES]);
    }
}

/// Where tension is high, the stated spall strength rules: each ductile material of the library bears
/// it in uniaxial strain and in all that is nearer to an equal pull from all sides.
#[test]
fn ductile_materials_bear_the_spall_strength_that_they_state() {
    let mut checked = 0;
    for name in library::names()
        .into_iter()
        .filter(|name| name.ends_with("-ductile"))
    {
        let material = library::find(name).unwrap();
        let Some(spall) = material.failure.spall else {
            continue;
        };
        for lateral in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let mut points = batch(material.reference_density, 0.0);
            points.mass = [material.reference_density * 0.2e-3_f64.powi(3); LANES];
            let l = nalgebra::Vector3::new(1e5, lateral * 1e5, lateral * 1e5);
            let mut least = 0.0_f64;
            while points.damage[0] < 1.0 {
                least = least.min(points.pressure[0]);
                step(&material, &mut points, &Matrix3::from_diagonal(&l), 2e-10);
            }
            let part = least / spall.pressure;
            assert!((0.99..=1.0).contains(&part), "{name} {lateral}: {part}");
        }
        checked += 1;
    }
    assert_eq!(checked, 8);
}

/// Coupled damage softens from the start. The strength `(1 − ε/ε_f)(Y₀ + H ε)` is at its maximum at
/// `ε = (ε_f − Y₀/H)/2`; from there on the fracture energy rules, less what the particle has taken by
/// then, of which damage so far leaves `(1 − D)²`.
#[test]
fn coupled_damage_softens_and_then_takes_the_fracture_energy() {
    let (failure, hardening, energy) = (1.0, 1e9, 2e5);
    for size in [0.2e-3, 1e-3] {
        let law = VonMises {
            shear_modulus: G,
            yield_stress: YIELD,
            hardening_modulus: hardening,
        };
        let mut metal = material(RHO, linear(K), Strength::VonMises(law));
        let mut coupled = ductile([failure, 0.0, 0.0, 0.0, 0.0]);
        coupled.coupling = Coupling::Coupled;
        metal.failure.johnson_cook = Some(coupled);
        metal.failure.options.fracture_energy = energy;
        metal.failure.options.effect = Effect::Scaled;
        let mut points = batch(RHO, 0.0);
        points.mass = [RHO * size * size * size; LANES];
        let mut l = Matrix3::zeros();
        l[(0, 1)] = 1e4;
        let dt = 2e-9;
        let (mut work, mut onset) = (0.0, None);
        while points.damage[0] < 1.0 {
            let before = stress(&points)[(0, 1)];
            step(&metal, &mut points, &l, dt);
            let strain = points.plastic_strain[0];
            if onset.is_some() {
                work += 0.5 * (before + stress(&points)[(0, 1)]) * 1e4 * dt;
            } else if points.failure_onset[0] >= 1.0 {
                onset = Some(strain);
            } else {
                assert!((points.damage[0] - strain / failure).abs() < 1e-9);
            }
            assert!(work < 1e12);
        }
        let peak = 0.5 * (failure - YIELD / hardening);
        assert!((onset.unwrap() / peak - 1.0).abs() < 1e-3, "{onset:?}");
        let kept = 1.0 - peak / failure;
        let taken = size * kept * (YIELD + hardening * peak) * peak;
        let left = kept * kept * (energy - taken);
        assert!(
            (work * size / left - 1.0).abs() < 0.01,
            "{}",
            work * size / left
        );
    }
}

/// A metal that hardens and softens where it localises, a millimetre in size.
fn localising() -> Material {
    let law = VonMises {
        shear_modulus: G,
        yield_stress: YIELD,
        hardening_modulus: 1e9,
    };
    let mut metal = material(RHO, linear(K), Strength::VonMises(law));
    let mut localised = ductile([1.0, 0.0, 0.0, 0.0, 0.0]);
    localised.coupling = Coupling::Localised;
    metal.failure.johnson_cook = Some(localised);
    metal.failure.options.fracture_energy = 2e6;
    metal.failure.options.effect = Effect::Scaled;
    metal
}

/// Localised damage leaves the strength as it is before the maximum of `(1 − ε/ε_f)(Y₀ + H ε)`, and in a shear band
/// the fracture energy rules from there on, less what the particle has taken.
#[test]
fn localised_damage_takes_the_fracture_energy_in_a_band() {
    let metal = localising();
    let mut points = batch(RHO, 0.0);
    points.mass = [RHO * 1e-9; LANES];
    let mut l = Matrix3::zeros();
    l[(0, 1)] = 1e4;
    let dt = 2e-9;
    let (mut work, mut onset) = (0.0, None);
    while points.damage[0] < 1.0 {
        points.neighbour_strain = [0.8 * points.plastic_strain[0]; LANES];
        let before = stress(&points)[(0, 1)];
        step(&metal, &mut points, &l, dt);
        if onset.is_some() {
            work += 0.5 * (before + stress(&points)[(0, 1)]) * 1e4 * dt;
        } else if points.failure_onset[0] >= 1.0 {
            onset = Some(points.plastic_strain[0]);
        } else {
            assert_eq!(points.damage[0], 0.0);
        }
        assert!(work < 1e12);
    }
    let peak = 0.5 * (1.0 - YIELD / 1e9);
    assert!((onset.unwrap() / peak - 1.0).abs() < 1e-3, "{onset:?}");
    let left = 2e6 - 1e-3 * (YIELD + 1e9 * peak) * peak;
    let part = 1e-3 * work / left;
    assert!((part - 1.0).abs() < 0.01, "{part}");
}

/// What flows as its neighbours do, without turning, or pulled keeps its strength to the failure strain, and fails there at
/// once.
#[test]
fn what_does_not_localise_fails_at_once() {
    let metal = localising();
    let mut shear = Matrix3::zeros();
    shear[(0, 1)] = 1e4;
    let opening = Matrix3::from_diagonal(&[0.5e4, -0.5e4, 0.0].into());
    let pulled = shear + Matrix3::from_diagonal(&[20.0, 20.0, 20.0].into());
    for (l, ridge) in [(shear, 1.0), (opening, 2.0), (pulled, 2.0)] {
        let mut points = batch(RHO, 0.0);
        points.mass = [RHO * 1e-9; LANES];
        if l == pulled {
            points.density = [0.98 * RHO; LANES];
        }
        while points.damage[0] == 0.0 {
            let strain = points.plastic_strain[0];
            points.neighbour_strain = [strain / ridge; LANES];
            step(&metal, &mut points, &l, 2e-9);
            let strength = YIELD + 1e9 * points.plastic_strain[0];
            assert!(points.damage[0] > 0.0 || equivalent(&points) < 1.001 * strength);
            assert!(strain < 1.1);
        }
        assert_eq!(points.damage[0], 1.0);
        assert!((points.plastic_strain[0] - 1.0).abs() < 1e-3);
    }
}

/// What has failed has neither cohesion nor friction, and resists being made smaller: sheared under
/// pressure it has no shear stress, pulled no tension, pressed all of the pressure.
#[test]
fn failed_material_has_no_friction_and_no_cohesion_and_resists_volume() {
    let mut metal = metal();
    metal.failure.johnson_cook = Some(ductile(AL_2024_T351));
    for (density, pressed) in [(1.02 * RHO, true), (0.9 * RHO, false)] {
        let mut points = batch(density, 0.0);
        points.damage = [1.0; LANES];
        let mut l = Matrix3::zeros();
        l[(0, 1)] = 1e5;
        for _ in 0..100 {
            step(&metal, &mut points, &l, 1e-8);
        }
        assert_eq!(equivalent(&points), 0.0);
        let eos = K * (points.density[0] / RHO).ln();
        let borne = if pressed { eos } else { 0.0 };
        assert!((points.pressure[0] - borne).abs() <= 1e-9 * K);
    }
}
