//! Elastic waves and the conservation of energy in an elastic impact.

use crate::physics_support::bars::{STEEL_SPEED, STEP, bar_velocities, step_bar};
use crate::physics_support::{lattice_factor, ready, run_to, slope, start};
use model::SphForm;

/// Speed (m/s) at which half of the step runs along the undisturbed bar.
fn wave_speed(form: SphForm, smoothing: f64) -> f64 {
    let mut case = step_bar(smoothing);
    case.sph.form = form;
    let mut s = start(case);
    let mut fronts = Vec::new();
    for k in 0..10_i32 {
        run_to(&mut s, 1e-6 * f64::from(60 + 10 * k));
        let v = bar_velocities(&s);
        let mut x: Vec<f64> = s.particles.position.iter().map(|x| x[0]).collect();
        x.sort_by(f64::total_cmp);
        let half = 0.5 * STEP;
        let front = (0..v.len() - 1)
            .rev()
            .find(|&k| v[k] > half && v[k + 1] <= half)
            .expect("a front");
        let part = (v[front] - half) / (v[front] - v[front + 1]);
        let place = x[front] + part * (x[front + 1] - x[front]);
        fronts.push((s.state.time, place + STEP * s.state.time));
    }
    slope(&fronts)
}

/// `√(M/ρ)` within 1 % where the lattice differentiates exactly (h = Δp), and `A √(M/ρ)` with the
/// lattice's factor `A` elsewhere, in the conventional form: the sums of momentum and those of strain
/// bring one factor each.
#[test]
fn elastic_waves_run_at_the_speed_of_the_lattice() {
    for smoothing in [1.0, 1.2, 1.3, 1.5] {
        let measured = wave_speed(SphForm::Conventional, smoothing) / STEEL_SPEED;
        let factor = lattice_factor(smoothing);
        println!("h = {smoothing} dp: {measured:.4} c, lattice {factor:.4} c");
        if smoothing == 1.0 {
            assert!((measured - 1.0).abs() < 0.01, "{measured} c");
        }
        assert!((measured / factor - 1.0).abs() < 0.003, "{measured} c");
    }
}

/// Within .2 % in the corrected form.
#[test]
fn corrected_waves_run_at_the_speed_of_sound() {
    for smoothing in [1.0, 1.2, 1.3, 1.5] {
        let measured = wave_speed(SphForm::Corrected, smoothing) / STEEL_SPEED;
        println!("h = {smoothing} dp: {measured:.5} c");
        assert!((measured - 1.0).abs() < 0.002, "{measured} c");
    }
}

/// The pair sums conserve energy to round-off; what is left is the work of contact, whose defect
/// falls with the square of the step.
#[test]
fn energy_of_an_elastic_impact_is_conserved_to_second_order() {
    let mut defects = Vec::new();
    for courant in ["0.4", "0.2", "0.1"] {
        let overrides = [format!("time_step.courant={courant}")];
        let mut s = start(ready("elastic-impact", &[&overrides[0]]));
        let end = s.case.run.end_time;
        run_to(&mut s, end);
        let worst = &s.state.worst;
        println!(
            "courant {courant}: {} steps, energy error {:.3e}, contact defect {:.3e}, momentum {:?}, interpenetrated {}, ke {:.4}",
            s.state.step,
            worst.energy_error,
            worst.contact_defect,
            worst.momentum_error,
            worst.interpenetrated,
            s.state.totals.kinetic_energy / s.state.initial.kinetic_energy
        );
        assert!((worst.energy_error - worst.contact_defect).abs() < 1e-11);
        assert!(worst.contact_defect < 1e-3);
        assert!(worst.momentum_error.iter().all(|&e| e < 1e-12));
        defects.push(worst.contact_defect);
    }
    // Two but for the kinks of the excess, where particles come into touch.
    for pair in defects.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        println!("order {order:.2}");
        assert!(order > 1.6, "order {order}");
    }
}
