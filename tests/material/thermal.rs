//! The cold curve and the temperature.

use crate::support::{aluminium, equations_of_state, material};
use material::{
    AfterSpall, Eos, IdealGas, LANES, Linear, LinearForm, PointBatch, Spall, Strength, Thermal,
    ThermalConstants,
};
use numerics::lanes::{F64x8, Lanes};

const CONSTANTS: ThermalConstants = ThermalConstants {
    specific_heat: 875.0,
    reference_temperature: 300.0,
    melting_temperature: None,
    taylor_quinney: 1.0,
};

#[test]
fn the_reference_state_has_the_reference_temperature() {
    for (rho0, eos) in equations_of_state() {
        let thermal = Thermal::new(CONSTANTS, rho0, &eos);
        let e = eos.reference_energy(rho0);
        // Rounding of the gas's energy, which is large against c_v T.
        let bound = 1e-9 + 1e-13 * e / 875.0;
        assert!(
            (thermal.temperature(rho0, e) - 300.0).abs() < bound,
            "{eos:?}"
        );
        assert!((thermal.temperature(rho0, e + 875.0) - 301.0).abs() < bound);
        assert!(thermal.temperature(rho0, e - 1e9) == 0.0);
        assert!(thermal.temperature(f64::NAN, e).is_nan());
    }
}

#[test]
fn no_temperature_is_above_that_of_the_least_cold_energy() {
    for (rho0, eos) in equations_of_state() {
        let thermal = Thermal::new(CONSTANTS, rho0, &eos);
        let reference = eos.reference_energy(rho0);
        let (mut least, mut range) = (f64::INFINITY, 0.0_f64);
        for n in 0..20_000 {
            let rho = rho0 * (0.4 + 2.5e-4 * f64::from(n));
            for above in [0.0, 1e6] {
                let e = reference + above;
                let temperatures = thermal.temperature(rho, e);
                let most = thermal.most::<F64x8>(&[e; LANES]).store().0[0];
                assert!(
                    temperatures <= most,
                    "{temperatures} for {most} at {rho}: {eos:?}"
                );
                least = least.min(most - temperatures);
                range = range.max(most);
            }
        }
        // And it is close to them, where the curve is lowest.
        assert!(least <= 1e-4 * range, "{least} of {range}: {eos:?}");
    }
}

#[test]
fn the_linear_cold_curve_is_its_closed_form() {
    // p = K ln r: e_c − e_c(ρ₀) = (K/ρ₀) [1 − (1 + ln r)/r].
    let (k, rho0) = (75e9, 2700.0);
    let eos = Eos::Linear(Linear {
        bulk_modulus: k,
        form: LinearForm::Logarithmic,
    });
    let thermal = Thermal::new(CONSTANTS, rho0, &eos);
    for r in [0.51_f64, 0.7, 0.93, 1.004, 1.3, 2.1, 4.3] {
        let exact = k / rho0 * (1.0 - (1.0 + r.ln()) / r) - 875.0 * 300.0;
        let error = (thermal.cold_energy(rho0 * r) - exact).abs() / 875.0;
        assert!(error < 2e-3, "{error} K at {r}");
    }
}

#[test]
fn an_isentrope_of_a_mie_gruneisen_solid_follows_its_parameter() {
    // dT/dρ along de = p/ρ² dρ is Γ T/ρ with Γ ρ = (γ₀ + b μ) ρ₀, whatever the cold curve.
    let rho0 = 2785.0;
    let mut metal = material(rho0, Eos::MieGruneisen(aluminium()), Strength::None);
    metal.thermal = Some(Thermal::new(CONSTANTS, rho0, &metal.eos));
    let steps = 4000;
    let (mut rho, mut e, mut logarithm) = (rho0, 2e5, 0.0);
    let first = metal.temperature(rho, e, [0.0, 0.0]).unwrap();
    let d = 0.35 * rho0 / f64::from(steps);
    for _ in 0..steps {
        let slope = |rho: f64, e: f64| metal.eos.at(rho0, rho, e).pressure / (rho * rho);
        let half = e + 0.5 * d * slope(rho, e);
        e += d * slope(rho + 0.5 * d, half);
        let middle = rho + 0.5 * d;
        logarithm += d * (2.0 + 0.48 * (middle / rho0 - 1.0)) * rho0 / (middle * middle);
        rho += d;
    }
    let ratio = metal.temperature(rho, e, [0.0, 0.0]).unwrap() / first;
    assert!((ratio / libm::exp(logarithm) - 1.0).abs() < 1e-5, "{ratio}");
    // The Hugoniot of 2024 at 50 GPa heats by some 900 K; tables say 1000 to 1200 K.
    let (rho, u) = (rho0 / (1.0 - 2.0e3 / 8.0e3), 2.0e3);
    let hot = metal.temperature(rho, 0.5 * u * u, [0.0, 0.0]).unwrap();
    assert!((800.0..1400.0).contains(&hot), "{hot} K");
}

#[test]
fn temperatures_after_an_update_are_those_of_the_state() {
    let rho0 = 2785.0;
    let mut metal = material(rho0, Eos::MieGruneisen(aluminium()), Strength::None);
    let work = [2e4; 8];
    for (after, share) in [(AfterSpall::Hold, 1.0), (AfterSpall::Failed, 0.9)] {
        metal.failure.spall = Some(Spall {
            pressure: -1.2e9,
            after,
        });
        let constants = ThermalConstants {
            taylor_quinney: share,
            ..CONSTANTS
        };
        metal.thermal = Some(Thermal::new(constants, rho0, &metal.eos));
        for ratio in [1.3, 1.0, 0.97, 0.9, 0.5] {
            let mut points = PointBatch::ZERO;
            for (k, part) in (0_u8..8).map(f64::from).enumerate() {
                points.density[k] = rho0 * ratio * (1.0 + 1e-3 * part);
                points.specific_energy[k] = 3e4 * part;
                points.damage[k] = f64::from(k > 5);
            }
            let before_failure = metal.update(&mut points, 1e-9);
            let temperatures = metal
                .updated_temperatures(&points, &work, &before_failure)
                .unwrap();
            for k in 0..8 {
                let energy = metal.thermal_energy(points.specific_energy[k], work[k]);
                let alone = metal.temperature(points.density[k], energy, [points.damage[k], 0.0]);
                assert_eq!(
                    temperatures[k].to_bits(),
                    alone.unwrap().to_bits(),
                    "{ratio}, {k}"
                );
            }
        }
    }
}

#[test]
fn a_gas_has_the_temperature_of_its_energy() {
    let gas = IdealGas {
        gamma: 1.4,
        stiffening_pressure: 0.0,
        reference_pressure: 101_325.0,
    };
    let rho0 = 1.2041;
    let eos = Eos::IdealGas(gas);
    // c_v = e₀/T₀ makes the cold curve vanish: T = e/c_v at any density.
    let constants = ThermalConstants {
        specific_heat: gas.reference_energy(rho0) / 293.15,
        reference_temperature: 293.15,
        melting_temperature: None,
        taylor_quinney: 1.0,
    };
    let thermal = Thermal::new(constants, rho0, &eos);
    for ratio in [1e-4, 0.6, 1.0, 4.0, 20.0] {
        let t = thermal.temperature(rho0 * ratio, constants.specific_heat * 500.0);
        assert!((t - 500.0).abs() < 1e-9, "{t} K at {ratio}");
    }
}
