//! Tait, Tillotson and gas: closed forms, joins of the branches, derivatives; Newtonian viscosity.

use crate::support::{batch, equations_of_state, material, step, stress, tillotson};
use material::{Eos, IdealGas, Strength, Tait, Tillotson, Viscous};
use nalgebra::Matrix3;

#[test]
fn derivatives_are_those_of_the_pressure() {
    // Central differences: δ² of curvature and 1e-16/δ of rounding, with δ = 1e-6.
    for (rho0, eos) in equations_of_state() {
        for ratio in [0.3, 0.8, 0.95, 1.02, 1.3, 1.9] {
            for e in [-1e5, 0.0, 1e6, 5e6, 2e7] {
                let rho = rho0 * ratio;
                let at = eos.at(rho0, rho, e);
                let scale = eos.bulk_modulus(rho0) + at.pressure.abs();
                let (dr, de) = (1e-6 * rho, 1e-6 * 1e7);
                let by_rho =
                    eos.at(rho0, rho + dr, e).pressure - eos.at(rho0, rho - dr, e).pressure;
                let by_e = eos.at(rho0, rho, e + de).pressure - eos.at(rho0, rho, e - de).pressure;
                let error = (by_rho / (2.0 * dr) - at.dp_drho).abs() * rho / scale;
                assert!(error < 1e-8, "{eos:?} by ρ at {ratio}, {e}: {error}");
                let error = (by_e / (2.0 * de) - at.dp_de).abs() * 1e7 / scale;
                assert!(error < 1e-8, "{eos:?} by e at {ratio}, {e}: {error}");
            }
        }
    }
}

#[test]
fn tait_is_the_papers_and_takes_a_sound_speed() {
    let (rho0, c0) = (1000.0, 24.0);
    let tait = Tait::with_sound_speed(rho0, c0, 7.0);
    assert!((tait.b / (rho0 * c0 * c0 / 7.0) - 1.0).abs() < 1e-15);
    let at = tait.response(rho0, 1.01 * rho0);
    let expected = tait.b * (1.01_f64.powi(7) - 1.0);
    assert!((at.pressure / expected - 1.0).abs() < 1e-13);
    let water = material(rho0, Eos::Tait(tait), Strength::None);
    let mut points = batch(rho0, 0.0);
    water.update(&mut points, 0.0);
    assert!((points.sound_speed[0] / c0 - 1.0).abs() < 1e-14);
    assert!((water.p_wave_modulus() / (rho0 * c0 * c0) - 1.0).abs() < 1e-14);
}

#[test]
fn gases_have_their_closed_forms() {
    for p_inf in [0.0, 6e8] {
        let gas = IdealGas {
            gamma: 1.4,
            stiffening_pressure: p_inf,
            reference_pressure: 1e5,
        };
        let rho = 1.2;
        let e = gas.reference_energy(rho);
        let at = gas.response(rho, e);
        assert!((at.pressure - 1e5).abs() < 1e-14 * (1e5 + p_inf));
        let fluid = material(rho, Eos::IdealGas(gas), Strength::None);
        let mut points = batch(1.7, 1.1 * e);
        fluid.update(&mut points, 0.0);
        let c2 = 1.4 * (points.pressure[0] + p_inf) / 1.7;
        assert!((points.sound_speed[0].powi(2) / c2 - 1.0).abs() < 1e-13);
        assert!((fluid.p_wave_modulus() / (1.4 * (1e5 + p_inf)) - 1.0).abs() < 1e-15);
    }
}

#[test]
fn a_gas_without_pressure_is_silent() {
    let gas = IdealGas {
        gamma: 5.0 / 3.0,
        stiffening_pressure: 0.0,
        reference_pressure: 0.0,
    };
    let cold = material(1.0, Eos::IdealGas(gas), Strength::None);
    let mut points = batch(1.0, 0.0);
    cold.update(&mut points, 0.0);
    assert!(points.pressure[0] == 0.0 && points.sound_speed[0] == 0.0);
}

