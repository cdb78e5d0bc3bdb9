//! Johnson–Cook and Steinberg–Guinan: flow stress, return to yield, hardening against an
//! integration of its own, melting, temperature.

use crate::support::{aluminium, batch, equivalent, material, set_gradient, step, stress};
use material::{
    AfterSpall, Eos, JohnsonCook, LANES, Material, Spall, SteinbergGuinan, Strength, Thermal,
    ThermalConstants,
};
use nalgebra::{Matrix3, Vector3};

const RHO: f64 = 2785.0;
const CONSTANTS: ThermalConstants = ThermalConstants {
    specific_heat: 875.0,
    reference_temperature: 300.0,
    melting_temperature: Some(775.0),
    taylor_quinney: 1.0,
};
const JC: JohnsonCook = JohnsonCook {
    shear_modulus: 27.6e9,
    a: 265e6,
    b: 426e6,
    n: 0.34,
    c: 0.015,
    m: 1.0,
    reference_rate: 1.0,
};
const SG: SteinbergGuinan = SteinbergGuinan {
    shear_modulus: 27.6e9,
    yield_stress: 0.29e9,
    max_yield_stress: 0.68e9,
    beta: 125.0,
    n: 0.10,
    initial_strain: 0.0,
    pressure_coefficient: 6.52e-11,
    temperature_coefficient: 6.16e-4,
    melting_temperature: 1220.0,
    gamma0: 1.97,
    a: 1.5,
};

fn metal(strength: Strength) -> Material {
    let eos = Eos::MieGruneisen(aluminium());
    let mut metal = material(RHO, eos, strength);
    metal.thermal = Some(Thermal::new(CONSTANTS, RHO, &metal.eos));
    metal
}

/// Isochoric compression along z at a rate (1/s).
fn squeeze(rate: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, -1.0)) * rate
}

#[test]
fn johnson_cook_is_its_formula() {
    let flow = |strain, rate, t| JC.flow_stress(strain, rate, t, &CONSTANTS);
    let hard = 265e6 + 426e6 * 0.2_f64.powf(0.34);
    assert!((flow(0.2, 1.0, 300.0) / hard - 1.0).abs() < 1e-14);
    let fast = hard * (1.0 + 0.015 * 1e4_f64.ln());
    assert!((flow(0.2, 1e4, 300.0) / fast - 1.0).abs() < 1e-14);
    assert!((flow(0.2, 1e4, 537.5) / (0.5 * fast) - 1.0).abs() < 1e-14);
    // Slow and cold count as the reference, molten as a fluid.
    assert!((flow(0.2, 1e-6, 200.0) / hard - 1.0).abs() < 1e-14);
    assert!(flow(0.2, 1e4, 775.0) == 0.0 && flow(0.2, 1e4, 5000.0) == 0.0);
}

#[test]
fn the_return_finds_its_root_whatever_the_increment() {
    // From barely yielding to a hundredfold overshoot, fresh and hardened, slow and fast.
    let (mut worst, mut fresh): (f64, f64) = (0.0, 0.0);
    for before in [0.0, 1e-9, 1e-4, 0.05, 3.0] {
        for overshoot in [1e-10, 1e-6, 1e-3, 0.1, 1.0, 100.0] {
            for dt in [1e-10, 1e-6, 1.0, 1e4] {
                for energy in [0.0, 2e5] {
                    let metal = metal(Strength::JohnsonCook(JC));
                    let t = metal.temperature(RHO, energy, [0.0, 0.0]).unwrap();
                    let start = JC.flow_stress(before, 0.0, t, &CONSTANTS) * (1.0 + overshoot);
                    let mut points = batch(RHO, energy);
                    points.plastic_strain = [before; LANES];
                    points.deviatoric_stress[3] = [start / 3.0_f64.sqrt(); LANES];
                    metal.update(&mut points, dt);
                    let strain = points.plastic_strain[0] - before;
                    let q = equivalent(&points);
                    let y = JC.flow_stress(points.plastic_strain[0], strain / dt, t, &CONSTANTS);
                    // The increment of a hardened point is known to the rounding of its strain.
                    if strain > 1e-10 * before {
                        worst = worst.max((q - y).abs() / start);
                    }
                    if before == 0.0 {
                        fresh = fresh.max((q - y).abs() / start);
                    }
                    let elastic = (start - q) / (3.0 * JC.shear_modulus);
                    let rounding = 1e-15 * before + 1e-14 * start / JC.shear_modulus;
                    assert!((strain - elastic).abs() <= rounding);
                }
            }
        }
    }
    assert!(fresh < 1e-13, "largest residual of fresh points {fresh:e}");
    assert!(worst < 1e-9, "largest residual {worst:e}");
}

