//! Hertz's line contact (`inputs/hertz-cylinder`) and a disc under two opposing loads
//! (`inputs/hertz-disc`): Johnson, Contact Mechanics (1985), sections 4.2 and 5.6.

mod physics_support;

use std::f64::consts::PI;

use physics_support::{ready, run_with, start};
use whipple::step::Simulation;

/// Radius of cylinder and disc (m).
const RADIUS: f64 = 10e-3;
/// E/(1 − ν²) of the material `aluminium-bar` (Pa).
const PLANE_MODULUS: f64 = 70e9 / (1.0 - 0.33 * 0.33);

/// Forces of contact along y (N/m) of one half of the model, and where along x they stand (m).
fn pushes(s: &Simulation) -> Vec<(f64, f64)> {
    let store = &s.store;
    (0..store.owned())
        .map(|i| {
            let force = store.mass[i] * store.contact_acceleration[i][1];
            (store.position[i][0], -force)
        })
        .filter(|push| push.1 > 0.0)
        .collect()
}

/// Errors of the half width of the contact and of its largest pressure, at the mean force from 26 µs
/// to the end. The width is that of the ellipse with the same second moment, `b² = 4 Σ F x²/Σ F`.
fn cylinder(spacing: &str) -> [f64; 2] {
    let mut s = start(ready(
        "hertz-cylinder",
        &[&format!("spacing=\"{spacing}\"")],
    ));
    let dp = s.case.bodies[0].lattice.spacing;
    let (mut samples, mut width, mut pressure) = (0.0, 0.0, 0.0);
    run_with(&mut s, 1.0, |s| {
        if s.state.time < 26e-6 {
            return;
        }
        let pushes = pushes(s);
        let half: f64 = pushes.iter().map(|p| p.1).sum();
        let moment: f64 = pushes.iter().map(|p| p.1 * p.0 * p.0).sum();
        let largest = pushes.iter().map(|p| p.1).fold(0.0, f64::max);
        let b = (4.0 * 2.0 * half * RADIUS / (PI * PLANE_MODULUS)).sqrt();
        samples += 1.0;
        width += 2.0 * (moment / half).sqrt() / b;
        pressure += largest / dp / (2.0 * 2.0 * half / (PI * b));
    });
    let errors = [width / samples - 1.0, pressure / samples - 1.0];
    println!(
        "{spacing}: width {:+.4}, pressure {:+.4}",
        errors[0], errors[1]
    );
    errors
}

/// Within 5 % from the input's spacing on, and nearer with each finer one.
#[test]
#[ignore = "slow: make validation"]
fn width_and_pressure_of_a_line_contact() {
    let errors = ["0.4 mm", "0.2 mm", "0.1 mm"].map(cylinder);
    for k in 0..2 {
        assert!(errors[1][k].abs() < 0.05 && errors[2][k].abs() < 0.05);
        assert!(errors[2][k].abs() < 0.7 * errors[1][k].abs());
        assert!(errors[1][k].abs() < 0.7 * errors[0][k].abs());
    }
}

/// Stress at the centre of the disc within 5 %.
#[test]
#[ignore = "slow: make validation"]
fn stress_at_the_centre_of_a_disc() {
    for spacing in ["0.4 mm", "0.2 mm"] {
        let mut s = start(ready("hertz-disc", &[&format!("spacing=\"{spacing}\"")]));
        let (mut force, mut stress) = (0.0, [0.0; 2]);
        run_with(&mut s, 1.0, |s| {
            if s.state.time < 33e-6 {
                return;
            }
            force += 2.0 * pushes(s).iter().map(|p| p.1).sum::<f64>();
            let store = &s.store;
            let near = |i: &usize| store.position[*i][0].hypot(store.position[*i][1]) < 1e-3;
            let inner: Vec<usize> = (0..store.owned()).filter(near).collect();
            #[allow(clippy::cast_precision_loss, reason = "few particles")]
            let count = inner.len() as f64;
            for (a, sum) in stress.iter_mut().enumerate() {
                let of = |&i: &usize| store.deviatoric_stress[i][a] - store.pressure[i];
                *sum += inner.iter().map(of).sum::<f64>() / count;
            }
        });
        let unit = 2.0 * force / (PI * 2.0 * RADIUS);
        let [along, across] = [stress[0] / unit, stress[1] / (-3.0 * unit)];
        println!("{spacing}: σx {along:.4}, σy {across:.4} of the exact stress");
        assert!((along - 1.0).abs() < 0.05, "{along}");
        assert!((across - 1.0).abs() < 0.05, "{across}");
    }
}
