//! Neo-Hookean rubber: exact solutions, closed cycles, objectivity.

use crate::support::{batch, material, set_gradient, step, stress};
use material::{Eos, LANES, Linear, LinearForm, Material, NeoHookean, Strength};
use nalgebra::{Matrix3, Rotation3, Vector3};

const RHO: f64 = 1010.0;
const C0: f64 = 852.0;
const G: f64 = 0.22 * RHO * C0 * C0;

fn rubber() -> Material {
    let eos = Eos::Linear(Linear {
        bulk_modulus: RHO * C0 * C0,
        form: LinearForm::Logarithmic,
    });
    material(
        RHO,
        eos,
        Strength::NeoHookean(NeoHookean { shear_modulus: G }),
    )
}

/// Stress (Pa) of the deformation gradient F: `G/J dev(J^(−2/3) F Fᵀ)`.
fn exact(f: &Matrix3<f64>) -> Matrix3<f64> {
    let j = f.determinant();
    let b = f * f.transpose() / (j * j).cbrt();
    (b - Matrix3::identity() * (b.trace() / 3.0)) * (G / j)
}

#[test]
fn simple_shear_is_exact_in_any_number_of_steps() {
    for (shear, steps) in [(0.1, 1), (3.0, 1), (3.0, 7), (-2.0, 300), (5.0, 50)] {
        let mut points = batch(RHO, 0.0);
        let l = Matrix3::new(0.0, shear, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for _ in 0..steps {
            step(&rubber(), &mut points, &l, 1.0 / f64::from(steps));
        }
        let f = Matrix3::identity() + l;
        let error = (stress(&points) - exact(&f)).norm() / exact(&f).norm();
        assert!(error < 1e-12, "shear {shear} in {steps} steps: {error}");
    }
}

/// A velocity gradient that stretches by exactly these factors in a step of 1 s.
fn stretching(factors: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(factors.map(|s| 2.0 * (s - 1.0) / (s + 1.0))))
}

#[test]
fn uniaxial_stretch_is_exact() {
    // Isochoric and, with its change of volume, uniaxial strain.
    for stretch in [0.2_f64, 0.9, 1.5, 3.0, 6.0] {
        let across = 1.0 / stretch.sqrt();
        for factors in [[stretch, across, across], [stretch, 1.0, 1.0]] {
            let f = Matrix3::from_diagonal(&Vector3::from(factors));
            let mut points = batch(RHO, 0.0);
            for _ in 0..4 {
                set_gradient(&mut points, &stretching(factors.map(|s| s.powf(0.25))));
                let trace: f64 = (0..3).map(|a| points.velocity_gradient[4 * a][0]).sum();
                // The density of the engine's rule; the law reads its J from it.
                for density in &mut points.density {
                    *density *= (1.0 - 0.5 * trace) / (1.0 + 0.5 * trace);
                }
                rubber().update(&mut points, 1.0);
            }
            let j = RHO / points.density[0];
            let expected = exact(&f) * (f.determinant() / j);
            let error = (stress(&points) - expected).norm() / expected.norm();
            assert!(error < 1e-12, "{factors:?}: {error}");
        }
    }
}

#[test]
fn a_closed_cycle_of_large_strain_leaves_no_stress() {
    // Along one path and back: nothing at all. Around a loop: second order in the step.
    let there = Matrix3::new(0.4, 1.5, 0.2, -0.3, -0.5, 0.6, 0.1, 0.8, 0.1);
    let mut points = batch(RHO, 0.0);
    for l in [there, -there] {
        for _ in 0..20 {
            step(&rubber(), &mut points, &l, 0.05);
        }
    }
    assert!(stress(&points).norm() < 1e-12 * G, "{}", stress(&points));

    // F(t) = I + sin²(πt) M + sin(2πt) N: closed at t = 1, not the same way back.
    let m = Matrix3::new(0.0, 1.2, 0.0, 0.3, 0.4, 0.0, 0.0, 0.0, -0.2);
    let n = Matrix3::new(0.3, 0.0, 0.4, 0.0, -0.2, 0.0, 0.0, 0.5, 0.0);
    let error = |steps: u32| {
        let mut points = batch(RHO, 0.0);
        let pi = std::f64::consts::PI;
        let dt = 1.0 / f64::from(steps);
        for k in 0..steps {
            let t = (f64::from(k) + 0.5) * dt;
            let f =
                Matrix3::identity() + m * libm::sin(pi * t).powi(2) + n * libm::sin(2.0 * pi * t);
            let rate =
                m * (pi * libm::sin(2.0 * pi * t)) + n * (2.0 * pi * libm::cos(2.0 * pi * t));
            step(
                &rubber(),
                &mut points,
                &(rate * f.try_inverse().unwrap()),
                dt,
            );
        }
        stress(&points).norm() / G
    };
    let (coarse, fine) = (error(200), error(400));
    assert!(coarse < 2e-3, "{coarse}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse} {fine}");
}

#[test]
fn a_rotation_carries_the_stress_round() {
    // A full turn about a skew axis in a few coarse steps: invariants stay to round-off.
    let mut points = batch(RHO, 0.0);
    let l = Matrix3::new(0.3, 0.9, 0.0, 0.0, -0.4, 0.5, 0.2, 0.0, 0.1);
    step(&rubber(), &mut points, &l, 0.5);
    let before = stress(&points);
    let axis = Vector3::new(1.0, -2.0, 0.5).normalize();
    // The step turns by 2 atan(θ/2): eight steps of an eighth of a turn each.
    let rate = 2.0 * libm::tan(std::f64::consts::PI / 8.0);
    for turned in 1..=8 {
        step(&rubber(), &mut points, &(axis.cross_matrix() * rate), 1.0);
        let angle = f64::from(turned) * std::f64::consts::FRAC_PI_4;
        let r = *Rotation3::new(axis * angle).matrix();
        let expected = r * before * r.transpose();
        let error = (stress(&points) - expected).norm() / before.norm();
        assert!(error < 1e-13, "{turned}: {error}");
    }
}

#[test]
#[allow(clippy::float_cmp)] // not a bit may change
fn a_step_of_no_time_keeps_every_bit() {
    let mut points = batch(RHO, 0.0);
    let l = Matrix3::new(0.3, 0.9, 0.0, 0.0, -0.4, 0.5, 0.2, 0.0, 0.1);
    step(&rubber(), &mut points, &l, 0.5);
    let before = points;
    rubber().update(&mut points, 0.0);
    assert!(points.deviatoric_stress == before.deviatoric_stress);
    assert!(points.sound_speed[0] / before.sound_speed[0] - 1.0 < 1e-12);
    // Small strains have the speed of the p-wave modulus; large ones a faster one.
    let mut rest = batch(RHO, 0.0);
    rubber().update(&mut rest, 0.0);
    let c = rest.sound_speed[LANES - 1];
    assert!((RHO * c * c / rubber().p_wave_modulus() - 1.0).abs() < 1e-14);
    assert!(before.sound_speed[0] > c);
}
