//! Elastic waves in bars against the figures of the paper's first two problems, computed
//! independently, and against what must hold for any bars.
//!
//! Units of this file: cm, µs, g/cm³, Mbar, in which `ρ c²` needs no factors.

use crate::exact::elastic::{Bar, End, Joint, Row, Waves};
use crate::exact::shocks::{Shocks, impact};
use crate::exact::{ALUMINIUM, STEEL, medium};
use material::LinearForm;
use proptest::prelude::*;

fn bar(material: [f64; 3], left: f64, length: f64, velocity: f64) -> Bar {
    let medium = medium(material, LinearForm::Logarithmic);
    Bar {
        modulus: medium.p_wave_modulus(),
        density: medium.reference_density,
        left,
        length,
        velocity,
    }
}

fn bars(joint: Joint) -> Row {
    Row {
        bars: vec![bar(STEEL, 0.0, 0.4, 0.02), bar(ALUMINIUM, 0.4, 0.4, -0.02)],
        joints: vec![joint],
        ends: [End::Free, End::Free],
    }
}

/// The steel bar of one metre, in two halves or whole, its left end moved.
fn wave(joints: Vec<Joint>, steps: &[(f64, f64)]) -> Row {
    let length = if joints.is_empty() { 100.0 } else { 50.0 };
    let bars = (0..=u32::try_from(joints.len()).unwrap())
        .map(|k| bar(STEEL, f64::from(k) * length, length, 0.0));
    Row {
        bars: bars.collect(),
        joints,
        ends: [
            End::Moved(steps.iter().map(|s| (s.0, Some(s.1))).collect()),
            End::Free,
        ],
    }
}

/// A figure printed to a number of digits holds to half a unit of the last one.
fn assert_printed(value: f64, printed: f64, unit: f64, what: &str) {
    assert!(
        (value - printed).abs() <= 0.5 * unit,
        "{what}: {value} is not {printed} as printed"
    );
}

/// Ends of the stretches with a stress beyond half of the plateau.
fn stressed(waves: &Waves, t: f64, plateau: f64) -> Vec<[f64; 2]> {
    let mut found: Vec<[f64; 2]> = Vec::new();
    for piece in waves.profile(t) {
        if piece.state.stress.abs() < 0.5 * plateau {
            continue;
        }
        match found.last_mut() {
            Some(last) if (last[1] - piece.from).abs() < 1e-9 => last[1] = piece.to,
            _ => found.push([piece.from, piece.to]),
        }
    }
    found
}

#[test]
fn steel_has_the_modulus_and_speed_of_the_problem() {
    let bar = bar(STEEL, 0.0, 1.0, 0.0);
    assert_printed(bar.modulus, 2.6847, 1e-4, "M");
    assert_printed(bar.wave_speed(), 0.58555, 1e-5, "c");
    assert_printed(
        self::bar(ALUMINIUM, 0.0, 1.0, 0.0).wave_speed(),
        0.61978,
        1e-5,
        "c",
    );
}

#[test]
fn a_step_runs_through_contact_as_through_a_whole_bar() {
    for joints in [vec![], vec![Joint::Bonded], vec![Joint::Contact]] {
        let waves = Waves::new(&wave(joints, &[(0.0, 0.001)]), 150.0);
        let plateau = 0.001 * (2.6847_f64 * 7.83).sqrt();
        let found = stressed(&waves, 128.8, plateau);
        assert_eq!(found.len(), 1);
        assert_printed(found[0][0], 0.0, 1e-9, "begin");
        assert_printed(found[0][1], 75.42, 0.01, "front");
        let behind = waves.at(0, 30.0, 128.8);
        assert_printed(behind.stress, -0.004_584_9, 1e-7, "plateau");
        assert!((behind.velocity - 0.001).abs() < 1e-15);
    }
}

