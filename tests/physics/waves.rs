//! The paper's section 3.1: elastic waves across two bars in contact, beside the bar in one piece.

use crate::physics_support::bars::{
    PLATEAU, STEP, axial_stress, force_on_right, in_one_piece, in_order, interface_force,
};
use crate::physics_support::{lattice_factor, ready, run_to, start};
use engine::step::Simulation;

/// Particles of each bar.
const HALF: usize = 50;
/// A contact stiffness κ with which the contact gives way by next to nothing, and steps that bear
/// it; the defaults are 4 and 0.5.
const STIFF: [&str; 2] = ["contact.overlap.stiffness=16", "time_step.courant=0.2"];

/// A case at its end, in two bars and in one.
struct Pair {
    split: Simulation,
    whole: Simulation,
}

impl Pair {
    fn run(name: &str, smoothing: f64, more: &[&str]) -> Self {
        let smoothing = format!("sph.smoothing={smoothing}");
        let overrides = [&[smoothing.as_str()], more].concat();
        let case = || ready(name, &overrides);
        let [split, whole] = [case(), in_one_piece(case())].map(|case| {
            let mut s = start(case);
            run_to(&mut s, f64::INFINITY);
            s
        });
        Self { split, whole }
    }

    /// Largest difference of velocity over that of the step: farther than three spacings from the
    /// interface, and within.
    fn errors(&self) -> [f64; 2] {
        let velocity = |s: &Simulation, i: usize| s.particles.velocity[i][0];
        let mut worst = [0.0_f64; 2];
        let all = in_order(&self.split).into_iter().zip(in_order(&self.whole));
        for (k, (a, b)) in all.enumerate() {
            let difference = velocity(&self.split, a) - velocity(&self.whole, b);
            let near = (HALF - 3..HALF + 3).contains(&k);
            let error = &mut worst[usize::from(near)];
            *error = error.max(difference.abs() / STEP);
        }
        worst
    }
}

/// At 128.8 µs. Stress and traction against ρ c v; the pair sums of a lattice carry its factor A
/// times the stress, in one piece and in two.
#[test]
fn a_step_crosses_the_contact() {
    for (smoothing, bound) in [(1.0, 0.03), (1.2, 0.04)] {
        let pair = Pair::run("wave-step", smoothing, &[]);
        let worst = pair.errors().into_iter().fold(0.0, f64::max);
        let plateau = &in_order(&pair.whole)[15..60];
        let stress = plateau.iter().map(|&i| -axial_stress(&pair.whole, i));
        let mean = stress.sum::<f64>() / 45.0 / PLATEAU;
        let traction = interface_force(&pair.split) / PLATEAU;
        let whole = force_on_right(&pair.whole, HALF) / PLATEAU;
        let factor = lattice_factor(smoothing);
        // A spring under the force p that holds the energy Φ gives way by 2 Φ/p.
        let depth = 2.0 * pair.split.state.totals.contact_energy / interface_force(&pair.split);
        let strain = PLATEAU / pair.split.case.materials[0].p_wave_modulus();
        println!(
            "h = {smoothing} dp: {worst:.4} v, stress {mean:.5}, contact traction {traction:.5}, \
             in one piece {whole:.5}, lattice {factor:.5}, contact gives way like {:.2} dp of bar",
            depth / strain / 0.01
        );
        assert!(worst <= bound, "{worst} v");
        assert!((mean - 1.0).abs() < 0.005, "{mean}");
        assert!((traction / whole - 1.0).abs() < 0.01);
        assert!((traction / factor - 1.0).abs() < 0.01);
        assert!(pair.split.state.worst.energy_error < 1e-3);
    }
}

/// At 128.8 µs, when the tail has just passed the interface. Contact gives way a little, which
/// delays the tail by a part of a spacing; stiff contact does not, so its bounds are the ones to
/// be reached away from the interface.
#[test]
fn a_pulse_crosses_the_contact() {
    for (smoothing, bounds) in [(1.0, [0.04, 0.10]), (1.2, [0.07, 0.18])] {
        for stiff in [false, true] {
            let more: &[&str] = if stiff { &STIFF } else { &[] };
            let pair = Pair::run("wave-pulse", smoothing, more);
            let [away, near] = pair.errors();
            println!("h = {smoothing} dp, {more:?}: {away:.4} v away, {near:.4} v near");
            assert!(near <= bounds[1], "{near} v near the interface");
            assert!(away <= bounds[0] || !stiff, "{away} v away from it");
        }
    }
}

/// In the corrected form ends are stiffer than a bar in one piece, so that a softer contact, κ = 2,
/// makes the whole right. With the default one the pulse runs ahead by less than it lags in the
/// conventional form.
#[test]
fn a_pulse_crosses_the_contact_in_the_corrected_form() {
    for (stiffness, bounds) in [(2, [0.04, 0.10]), (4, [0.07, 0.10])] {
        let stiff = format!("contact.overlap.stiffness={stiffness}");
        let pair = Pair::run("wave-pulse", 1.3, &["sph.form=corrected", &stiff]);
        let [away, near] = pair.errors();
        println!("kappa = {stiffness}: {away:.4} v away, {near:.4} v near");
        assert!(near <= bounds[1], "{near} v near the interface");
        assert!(away <= bounds[0], "{away} v away from it");
    }
}

/// `kernel` is the bar in one piece; `potential` starts with a force between the bars, which
/// drives them apart.
#[test]
fn other_contacts() {
    for (mode, smoothing) in [("kernel", 1.0), ("potential", 1.0), ("potential", 1.2)] {
        let mode = format!("contact.mode={mode}");
        let [away, near] = Pair::run("wave-step", smoothing, &[&mode]).errors();
        println!("{mode}, h = {smoothing} dp: {away:.4} v away, {near:.4} v near");
        assert!(mode.ends_with("potential") || away.max(near) < 1e-9);
    }
}
