//! Absorbing zones: what of a wave comes back from the end of a body, against a body that goes on,
//! and that what goes is booked.

use crate::physics_support::absorbing::{Packet, Wave, returned};
use crate::physics_support::{inline, run_with, start};
use engine::step::Simulation;

/// What may come back of a wave at a right angle, over its amplitude.
const NORMAL: f64 = 0.02;
/// What may come back of one at 45°, whatever it has become.
const SLANTED: f64 = 0.05;

/// A bar of `length` spacings, 100 of it as the gauge's side, whose first particle moves for as long as
/// a wave of so many spacings takes to pass.
fn bar(length: usize, wave: f64, form: &str, zone: &str) -> Simulation {
    // c = 6 km/s with 1 mm.
    let t = wave / 6.0;
    start(inline(&format!(
        r#"
dimension = 1
spacing = "1 mm"
sph = {{ form = "{form}", alpha = 0.3 }}
run.end_time = "1 ms"
material.a.density = "2 g/cm^3"
material.a.eos.linear = {{ bulk_modulus = "52 GPa", form = "logarithmic" }}
material.a.strength.elastic.shear_modulus = "15 GPa"
[[body]]
name = "bar"
material = "a"
shape.box = {{ lower = [0], upper = ["{length} mm"] }}
[[load]]
body = "bar"
below.x = "1 spacing"
velocity = {{ times = [0, "{} us", "{t} us"], x = [0, "10 m/s", 0] }}
{zone}
"#,
        0.5 * t
    )))
}

/// Velocities (m/s) of the particles 50 to 60 of a bar in each step until `time` (s).
fn histories(mut s: Simulation, time: f64) -> Vec<Vec<f64>> {
    let mut rows = Vec::new();
    run_with(&mut s, time, |s| {
        let mut row = vec![0.0; 10];
        for i in 0..s.particles.owned() {
            if let Some(k) = s.particles.id[i].checked_sub(50)
                && k < 10
            {
                row[usize::try_from(k).unwrap()] = s.particles.velocity[i][0];
            }
        }
        rows.push(row);
    });
    rows
}

/// Pulses from a fifth of the zone's depth to six times that come back by a hundredth, in each form.
#[test]
fn a_pulse_on_a_bar() {
    let zone = "[[absorb]]\nbody = \"bar\"\nfaces = [\"+x\"]";
    for (form, waves) in [
        ("corrected", &[8.0, 30.0, 180.0][..]),
        ("conventional", &[30.0]),
        ("normalised", &[30.0]),
        ("stress_points", &[30.0]),
    ] {
        for &wave in waves {
            let time = (300.0 + wave) / 6.0 * 1e-6;
            let ours = histories(bar(130, wave, form, zone), time);
            let theirs = histories(bar(360, wave, form, ""), time);
            let steps = ours.len().min(theirs.len());
            let (mut off, mut top) = (0.0_f64, 0.0_f64);
            for n in 0..steps {
                for k in 0..10 {
                    off = off.max((ours[n][k] - theirs[n][k]).abs());
                    top = top.max(theirs[n][k].abs());
                }
            }
            println!("{form}, {wave} spacings: {:.4} of {top:.2} m/s", off / top);
            assert!(off < NORMAL * top, "{form}: {off} of {top}");
        }
    }
}

/// A transverse wave at a right angle, as long as .8 of the zone's depth.
#[test]
#[ignore = "slow"]
fn packets_in_a_plane() {
    comes_back_by(Wave::S, 0.0, NORMAL);
}

/// The same at 45°, and a longitudinal one.
#[test]
#[ignore = "slow: more packets"]
fn slanted_packets_in_a_plane() {
    comes_back_by(Wave::P, 45.0, SLANTED);
    comes_back_by(Wave::S, 45.0, SLANTED);
}

fn comes_back_by(wave: Wave, angle: f64, bound: f64) {
    let packet = Packet {
        wave,
        angle,
        length: 10.0,
        depth: 12.5,
        form: "corrected",
    };
    let back = returned(&packet);
    assert!(back < bound, "{packet:?}: {back}");
}

/// The zone of a bar takes up what the load has put in, momentum with it, and both balances hold to
/// round-off.
#[test]
fn what_goes_is_booked() {
    let zone = "[[absorb]]\nbody = \"bar\"\nfaces = [\"+x\"]\ndepth = \"24 spacing\"";
    for form in ["corrected", "conventional", "stress_points"] {
        let mut s = bar(120, 60.0, form, zone);
        let mut put_in = 0.0;
        run_with(&mut s, 11e-6, |s| put_in = s.state.loads[0].work);
        run_with(&mut s, 60e-6, |_| {});
        let state = &s.state;
        let (load, zone) = (&state.loads[0], &state.loads[1]);
        let worst = &state.worst;
        println!(
            "{form}: put in {put_in} J, taken out {} J, {worst:?}",
            zone.work
        );
        assert!(worst.energy_error < 1e-13, "{:e}", worst.energy_error);
        assert!(worst.momentum_error[0] < 1e-13);
        assert!(state.totals.kinetic_energy < 1e-4 * put_in);
        // Artificial viscosity keeps some as heat in the bar.
        let share = -zone.work / put_in;
        assert!((0.9..1.0).contains(&share), "{share}");
        // The momentum has gone the same way, but for what the bar, held at rest, has sent back.
        let left = (load.impulse[0] + zone.impulse[0]) / load.impulse[0];
        assert!(left.abs() < 0.01, "{left}");
        assert_eq!(state.totals.yielded_mass, 0.0);
    }
}