#[test]
fn hardening_follows_its_own_integral() {
    // Uniaxial, isochoric, at rate r: dq/dt = 3G (r − dε/dt), q = Y(ε, dε/dt) at constant
    // temperature; the reference integrates for ε with steps a thousand times finer.
    let rate = 1e4;
    let metal = metal(Strength::JohnsonCook(JC));
    let end = 0.3 / rate;
    let error = |steps: u32| {
        let mut points = batch(RHO, 0.0);
        let dt = end / f64::from(steps);
        for _ in 0..steps {
            step(&metal, &mut points, &squeeze(rate), dt);
        }
        (points.plastic_strain[0], equivalent(&points))
    };
    let (strain, q) = error(300);
    let exact = reference(rate, end, 300_000);
    let y = JC.flow_stress(exact, rate, 300.0, &CONSTANTS);
    assert!((strain / exact - 1.0).abs() < 1e-6, "{strain} {exact}");
    assert!((q / y - 1.0).abs() < 1e-4, "{q} {y}");
    // And the total strain is the elastic and the plastic one.
    let total = strain + q / (3.0 * JC.shear_modulus);
    assert!((total / 0.3 - 1.0).abs() < 1e-12, "{total}");
}

/// Plastic strain after `end` (s): explicit steps of `dε/dt` from `q = Y(ε, dε/dt)`, that is
/// `dε/dt = ε̇₀ exp((q/(A + B ε^n) − 1)/C)`.
fn reference(rate: f64, end: f64, steps: u32) -> f64 {
    let dt = end / f64::from(steps);
    let (mut strain, mut total) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        total += rate * dt;
        // Backward Euler by halving: dε = dt ε̇₀ exp(…), rising left side, falling right side.
        let (mut low, mut high) = (0.0, total - strain);
        for _ in 0..100 {
            let x = 0.5 * (low + high);
            let q = 3.0 * JC.shear_modulus * (total - strain - x);
            let hard = JC.a + JC.b * (strain + x).powf(JC.n);
            let wanted = dt * JC.reference_rate * (((q / hard) - 1.0) / JC.c).exp();
            if x < wanted && q > hard {
                low = x;
            } else {
                high = x;
            }
        }
        strain += 0.5 * (low + high);
    }
    strain
}

#[test]
fn steinberg_guinan_stiffens_hardens_saturates_and_melts() {
    let metal = metal(Strength::SteinbergGuinan(SG));
    let sound = |rho: f64, e: f64| {
        let mut points = batch(rho, e);
        metal.update(&mut points, 0.0);
        (points.pressure[0], points.sound_speed[0])
    };
    // The shear part of the sound speed follows G(p, T).
    let fluid = Material {
        strength: Strength::None,
        ..metal.clone()
    };
    for (ratio, e) in [(1.0, 0.0), (1.2, 3e5), (1.4, 1e6)] {
        let rho = RHO * ratio;
        let (p, c) = sound(rho, e);
        let mut bare = batch(rho, e);
        fluid.update(&mut bare, 0.0);
        let t = metal.temperature(rho, e, [0.0, 0.0]).unwrap();
        let g = 27.6e9 * (1.0 + 6.52e-11 * p / ratio.cbrt() - 6.16e-4 * (t - 300.0));
        let shear = 0.75 * rho * (c * c - bare.sound_speed[0].powi(2));
        assert!((shear / g - 1.0).abs() < 1e-9, "{ratio} {e}: {shear} {g}");
    }
    // On the surface Y₀ (1 + β ε)^n, then Y_max; no pressure, reference temperature.
    for (rate, steps) in [(2e-4, 20), (0.05, 5), (40.0, 100)] {
        let mut points = batch(RHO, 0.0);
        for _ in 0..steps {
            set_gradient(&mut points, &squeeze(rate));
            metal.update(&mut points, 1.0);
        }
        let strain = points.plastic_strain[0];
        let y = (0.29e9 * (1.0 + 125.0 * strain).powf(0.1)).min(0.68e9);
        assert!((equivalent(&points) / y - 1.0).abs() < 1e-13, "{strain}");
        let total = rate * f64::from(steps);
        let elastic = equivalent(&points) / (3.0 * 27.6e9);
        assert!((strain + elastic - total).abs() < 1e-12 * total);
    }
    // Molten: no shear stress, the speed of a fluid, strain is no longer counted.
    let mut points = batch(RHO, 0.0);
    step(&metal, &mut points, &squeeze(0.05), 1.0);
    let strain = points.plastic_strain;
    points.specific_energy = [875.0 * 1000.0; LANES];
    step(&metal, &mut points, &squeeze(0.05), 1.0);
    assert!(stress(&points).norm() == 0.0 && points.plastic_strain == strain);
    let mut bare = batch(points.density[0], 875e3);
    fluid.update(&mut bare, 0.0);
    assert!(points.sound_speed == bare.sound_speed);
    // The melting law at two compressions, by hand.
    assert!((SG.melting_temperature(1.0) - 1220.0).abs() < 1e-9);
    let by_hand =
        1220.0 * (3.0_f64 * (1.0 - 1.0 / 1.3)).exp() * 1.3_f64.powf(2.0 * 0.136_666_666_7);
    assert!((SG.melting_temperature(1.3) / by_hand - 1.0).abs() < 1e-9);
}

