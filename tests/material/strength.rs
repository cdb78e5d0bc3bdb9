//! Deviatoric stress: objectivity and order of the Jaumann step, radial return, hardening.

#![allow(clippy::float_cmp)] // where nothing may change, not a bit does

use material::{
    Elastic, Eos, Failure, LANES, Linear, LinearForm, Material, PointBatch, Strength, VonMises,
};
use nalgebra::{Matrix3, Rotation3, Vector3};

const G: f64 = 28.6e9;

fn material(strength: Strength) -> Material {
    Material {
        name: "block".to_owned(),
        reference_density: 2785.0,
        eos: Eos::Linear(Linear {
            bulk_modulus: 79e9,
            form: LinearForm::Logarithmic,
        }),
        strength,
        failure: Failure::NONE,
        thermal: None,
        porosity: None,
    }
}

fn elastic() -> Material {
    material(Strength::Elastic(Elastic { shear_modulus: G }))
}

fn hardening(yield_stress: f64, hardening_modulus: f64) -> Material {
    material(Strength::VonMises(VonMises {
        shear_modulus: G,
        yield_stress,
        hardening_modulus,
    }))
}

fn batch(stress: &Matrix3<f64>) -> PointBatch {
    let components = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    PointBatch {
        density: [2785.0; LANES],
        deviatoric_stress: components.map(|ij| [stress[ij]; LANES]),
        ..PointBatch::ZERO
    }
}

fn set_gradient(points: &mut PointBatch, l: &Matrix3<f64>) {
    for i in 0..3 {
        for j in 0..3 {
            points.velocity_gradient[3 * i + j] = [l[(i, j)]; LANES];
        }
    }
}