#[test]
fn a_pulse_spans_what_it_was_given() {
    for joints in [vec![], vec![Joint::Bonded], vec![Joint::Contact]] {
        let waves = Waves::new(&wave(joints, &[(0.0, 0.001), (35.0, 0.0)]), 150.0);
        let found = stressed(&waves, 128.8, 0.004_584_9);
        assert_eq!(found.len(), 1);
        assert_printed(found[0][0], 54.9, 0.1, "tail");
        assert_printed(found[0][1], 75.4, 0.1, "front");
    }
}

#[test]
fn an_end_that_is_let_go_is_free() {
    // A push for a time, then no stress: what is left behind the pulse is at rest without stress,
    // as when the end is stopped; but the pulse from the far end comes back as from a free end.
    let mut row = wave(vec![], &[(0.0, 0.001)]);
    row.ends[0] = End::Moved(vec![(0.0, Some(0.001)), (35.0, None)]);
    let waves = Waves::new(&row, 600.0);
    let found = stressed(&waves, 128.8, 0.004_584_9);
    assert_eq!(found.len(), 1);
    assert_printed(found[0][1] - found[0][0], 35.0 * 0.58555, 1e-3, "length");
    let momentum = 0.001 * 35.0 * (2.6847_f64 * 7.83).sqrt();
    let mass = 7.83 * 100.0;
    for t in [100.0, 300.0, 600.0] {
        assert!((waves.mean_velocity(0, t) * mass / momentum - 1.0).abs() < 1e-4);
    }
}

#[test]
fn bars_of_two_metals_meet_and_part() {
    let waves = Waves::new(&bars(Joint::Contact), 5.0);
    let first = waves.joint(0)[0];
    assert_printed(first.stress, -0.04904, 1e-5, "stress");
    assert_printed(first.velocities[0], 0.009_304, 1e-6, "velocity");
    let separation = waves.separation(0).unwrap();
    assert_printed(separation, 1.2908, 1e-4, "release");
    assert_printed(waves.mean_velocity(1, 4.0), 0.03861, 1e-5, "aluminium");
    assert_printed(waves.mean_velocity(0, 4.0), -0.00021, 1e-5, "steel");
    // They never meet again: nothing is recorded after the parting but growing gaps.
    assert!(
        waves
            .joint(0)
            .iter()
            .all(|l| l.time <= separation + 1e-9 || l.stress == 0.0)
    );
}

#[test]
fn profiles_at_the_times_of_the_paper() {
    let waves = Waves::new(&bars(Joint::Contact), 5.0);
    let stress = |x: f64, t: f64| {
        let bar = usize::from(x > 0.4);
        waves.at(bar, x - if bar == 1 { 0.4 } else { 0.0 }, t)
    };
    // t = 0.48: fronts at 0.119 and 0.4 + 0.297.
    let found = stressed(&waves, 0.48, 0.049);
    assert_eq!(found.len(), 1);
    assert_printed(found[0][0], 0.119, 1e-3, "front in steel");
    assert_printed(found[0][1] - 0.4, 0.297, 1e-3, "front in aluminium");
    assert!((stress(0.1, 0.48).velocity - 0.02).abs() < 1e-15);
    // t = 1.0: released from both free ends.
    let found = stressed(&waves, 1.0, 0.049);
    assert_eq!(found.len(), 1);
    assert_printed(found[0][0], 0.186, 1e-3, "release in steel");
    assert_printed(found[0][1] - 0.4, 0.180, 1e-3, "release in aluminium");
    assert_printed(stress(0.1, 1.0).velocity, -0.00139, 1e-5, "released steel");
    // t = 3.0: apart; a tensile pulse in the steel, the aluminium without stress.
    let found = stressed(&waves, 3.0, 0.049);
    assert_eq!(found.len(), 1);
    assert_printed(found[0][0], 0.199, 1e-3, "pulse begins");
    assert_printed(found[0][1], 0.243, 1e-3, "pulse ends");
    let pulse = stress(0.22, 3.0);
    assert_printed(pulse.stress, 0.04904, 1e-5, "tension");
    assert_printed(pulse.velocity, 0.0093, 1e-4, "velocity in the pulse");
    assert_printed(stress(0.1, 3.0).velocity, -0.00139, 1e-5, "elsewhere");
    for x in [0.41, 0.6, 0.79] {
        assert!(stress(x, 3.0).stress.abs() < 1e-15);
    }
}