#[test]
fn a_rotating_block_carries_its_stress_round_below_yield() {
    for strength in [Strength::JohnsonCook(JC), Strength::SteinbergGuinan(SG)] {
        let metal = metal(strength);
        let mut points = batch(RHO, 0.0);
        points.deviatoric_stress[3] = [1e8; LANES];
        let turn = Vector3::new(0.0, 0.0, std::f64::consts::TAU).cross_matrix();
        for _ in 0..1000 {
            step(&metal, &mut points, &turn, 1e-3);
        }
        let s = stress(&points);
        // The angle error of 2π (2π/1000)²/12 = 2e-5, twice that in stress.
        assert!((s[(0, 1)] / 1e8 - 1.0).abs() < 1e-8 && s[(0, 0)].abs() < 5e-5 * 1e8);
        assert!(points.plastic_strain == [0.0; LANES]);
    }
}

#[test]
fn plastic_work_heats_and_softens() {
    // Isochoric, adiabatic: e grows by the stress power; the temperature by its share of c_v.
    let metal = metal(Strength::JohnsonCook(JC));
    let mut points = batch(RHO, 0.0);
    let (rate, dt) = (1e4, 1e-8);
    for _ in 0..5000 {
        let before = equivalent(&points);
        step(&metal, &mut points, &squeeze(rate), dt);
        let power = 0.5 * (before + equivalent(&points)) * rate / points.density[0];
        points.specific_energy = [points.specific_energy[0] + power * dt; LANES];
    }
    let t = metal
        .temperature(RHO, points.specific_energy[0], [0.0, 0.0])
        .unwrap();
    assert!((t - 300.0 - points.specific_energy[0] / 875.0).abs() < 1e-9);
    let cold = JC.flow_stress(points.plastic_strain[0], rate, 300.0, &CONSTANTS);
    let soft = 1.0 - (t - 300.0) / 475.0;
    assert!((100.0..200.0).contains(&(t - 300.0)), "{t}");
    // The last half step of energy is not yet in the temperature that the return used.
    assert!((equivalent(&points) / (cold * soft) - 1.0).abs() < 1e-4);
}

#[test]
fn without_heat_or_with_no_time_nothing_softens_or_moves() {
    let mut isothermal = metal(Strength::JohnsonCook(JC));
    isothermal.thermal = None;
    let mut points = batch(RHO, 4e5);
    step(&isothermal, &mut points, &squeeze(0.1), 1.0);
    let y = JC.flow_stress(
        points.plastic_strain[0],
        points.plastic_strain[0],
        300.0,
        &CONSTANTS,
    );
    assert!((equivalent(&points) / y - 1.0).abs() < 1e-12);
    for strength in [Strength::JohnsonCook(JC), Strength::SteinbergGuinan(SG)] {
        let metal = metal(strength);
        let mut points = batch(RHO, 1e4);
        step(&metal, &mut points, &squeeze(0.1), 1.0);
        let before = points;
        metal.update(&mut points, 0.0);
        assert!(points.deviatoric_stress == before.deviatoric_stress);
        assert!(points.plastic_strain == before.plastic_strain);
    }
}

#[test]
fn spalled_metal_keeps_the_temperature_of_its_matter() {
    let mut metal = metal(Strength::JohnsonCook(JC));
    metal.failure.spall = Some(Spall {
        pressure: -1.2e9,
        after: AfterSpall::Hold,
    });
    // Warm metal that opens at constant energy: the voids hold none of it.
    let at = |ratio: f64| metal.temperature(RHO * ratio, 1e5, [0.0, 0.0]).unwrap();
    let first = at(0.97);
    for ratio in [0.9, 0.6, 0.2, 1e-3] {
        assert!((at(ratio) - first).abs() < 1e-6, "{ratio}: {}", at(ratio));
    }
    // What has failed bears no tension: its matter is that without pressure.
    metal.failure.spall = Some(Spall {
        pressure: -1.2e9,
        after: AfterSpall::Failed,
    });
    let at = |ratio: f64| metal.temperature(RHO * ratio, 1e5, [1.0, 0.0]).unwrap();
    for ratio in [0.9, 0.6, 0.2, 1e-3] {
        assert!(
            (at(ratio) - at(0.97)).abs() < 1e-6,
            "{ratio}: {}",
            at(ratio)
        );
    }
    assert!(at(0.9) > first);
}
