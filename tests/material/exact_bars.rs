//! Bars by the program's own laws (`exact::bars`): against small strain, closed forms of the
//! first shocks, and what is conserved. Units: cm, µs, g/cm³, Mbar.

use crate::exact::elastic::{self, Joint};
use crate::exact::shocks::impact;
use crate::exact::{ALUMINIUM, STEEL, medium};
use exact::bars::{Bar, End, Row, Waves};
use material::LinearForm::{self, DensityRatio, Logarithmic};

/// Steel on aluminium at ±`velocity`.
fn row(form: LinearForm, velocity: f64, gap: f64) -> Row {
    let bar = |material, left, velocity| Bar {
        medium: medium(material, form),
        left,
        length: 0.4,
        velocity,
    };
    Row {
        bars: vec![
            bar(STEEL, 0.0, velocity),
            bar(ALUMINIUM, 0.4 + gap, -velocity),
        ],
        ends: [End::Free, End::Free],
    }
}

fn small_strain(row: &Row) -> elastic::Row {
    let bar = |bar: &Bar| elastic::Bar {
        modulus: bar.medium.p_wave_modulus(),
        density: bar.medium.reference_density,
        left: bar.left,
        length: bar.length,
        velocity: bar.velocity,
    };
    elastic::Row {
        bars: row.bars.iter().map(bar).collect(),
        joints: vec![Joint::Contact; row.bars.len() - 1],
        ends: row.ends.clone(),
    }
}

/// The largest share of the bars (by length) in which velocities differ by more than a hundredth
/// of the largest from those of small strain.
fn astray(row: &Row, time: f64, speed: f64) -> f64 {
    let exact = elastic::Waves::new(&small_strain(row), time);
    let mut share = 0.0;
    for (k, line) in Waves::new(row, time).profile().iter().enumerate() {
        for pair in line.windows(2) {
            let middle = 0.5 * (pair[0].position + pair[1].position);
            let bar = &row.bars[k];
            // To first order: displacements are small beside the fronts' own width here.
            let x = (middle - line[0].position).clamp(0.0, bar.length);
            let there = exact.at(k, x, time).velocity;
            let here = 0.5 * (pair[0].velocity + pair[1].velocity);
            if (here - there).abs() > 0.01 * speed {
                share += (pair[1].position - pair[0].position) / bar.length;
            }
        }
    }
    share
}

#[test]
fn small_impacts_are_those_of_small_strain() {
    for form in [Logarithmic, DensityRatio] {
        for gap in [0.0, 2e-6] {
            for time in [0.3, 0.9, 1.4, 3.0] {
                let share = astray(&row(form, 2e-6, gap), time, 2e-6);
                assert!(share < 2e-3, "{form:?}, gap {gap}, {time} us: {share}");
            }
        }
    }
}

#[test]
fn a_moved_end_sends_steps() {
    let mut row = row(Logarithmic, 0.0, 0.0);
    row.ends[0] = End::Moved(vec![(0.0, Some(1e-6)), (0.2, Some(0.0)), (0.5, None)]);
    for time in [0.1, 0.4, 1.0, 2.0] {
        let share = astray(&row, time, 1e-6);
        assert!(share < 2e-3, "{time} us: {share}");
    }
}

#[test]
fn the_first_shocks_are_those_of_the_closed_form() {
    for form in [Logarithmic, DensityRatio] {
        let row = row(form, 0.02, 0.0);
        let media = [&row.bars[0].medium, &row.bars[1].medium];
        let exact = impact(media, [0.02, -0.02]);
        let waves = Waves::new(&row, 0.5);
        let stress = waves.joint_stress(0).expect("the bars press");
        assert!((stress / exact.stress - 1.0).abs() < 1e-9, "{stress}");
        let steel = &waves.profile()[0];
        // Undisturbed steel, then shocked steel.
        let front = 0.02 * 0.5 + 0.4 - 0.5 * exact.shocks[0].speed;
        assert!((steel[1].position - front).abs() < 1e-9);
        assert!((steel[3].velocity - exact.interface_velocity).abs() < 1e-9);
        assert!((steel[3].stress() - exact.stress).abs() < 1e-9);
    }
}

#[test]
fn the_interface_is_released_by_the_fan_and_parts() {
    for (form, fan) in [
        (Logarithmic, [1.268, 1.283]),
        (DensityRatio, [1.253, 1.278]),
    ] {
        let row = row(form, 0.02, 0.0);
        let stress = |time| Waves::new(&row, time).joint_stress(0);
        let full = stress(1.0).expect("the bars press");
        assert_eq!(stress(fan[0] - 0.001), Some(full));
        // Part of it in the middle of the fan.
        let half = stress(0.5 * (fan[0] + fan[1])).unwrap() / full;
        assert!((0.1..0.9).contains(&half), "{half}");
        assert!(stress(fan[1] + 0.002).is_none(), "{form:?}");
    }
}

#[test]
fn momentum_stays_and_energy_goes_to_shocks_alone() {
    for form in [Logarithmic, DensityRatio] {
        let row = row(form, 0.02, 0.001);
        let [momentum, kinetic, _] = Waves::new(&row, 0.0).sums();
        for time in [0.5, 1.5, 3.0, 6.0] {
            let [p, k, strain] = Waves::new(&row, time).sums();
            assert!((p / momentum - 1.0).abs() < 1e-6, "{time}: {p}, {momentum}");
            // A shock heats by about a sixth of its strain, here to 5 %, of the energy it stores.
            let lost = 1.0 - (k + strain) / kinetic;
            assert!((-1e-6..0.01).contains(&lost), "{form:?}, {time}: {lost}");
        }
    }
}