#[test]
fn branches_of_tillotson_meet() {
    let eos = tillotson();
    let rho0 = 2700.0;
    // In value and slope at the reference density, whatever the energy.
    for e in [1e5, 5e6, 1e7, 3e7] {
        let above = eos.response(rho0, rho0 * (1.0 + 1e-12), e);
        let below = eos.response(rho0, rho0 * (1.0 - 1e-12), e);
        assert!((above.pressure / below.pressure - 1.0).abs() < 1e-8, "{e}");
        assert!((above.dp_drho / below.dp_drho - 1.0).abs() < 1e-8, "{e}");
    }
    // In value at both energies.
    for e in [eos.e_iv, eos.e_cv] {
        for ratio in [0.2, 0.6, 0.95] {
            let above = eos.response(rho0, rho0 * ratio, e * (1.0 + 1e-12)).pressure;
            let below = eos.response(rho0, rho0 * ratio, e * (1.0 - 1e-12)).pressure;
            assert!(
                (above - below).abs() < 1e-9 * eos.bulk_modulus,
                "{e} {ratio}"
            );
        }
    }
    // A thin hot vapour is an ideal gas with γ = 1 + a.
    let thin = eos.response(rho0, 1e-3 * rho0, 1e8).pressure;
    assert!((thin / (0.5 * 2.7 * 1e8) - 1.0).abs() < 1e-12);
    // Compressed: p = (a + b/w) ρ e + A μ + B μ² by hand, η = 1.2, e = 2 MJ/kg.
    let w = 2e6 / (5e6 * 1.44) + 1.0;
    let expected = (0.5 + 1.63 / w) * 3240.0 * 2e6 + 75.2e9 * 0.2 + 65e9 * 0.04;
    let at = eos.response(rho0, 1.2 * rho0, 2e6);
    assert!((at.pressure / expected - 1.0).abs() < 1e-14);
}

#[test]
fn a_newtonian_fluid_resists_the_rate_of_shear_alone() {
    let eta = 3.0;
    let tait = Eos::Tait(Tait::with_sound_speed(1000.0, 20.0, 7.0));
    let fluid = material(1000.0, tait, Strength::Viscous(Viscous { viscosity: eta }));
    let l = Matrix3::new(0.3, 2.0, 0.1, 0.5, -0.2, 0.4, -0.7, 0.6, 0.5);
    let mut points = batch(1000.0, 0.0);
    step(&fluid, &mut points, &l, 1e-6);
    let d = 0.5 * (l + l.transpose());
    let expected = 2.0 * eta * (d - Matrix3::identity() * (d.trace() / 3.0));
    assert!((stress(&points) - expected).norm() < 1e-14 * expected.norm());
    // A spin alone meets no resistance.
    step(&fluid, &mut points, &(l - l.transpose()), 1e-6);
    assert!(stress(&points).norm() < 1e-15);
    // A fluid has no shear wave: its modulus is K alone.
    assert!((fluid.p_wave_modulus() / 4e5 - 1.0).abs() < 1e-14);
    assert!((fluid.diffusion_time(0.01) / (0.125 * 1e-4 * 1000.0 / eta) - 1.0).abs() < 1e-14);
}

/// Below the least density no cold matter pulls, however dense it is; above it, and where it presses, nothing changes. On the way to
/// vapour the pressure rises from nothing.
#[test]
fn thin_matter_of_tillotson_pulls_no_more() {
    let whole = tillotson();
    let cut = Tillotson {
        least_density: 0.9,
        ..whole
    };
    for (ratio, energy) in [
        (0.95, 0.0),
        (0.91, 1e5),
        (0.8, 0.0),
        (0.5, 1e6),
        (0.5, 20e6),
    ] {
        let (free, limited) = (
            whole.response(2700.0, 2700.0 * ratio, energy),
            cut.response(2700.0, 2700.0 * ratio, energy),
        );
        let pulls = ratio < 0.9 && free.pressure < 0.0;
        let (expected, slope) = if pulls {
            (0.0, 0.0)
        } else {
            (free.pressure, free.dp_drho)
        };
        assert_eq!(limited.pressure, expected, "{ratio} {energy}");
        assert_eq!(limited.dp_drho, slope);
    }
    let warm = |energy| cut.response(2700.0, 270.0, energy).pressure;
    assert_eq!(warm(cut.e_iv), 0.0);
    let middle = warm(0.5 * (cut.e_iv + cut.e_cv));
    assert!(middle > 0.0 && middle < warm(cut.e_cv));
    assert!(whole.response(2700.0, 2160.0, 0.0).pressure < 0.0);
}