/// Stress of the last lane.
fn stress(points: &PointBatch) -> Matrix3<f64> {
    let [xx, yy, zz, xy, xz, yz] = points.deviatoric_stress.map(|s| s[LANES - 1]);
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// Stress at time 1 s under a velocity gradient that depends on time, in `steps` steps.
fn integrate(
    material: &Material,
    start: &Matrix3<f64>,
    steps: u32,
    gradient: impl Fn(f64) -> Matrix3<f64>,
) -> Matrix3<f64> {
    let mut points = batch(start);
    let dt = 1.0 / f64::from(steps);
    for n in 0..steps {
        set_gradient(&mut points, &gradient((f64::from(n) + 0.5) * dt));
        material.update(&mut points, dt);
    }
    stress(&points)
}

/// The order of an error that falls from `coarse` to `fine` on half the step.
fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

fn some_stress() -> Matrix3<f64> {
    Matrix3::new(0.9, 0.4, -0.3, 0.4, -0.2, 0.5, -0.3, 0.5, -0.7) * 1e8
}

fn spin(axis_times_rate: Vector3<f64>) -> Matrix3<f64> {
    axis_times_rate.cross_matrix()
}

#[test]
fn rotating_block_carries_its_stress_round() {
    // One full turn about a skew axis. The step turns by 2 atan(θ/2) instead of θ: the angle
    // error is 2π θ²/12, and the stress error at most twice that.
    let axis = Vector3::new(1.0, -2.0, 0.5).normalize();
    let start = some_stress();
    let turn = std::f64::consts::TAU;
    let error = |steps| {
        let end = integrate(&elastic(), &start, steps, |_| spin(axis * turn));
        (end - start).norm() / start.norm()
    };
    let (coarse, fine) = (error(100), error(200));
    let angle_error = turn * (turn / 100.0_f64).powi(2) / 12.0;
    assert!(coarse < 2.0 * angle_error, "{coarse}");
    let rate = order(coarse, fine);
    assert!((rate - 2.0).abs() < 0.01, "order {rate}");
}

#[test]
fn invariants_survive_rotations_of_any_size() {
    // Ten steps of half a turn each: Q is orthogonal to round-off whatever the step.
    let start = some_stress();
    let axis = Vector3::new(0.3, 0.4, -1.2).normalize();
    let end = integrate(&elastic(), &start, 10, |_| {
        spin(axis * 10.0 * std::f64::consts::PI)
    });
    assert!((end.norm() / start.norm() - 1.0).abs() < 1e-14);
    assert!(end.trace().abs() < 1e-14 * start.norm());
    assert!((end.determinant() / start.determinant() - 1.0).abs() < 1e-13);
}

#[test]
fn simple_shear_follows_the_sine() {
    // Exact for the Jaumann rate at shear γ: S_xy = G sin γ, S_xx = −S_yy = G (1 − cos γ).
    let shear = 2.0;
    let exact = Matrix3::new(
        1.0 - libm::cos(shear),
        libm::sin(shear),
        0.0,
        libm::sin(shear),
        libm::cos(shear) - 1.0,
        0.0,
        0.0,
        0.0,
        0.0,
    ) * G;
    let error = |steps| {
        let end = integrate(&elastic(), &Matrix3::zeros(), steps, |_| {
            Matrix3::new(0.0, shear, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        });
        (end - exact).norm() / G
    };
    let (coarse, fine) = (error(50), error(100));
    // (γ/50)²/12 × γ = 2.7e-4 of phase, and as much from the half strains.
    assert!(coarse < 6e-4, "{coarse}");
    let rate = order(coarse, fine);
    assert!((rate - 2.0).abs() < 0.02, "order {rate}");
}

#[test]
fn superposed_rotation_only_rotates_the_result() {
    // The same history seen from a frame that turns by 3 rad; unsteady stretch and shear.
    let start = some_stress();
    let gradient = |t: f64| {
        Matrix3::new(0.3, 0.5, 0.0, -0.1, -0.4, 0.2, 0.1, 0.0, 0.2)
            + Matrix3::new(0.2, -0.3, 0.4, 0.1, 0.1, 0.0, 0.0, 0.3, -0.1) * t
    };
    let axis = Vector3::new(0.2, 1.0, 0.6).normalize();
    let frame = |t: f64| *Rotation3::new(axis * 3.0 * t).matrix();
    let error = |steps| {
        let fixed = integrate(&elastic(), &start, steps, gradient);
        let turned = integrate(&elastic(), &start, steps, |t| {
            frame(t) * gradient(t) * frame(t).transpose() + spin(axis * 3.0)
        });
        let expected = frame(1.0) * fixed * frame(1.0).transpose();
        (turned - expected).norm() / fixed.norm()
    };
    let (coarse, fine) = (error(64), error(128));
    // The turn alone gives 3 (3/64)²/12 = 5.5e-4 of angle, twice that in stress.
    assert!(coarse < 1.1e-3, "{coarse}");
    let rate = order(coarse, fine);
    assert!((rate - 2.0).abs() < 0.02, "order {rate}");
}

#[test]
fn uniaxial_strain_has_the_p_wave_modulus() {
    // Velocity gradient integrated along a stretch to ρ/ρ0 = 1.1 in one step: ln 1.1 of strain.
    let bar = elastic();
    let strain = libm::log(1.1);
    let mut points = batch(&Matrix3::zeros());
    points.density = [2785.0 * 1.1; LANES];
    set_gradient(
        &mut points,
        &Matrix3::from_diagonal(&Vector3::new(-strain, 0.0, 0.0)),
    );
    bar.update(&mut points, 1.0);
    let axial = stress(&points)[(0, 0)] - points.pressure[0];
    assert!((axial / (-bar.p_wave_modulus() * strain) - 1.0).abs() < 1e-14);
    let rho_c_squared = points.density[0] * points.sound_speed[0] * points.sound_speed[0];
    assert!((rho_c_squared / bar.p_wave_modulus() - 1.0).abs() < 1e-14);
}

#[test]
fn radial_return_lands_on_the_hardened_yield_surface() {
    // Uniaxial strain ε: q = 2 G ε elastically, so ε_p = (2 G ε − Y₀)/(3G + H) in any number of
    // steps, and q = Y₀ + H ε_p.
    let (y0, h, strain) = (0.26e9, 1.5e9, 0.05);
    let expected = (2.0 * G * strain - y0) / (3.0 * G + h);
    for steps in [1, 7, 400] {
        let mut points = batch(&Matrix3::zeros());
        let rate = Vector3::new(-strain, 0.0, 0.0);
        set_gradient(&mut points, &Matrix3::from_diagonal(&rate));
        for _ in 0..steps {
            hardening(y0, h).update(&mut points, 1.0 / f64::from(steps));
        }
        let plastic = points.plastic_strain[0];
        assert!(
            (plastic / expected - 1.0).abs() < 1e-12,
            "{steps} steps: {plastic}"
        );
        let q = 1.5_f64.sqrt() * stress(&points).norm();
        assert!((q / (y0 + h * plastic) - 1.0).abs() < 1e-13);
        assert!((stress(&points)[(0, 0)] / (-2.0 / 3.0 * q) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn below_yield_nothing_is_plastic() {
    let mut points = batch(&Matrix3::zeros());
    let strain = 0.99 * 0.26e9 / (2.0 * G);
    set_gradient(
        &mut points,
        &Matrix3::from_diagonal(&Vector3::new(strain, 0.0, 0.0)),
    );
    let mut twin = points;
    hardening(0.26e9, 0.0).update(&mut points, 1.0);
    elastic().update(&mut twin, 1.0);
    assert!(points.plastic_strain == [0.0; LANES]);
    assert!(points.deviatoric_stress == twin.deviatoric_stress);
}

#[test]
fn zero_yield_stress_carries_no_shear() {
    let mut points = batch(&Matrix3::zeros());
    hardening(0.0, 0.0).update(&mut points, 1e-9); // at rest: nothing to return
    assert!(points.deviatoric_stress == [[0.0; LANES]; 6]);
    set_gradient(&mut points, &(some_stress() * 1e-3));
    hardening(0.0, 0.0).update(&mut points, 1e-9);
    assert!(stress(&points).norm() < 1e-15 * G);
    assert!(points.plastic_strain[0] > 0.0);
}

#[test]
fn a_step_of_no_time_keeps_every_bit_of_the_stress() {
    let law = hardening(0.1e9, 0.0);
    let mut points = batch(&some_stress());
    set_gradient(&mut points, &(some_stress() * 1e-3));
    law.update(&mut points, 1e-9);
    let before = points;
    law.update(&mut points, 0.0);
    assert!(points.deviatoric_stress == before.deviatoric_stress);
    assert!(points.plastic_strain == before.plastic_strain);
}

#[test]
fn fluids_have_no_shear_stress() {
    let mut points = batch(&some_stress());
    set_gradient(&mut points, &some_stress());
    material(Strength::None).update(&mut points, 1e-9);
    assert!(points.deviatoric_stress == [[0.0; LANES]; 6]);
    let bulk: f64 = 79e9 / 2785.0;
    assert!((points.sound_speed[0] / bulk.sqrt() - 1.0).abs() < 1e-15);
}
