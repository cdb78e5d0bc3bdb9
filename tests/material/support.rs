//! Batches of one state in all lanes, for tests at a point.

use material::{
    Eos, Failure, IdealGas, LANES, Linear, LinearForm, Material, MieGruneisen, PointBatch,
    Strength, Tait, Tillotson,
};
use nalgebra::Matrix3;

/// A material at rest, without spall or heat.
#[allow(dead_code)] // not by every test
pub fn material(reference_density: f64, eos: Eos, strength: Strength) -> Material {
    Material {
        name: "point".to_owned(),
        reference_density,
        eos,
        strength,
        failure: Failure::NONE,
        thermal: None,
        porosity: None,
    }
}

/// One of each equation of state, with its reference density (kg/m³).
#[allow(dead_code)] // not by every test
pub fn equations_of_state() -> Vec<(f64, Eos)> {
    let mut all = vec![
        (2785.0, Eos::MieGruneisen(aluminium())),
        (
            998.0,
            Eos::Tait(Tait {
                b: 3.0e8,
                gamma: 7.0,
            }),
        ),
        (2700.0, Eos::Tillotson(tillotson())),
    ];
    for stiffening_pressure in [0.0, 6e8] {
        let gas = IdealGas {
            gamma: 1.4,
            stiffening_pressure,
            reference_pressure: 1e5,
        };
        all.push((1.2, Eos::IdealGas(gas)));
    }
    for form in [LinearForm::Logarithmic, LinearForm::DensityRatio] {
        let bulk_modulus = 160e9;
        all.push((7830.0, Eos::Linear(Linear { bulk_modulus, form })));
    }
    all
}

/// Aluminium 2024.
#[allow(dead_code)] // not by every test
pub fn aluminium() -> MieGruneisen {
    MieGruneisen {
        c0: 5328.0,
        s1: 1.338,
        s2: 0.0,
        s3: 0.0,
        gamma0: 2.0,
        b: 0.48,
    }
}

/// Aluminium.
#[allow(dead_code)] // not by every test
pub fn tillotson() -> Tillotson {
    Tillotson {
        a: 0.5,
        b: 1.63,
        bulk_modulus: 75.2e9,
        quadratic_modulus: 65e9,
        alpha: 5.0,
        beta: 5.0,
        e0: 5e6,
        e_iv: 3e6,
        e_cv: 13.9e6,
        least_density: 0.0,
    }
}

/// A point at rest without stress.
#[allow(dead_code)] // not by every test
pub fn batch(density: f64, specific_energy: f64) -> PointBatch {
    PointBatch {
        density: [density; LANES],
        specific_energy: [specific_energy; LANES],
        pressure: [f64::NAN; LANES],
        sound_speed: [f64::NAN; LANES],
        ..PointBatch::ZERO
    }
}

#[allow(dead_code)] // not by every test
pub fn set_gradient(points: &mut PointBatch, l: &Matrix3<f64>) {
    for i in 0..3 {
        for j in 0..3 {
            points.velocity_gradient[3 * i + j] = [l[(i, j)]; LANES];
        }
    }
}

/// One step under a velocity gradient (1/s), with the density that the engine would give it.
#[allow(dead_code)] // not by every test
pub fn step(material: &Material, points: &mut PointBatch, l: &Matrix3<f64>, dt: f64) {
    set_gradient(points, l);
    let strain = 0.5 * dt * l.trace();
    for density in &mut points.density {
        *density *= (1.0 - strain) / (1.0 + strain);
    }
    material.update(points, dt);
}

/// Deviatoric stress (Pa) of the last lane.
#[allow(dead_code)] // not by every test
pub fn stress(points: &PointBatch) -> Matrix3<f64> {
    let [xx, yy, zz, xy, xz, yz] = points.deviatoric_stress.map(|s| s[LANES - 1]);
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// Von Mises equivalent (Pa) of the last lane.
#[allow(dead_code)] // not by every test
pub fn equivalent(points: &PointBatch) -> f64 {
    1.5_f64.sqrt() * stress(points).norm()
}
