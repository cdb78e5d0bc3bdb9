//! Absorbing zones of the default depth: wave lengths and angles, and a crater in a target of half the
//! width.

use crate::physics_support::absorbing::{Packet, Wave, returned};
use crate::physics_support::{inline, start};
use comm::Comm;
use engine::step::measurements;

/// Packets of .4 and .8 of the depth of the default zone, of which .05 and less come back at 45°.
#[test]
#[ignore = "slow"]
fn packets_on_the_default_zone() {
    for (wave, angle, length, bound) in [
        (Wave::P, 45.0, 12.0, 0.05),
        (Wave::S, 45.0, 12.0, 0.05),
        (Wave::P, 0.0, 24.0, 0.02),
        (Wave::P, 45.0, 24.0, 0.05),
        (Wave::S, 0.0, 24.0, 0.02),
        (Wave::S, 45.0, 24.0, 0.05),
    ] {
        let packet = Packet {
            wave,
            angle,
            length,
            depth: 30.0,
            form: "corrected",
        };
        let back = returned(&packet);
        assert!(back < bound, "{packet:?}: {back}");
    }
}

/// Pressures (Pa) by time (s) under an impact on a target so many spacings wide and deep, of a quarter
/// model.
fn gauge(width: usize, zone: &str, end: f64) -> Vec<[f64; 2]> {
    let mut s = start(inline(&format!(
        r#"
dimension = 3
spacing = "0.1 mm"
run.end_time = "10 us"
material.a.library = "aluminium-2024"
[[symmetry]]
axis = "x"
[[symmetry]]
axis = "y"
[[body]]
name = "target"
material = "a"
shape.box = {{ lower = [0, 0, "-{width} spacing"], upper = ["{width} spacing", "{width} spacing", 0] }}
lattice = "cubic"
[[body]]
name = "ball"
material = "a"
shape.sphere = {{ radius = "0.2 mm", centre = [0, 0, "0.25 mm"] }}
lattice = "cubic"
velocity = [0, 0, "-2 km/s"]
touch = {{ body = "target", direction = "-z" }}
{zone}
"#
    )));
    let place = [0.05e-3, 0.05e-3, -0.95e-3];
    let is_there = |x: &[f64; 3]| (0..3).all(|a| (x[a] - place[a]).abs() < 1e-6);
    let at = (0..s.particles.owned()).find(|&i| is_there(&s.particles.position[i]));
    let id = s.particles.id[at.expect("a particle")];
    let comm = Comm::solo();
    let mut rows = Vec::new();
    while s.state.time < end {
        s.advance(&comm).expect("a step");
        let i = s.particles.id.iter().position(|&other| other == id);
        rows.push([s.state.time, s.particles.pressure[i.expect("the same")]]);
    }
    measurements::diagnose(&mut s, &comm);
    let state = &s.state;
    println!(
        "{width} spacings: {} particles, {} steps, {:.3e} kg yielded in the zone, energy error {:e}, {:?}",
        s.particles.owned(),
        state.step,
        state.totals.yielded_mass,
        state.worst.energy_error,
        state.loads
    );
    assert_eq!(state.totals.yielded_mass, 0.0);
    rows
}

/// Largest distance of one history from another, which goes on for longer (Pa): in all, and in its
/// last fifth.
fn apart(one: &[[f64; 2]], other: &[[f64; 2]]) -> [f64; 2] {
    let at = |t: f64| {
        let k = other.partition_point(|row| row[0] < t);
        let k = k.clamp(1, other.len() - 1);
        let [a, b] = [other[k - 1], other[k]];
        a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0])
    };
    let off: Vec<f64> = one.iter().map(|row| (row[1] - at(row[0])).abs()).collect();
    let largest = |off: &[f64]| off.iter().copied().fold(0.0, f64::max);
    [largest(&off), largest(&off[off.len() * 4 / 5..])]
}

/// The pressure under a crater, in a target of 28 spacings with zones from 16 on against one of 56
/// without, as long as nothing has come back from the ends of that; and without zones. What is left
/// is slow: near its source a wave has a part that no zone carries. It dies down, and the model
/// without zones rings on.
#[test]
#[ignore = "slow"]
fn a_crater_in_half_the_width() {
    // From the surface to the far end and back to the gauge at 6.4 km/s.
    let end = (56.0 + 46.0) * 0.1e-3 / 6.4e3;
    let faces = r#"faces = ["+x", "+y", "-z"]"#;
    let zone = format!("[[absorb]]\nbody = \"target\"\n{faces}\ndepth = \"12 spacing\"");
    let theirs = gauge(56, "", 1.05 * end);
    let ours = gauge(28, &zone, end);
    let free = gauge(28, "", end);
    let peak = theirs.iter().fold(0.0, |most: f64, row| most.max(row[1]));
    let [ours, free] = [ours, free].map(|rows| apart(&rows, &theirs).map(|off| off / peak));
    println!("peak {peak:e} Pa; off by {ours:.4?} of it with a zone, {free:.4?} without");
    assert!(
        ours[0] < 0.055 && ours[0] < 0.5 * free[0],
        "{ours:?}, {free:?}"
    );
    assert!(
        ours[1] < 0.025 && ours[1] < 0.3 * free[1],
        "{ours:?}, {free:?}"
    );
}
