//! What a run measures of itself against what its particles say.

use engine::step::measurements;
use std::collections::BTreeMap;

use crate::common::outcome::{advance, start};
use crate::common::sphere_on_plate;
use comm::Comm;
use engine::measure::BodyFigures;
use engine::step::Simulation;
use model::Case;

fn impact(quarter: bool) -> Case {
    sphere_on_plate(1e-4, 3000.0, quarter, 1.0)
}

fn measure(simulation: &mut Simulation) -> Vec<BodyFigures> {
    measurements::bodies(simulation, &Comm::solo())
}

fn close(a: f64, b: f64, scale: f64, what: &str) {
    assert!((a - b).abs() <= 1e-12 * scale, "{what}: {a} and {b}");
}

/// Bodies together are the totals of the history, and each has the extremes of its particles.
#[test]
fn bodies_add_up_to_the_model() {
    let mut simulation = start(impact(false));
    advance(&mut simulation, 60);
    let found = measure(&mut simulation);
    let totals = &simulation.state.totals;
    let sum = |of: fn(&BodyFigures) -> f64| found.iter().map(of).sum::<f64>();
    close(sum(|b| b.mass), totals.mass, totals.mass, "mass");
    let energy = totals.kinetic_energy;
    close(sum(|b| b.kinetic_energy), energy, energy, "kinetic energy");
    let internal = totals.internal_energy;
    close(
        sum(|b| b.internal_energy),
        internal,
        energy,
        "internal energy",
    );
    for a in 0..3 {
        let all: f64 = found.iter().map(|b| b.momentum[a]).sum();
        close(all, totals.momentum[a], totals.momentum_scale, "momentum");
        let all: f64 = found.iter().map(|b| b.angular_momentum[a]).sum();
        let scale = totals.momentum_scale * 1e-3;
        close(all, totals.angular_momentum[a], scale, "angular momentum");
    }
    let particles = &simulation.particles;
    for (b, body) in found.iter().enumerate() {
        let own = || (0..particles.owned()).filter(|&i| particles.body[i] as usize == b);
        assert_eq!(body.particles, own().count() as u64);
        let most = |of: &dyn Fn(usize) -> f64| own().map(of).fold(f64::NEG_INFINITY, f64::max);
        let same = |a: f64, b: f64| assert_eq!(a.to_bits(), b.to_bits());
        same(body.pressures[1], most(&|i| particles.pressure[i]));
        same(body.plastic_strain, most(&|i| particles.plastic_strain[i]));
        same(body.velocities[1][2], most(&|i| particles.velocity[i][2]));
        same(body.velocities[0][2], -most(&|i| -particles.velocity[i][2]));
        let (lower, upper) = (
            -most(&|i| -particles.position[i][0]),
            most(&|i| particles.position[i][0]),
        );
        assert!(body.extents[0][0] < lower && lower - body.extents[0][0] < 0.6e-4);
        assert!(body.extents[1][0] > upper && body.extents[1][0] - upper < 0.6e-4);
        // Yield turns some of the heat of a shock into plastic work, not all of it.
        assert!(0.0 < body.plastic_energy && body.plastic_energy < body.internal_energy);
        assert!(body.speed >= body.velocities[1][2].abs());
    }
}

/// A quarter model reports the whole: what the whole model says to rounding.
#[test]
fn a_quarter_reports_the_whole() {
    let [mut quarter, mut whole] = [true, false].map(|quarter| start(impact(quarter)));
    assert_eq!(4 * quarter.particles.owned(), whole.particles.owned());
    advance(&mut quarter, 12);
    advance(&mut whole, 12);
    for (a, b) in measure(&mut quarter).iter().zip(&measure(&mut whole)) {
        assert_eq!(a.particles, b.particles);
        let scale = b.mass * 3000.0;
        let near = |x: f64, y: f64, scale: f64| {
            assert!((x - y).abs() < 1e-9 * scale, "{x} {y}: {a:?}\n{b:?}");
        };
        near(a.mass, b.mass, b.mass);
        near(a.kinetic_energy, b.kinetic_energy, b.mass * 9e6);
        near(a.internal_energy, b.internal_energy, b.mass * 9e6);
        near(a.plastic_energy, b.plastic_energy, b.mass * 9e6);
        for k in 0..3 {
            near(a.momentum[k], b.momentum[k], scale);
            near(a.angular_momentum[k], b.angular_momentum[k], scale * 1e-3);
            near(a.velocity[k], b.velocity[k], 3000.0);
            near(a.centre[k], b.centre[k], 1e-3);
            for side in 0..2 {
                near(a.extents[side][k], b.extents[side][k], 1e-3);
                near(a.velocities[side][k], b.velocities[side][k], 3000.0);
            }
        }
        near(a.pressures[1], b.pressures[1], 1e11);
        near(a.plastic_strain, b.plastic_strain, 1.0);
    }
}

const PEAKS: [&str; 7] = [
    "peak_pressure",
    "peak_pressure_time",
    "peak_tension",
    "peak_temperature",
    "peak_strain_rate",
    "arrival_time",
    "plastic_energy",
];

/// Records are the extremes of what each particle shows step by step, and cost nothing where
/// nobody asks.
#[test]
fn peaks_are_the_extremes_of_all_steps() {
    let mut case = impact(false);
    case.output.fields = PEAKS.map(str::to_owned).to_vec();
    let mut simulation = start(case);
    let threshold = 1e-3 * simulation.case.materials[0].eos.bulk_modulus(2785.0);
    let arrival = simulation
        .case
        .measure
        .arrival_of(&simulation.case.materials[0]);
    assert!((arrival / threshold - 1.0).abs() < 0.02, "{arrival}");
    // Largest pressure and its time, largest tension, time of arrival.
    let mut seen: BTreeMap<u64, [f64; 4]> = BTreeMap::new();
    for _ in 0..50 {
        advance(&mut simulation, 1);
        let (particles, time) = (&simulation.particles, simulation.state.time);
        for i in 0..particles.owned() {
            let [most, when, tension, arrived] = seen.entry(particles.id[i]).or_default();
            let p = particles.pressure[i];
            if p > *most {
                (*most, *when) = (p, time);
            }
            *tension = tension.max(-p);
            if p > arrival && *arrived == 0.0 {
                *arrived = time;
            }
        }
    }
    let particles = &simulation.particles;
    let mut arrived = 0;
    for i in 0..particles.owned() {
        let kept = [
            particles.peak_pressure[i],
            particles.peak_pressure_time[i],
            particles.peak_tension[i],
            particles.arrival_time[i],
        ];
        assert_eq!(
            kept.map(f64::to_bits),
            seen[&particles.id[i]].map(f64::to_bits)
        );
        arrived += u32::from(kept[3] > 0.0);
    }
    assert!(
        arrived > 100 && (arrived as usize) < particles.owned(),
        "{arrived}"
    );
    let largest = particles
        .peak_strain_rate
        .iter()
        .fold(0.0_f64, |a, &b| a.max(b));
    assert!((1e6..1e9).contains(&largest), "{largest}");

    let plain = start(impact(false));
    assert!(plain.particles.peak_pressure.is_empty());
    assert!(plain.particles.arrival_time.is_empty());
    assert!(!plain.particles.plastic_energy.is_empty());
}