#[test]
fn bonded_bars_pull_each_other_back() {
    let waves = Waves::new(&bars(Joint::Bonded), 3.0);
    assert!(
        waves
            .separation(0)
            .is_some_and(|t| (t - 1.2908).abs() < 1e-4)
    );
    assert!(waves.joint(0).iter().any(|link| link.stress > 0.04));
    assert!(
        waves
            .joint(0)
            .iter()
            .all(|link| link.velocities[0] == link.velocities[1])
    );
}

#[test]
fn a_gap_closes_and_closes_again() {
    // The middle of three equal bars bounces between the other two, whose far ends are held: on
    // its way for 0.1/0.02 = 5, then 10 and 10, in contact for four transits T each time: the
    // wave runs to both far ends and back, is doubled by the held one, and comes back once more.
    let held = || End::Moved(vec![(0.0, Some(0.0))]);
    let row = Row {
        bars: vec![
            bar(STEEL, 0.0, 1.0, 0.0),
            bar(STEEL, 1.1, 1.0, 0.02),
            bar(STEEL, 2.2, 1.0, 0.0),
        ],
        joints: vec![Joint::Contact; 2],
        ends: [held(), held()],
    };
    let waves = Waves::new(&row, 60.0);
    let changes = |joint: usize| -> Vec<f64> {
        let mut pressed = false;
        let links = waves.joint(joint).iter();
        let changed = links.filter(|link| {
            std::mem::replace(&mut pressed, link.stress < 0.0) != (link.stress < 0.0)
        });
        changed.map(|link| link.time).collect()
    };
    let contact = 4.0 * row.bars[0].transit();
    let close = |found: &[f64], expected: &[f64]| {
        found.len() == expected.len()
            && found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-9)
    };
    let first = [5.0, 5.0 + contact];
    let second = [15.0 + contact, 15.0 + 2.0 * contact];
    let third = [25.0 + 2.0 * contact, 25.0 + 3.0 * contact];
    assert!(
        close(&changes(1)[..4], &[first, third].concat()),
        "{:?}",
        changes(1)
    );
    assert!(close(&changes(0)[..2], &second), "{:?}", changes(0));
    assert!((waves.separation(1).unwrap() - first[1]).abs() < 1e-9);
    assert!((waves.mean_velocity(1, 0.5 * (first[1] + second[0])) + 0.02).abs() < 1e-12);
}

#[test]
fn a_displacement_is_the_integral_of_the_velocity() {
    let waves = Waves::new(&bars(Joint::Contact), 5.0);
    for (k, x) in [(0, 0.05), (0, 0.33), (1, 0.0), (1, 0.21)] {
        let steps = 200_000;
        let dt = 3.0 / f64::from(steps);
        let middle = |n: u32| (f64::from(n) + 0.5) * dt;
        let sum: f64 = (0..steps)
            .map(|n| waves.at(k, x, middle(n)).velocity * dt)
            .sum();
        // Each of some ten jumps falls into one interval.
        assert!((waves.displacement(k, x, 3.0) - sum).abs() < 10.0 * 0.04 * dt);
    }
}

proptest! {
    #[test]
    fn energy_and_momentum_stay_and_nothing_pulls_or_overlaps(
        moduli in [0.1..3.0_f64, 0.1..3.0, 0.1..3.0],
        densities in [1.0..10.0_f64, 1.0..10.0, 1.0..10.0],
        lengths in [0.2..2.0_f64, 0.2..2.0, 0.2..2.0],
        velocities in [-0.03..0.03_f64, -0.03..0.03, -0.03..0.03],
        gap in 0.0..0.1_f64,
    ) {
        let mut left = 0.0;
        let bars: Vec<Bar> = (0..3).map(|k| {
            let bar = Bar {
                modulus: moduli[k],
                density: densities[k],
                left,
                length: lengths[k],
                velocity: velocities[k],
            };
            left += bar.length + gap;
            bar
        }).collect();
        let row = Row {
            bars: bars.clone(),
            joints: vec![Joint::Contact; 2],
            ends: [End::Free, End::Free],
        };
        let waves = Waves::new(&row, 30.0);
        let mass = |k: usize| bars[k].density * bars[k].length;
        let momentum = |t: f64| (0..3).map(|k| mass(k) * waves.mean_velocity(k, t)).sum::<f64>();
        let energy = |t: f64| waves.energies(t).iter().sum::<f64>();
        let scale: f64 = (0..3).map(|k| mass(k) * 0.03).sum();
        for t in [0.3, 3.0, 11.0, 30.0] {
            prop_assert!((momentum(t) - momentum(0.0)).abs() < 1e-9 * scale);
            prop_assert!((energy(t) / energy(0.0) - 1.0).abs() < 1e-8, "{}", energy(t) / energy(0.0));
            for k in 0..2 {
                let faces = waves.displacement(k + 1, 0.0, t) - waves.displacement(k, bars[k].length, t);
                prop_assert!(gap + faces > -1e-9, "overlap {}", gap + faces);
            }
        }
        for k in 0..2 {
            prop_assert!(waves.joint(k).iter().all(|link| link.stress <= 0.0 && link.gap >= -1e-12));
        }
    }
}

#[test]
fn the_programs_laws_shock_and_release() {
    let table = [
        (LinearForm::Logarithmic, 0.04953, 0.009_247, [1.268, 1.283]),
        (LinearForm::DensityRatio, 0.04985, 0.009_208, [1.253, 1.278]),
    ];
    for (form, stress, velocity, fan) in table {
        let [steel, aluminium] = [STEEL, ALUMINIUM].map(|m| medium(m, form));
        let result = impact([&steel, &aluminium], [0.02, -0.02]);
        assert_printed(result.stress, -stress, 1e-5, "stress");
        assert_printed(result.interface_velocity, velocity, 1e-6, "velocity");
        let release = aluminium.release(&result.shocks[1], 0.4);
        assert_printed(release.head, fan[0], 1e-3, "head");
        assert_printed(release.tail, fan[1], 1e-3, "tail");
    }
}

#[test]
fn the_laws_hold_their_jumps_and_integrals() {
    for form in [LinearForm::Logarithmic, LinearForm::DensityRatio] {
        for shear in [0.0, 0.8] {
            let mut steel = medium(STEEL, form);
            steel.shear_modulus = shear;
            let shock = steel.shock(0.05);
            let momentum = steel.reference_density * shock.speed * shock.particle_velocity;
            assert!((shock.stress / -momentum - 1.0).abs() < 1e-12);
            assert!((shock.speed * (1.0 - shock.stretch) / 0.05 - 1.0).abs() < 1e-12);
            // C² = σ′/ρ₀ and L = ∫ C dλ, by differences.
            for stretch in [0.8, 0.95, 1.0, 1.1] {
                let slope = |f: &dyn Fn(f64) -> f64| (f(stretch + 1e-5) - f(stretch - 1e-5)) / 2e-5;
                let c = steel.wave_speed(stretch);
                let stress = slope(&|l| steel.stress(l)) / steel.reference_density;
                assert!((stress / (c * c) - 1.0).abs() < 1e-8);
                assert!((slope(&|l| steel.riemann_integral(l)) / c - 1.0).abs() < 1e-8);
            }
            assert_eq!(steel.riemann_integral(1.0), 0.0);
            // A weak shock and its release are acoustic.
            let weak = steel.shock(1e-7);
            let c = (steel.p_wave_modulus() / steel.reference_density).sqrt();
            assert!((weak.speed / c - 1.0).abs() < 1e-6);
            assert!((steel.release_velocity(&weak) / 1e-7 - 1.0).abs() < 1e-6);
        }
    }
}
