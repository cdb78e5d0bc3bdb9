//! Two blocks that a joint holds together: what it bears, what it takes to come apart, and that a turn strains it not.

use comm::Comm;
use engine::step::{Simulation, measurements};

use crate::physics_support::{inline, start};

/// Strength in tension, in shear (Pa), and energy (J/m²).
const STRENGTHS: [f64; 2] = [30e6, 20e6];
const ENERGY: f64 = 600.0;

/// Blocks of 10 x 10 x 6 mm on each other, whose ends are held and pulled along an axis (m/s).
fn blocks(spacing: &str, held: &str, pulled: &str, joint: &str) -> Simulation {
    start(inline(&format!(
        r#"title = "Joint"
dimension = 3
spacing = "{spacing}"
[run]
end_time = "300 us"
[material.aluminium]
library = "aluminium-6061"
[[body]]
name = "lower"
material = "aluminium"
shape.box = {{ lower = ["-5 mm", "-5 mm", "-6 mm"], upper = ["5 mm", "5 mm", 0] }}
[[body]]
name = "upper"
material = "aluminium"
shape.box = {{ lower = ["-5 mm", "-5 mm", 0], upper = ["5 mm", "5 mm", "6 mm"] }}
[[contact.pair]]
bodies = ["lower", "upper"]
joint = {{ {joint} }}
[[load]]
body = "lower"
below = {{ z = "-3 mm" }}
velocity = {held}
[[load]]
body = "upper"
above = {{ z = "3 mm" }}
velocity = {pulled}
"#
    )))
}

/// The largest force of contact along an axis (N), and its heat (J), until the joint has come apart with no more than an
/// error of energy.
fn torn(mut simulation: Simulation, axis: usize, error: f64) -> [f64; 2] {
    let comm = Comm::solo();
    let mut peak = 0.0_f64;
    while !simulation.is_finished() {
        simulation.advance(&comm).expect("a step");
        measurements::diagnose(&mut simulation, &comm);
        peak = peak.max(simulation.state.pairs[0].force[axis].abs());
    }
    let worst = &simulation.state.worst;
    println!(
        "energy error {:e}, defect {:e}",
        worst.energy_error, worst.contact_defect
    );
    assert!(worst.energy_error < error, "{:e}", worst.energy_error);
    let joint = &simulation.particles.joint_damage;
    assert!(joint.iter().any(|&damage| damage > 0.99));
    [peak, simulation.state.contact_heat()]
}

#[test]
fn it_bears_its_strengths_and_takes_its_energy() {
    let joint = r#"strength = "30 MPa", shear_strength = "20 MPa", energy = "600 J/m^2""#;
    let area = 1e-4;
    let ways = [
        ("{ z = 0 }", r#"{ z = "0.2 m/s" }"#, 2, STRENGTHS[0]),
        (
            "{ x = 0, y = 0, z = 0 }",
            r#"{ x = "0.3 m/s", y = 0, z = 0 }"#,
            0,
            STRENGTHS[1],
        ),
    ];
    for (held, pulled, axis, strength) in ways {
        let [peak, heat] = torn(blocks("2 mm", held, pulled, joint), axis, 3e-5);
        let (peak, heat) = (peak / (strength * area), heat / (ENERGY * area));
        println!("axis {axis}: force {peak}, energy {heat}");
        // At five particles across; at ten .997 and .954 of the force, 1.02 and 1.03 of the energy.
        assert!(
            (peak - 1.0).abs() < 0.1 && (heat - 1.0).abs() < 0.05,
            "{peak} {heat}"
        );
    }
}

/// Pressed together by some 1e8 Pa as they slide, which bonds do not hold: a joint that comes apart takes no more.
#[test]
fn it_takes_no_more_under_pressure() {
    let joint = r#"strength = "30 MPa", shear_strength = "20 MPa", energy = "600 J/m^2""#;
    let held = "{ x = 0, y = 0, z = 0 }";
    let pulled = r#"{ x = "0.3 m/s", y = 0, z = "-0.03 m/s" }"#;
    let [_, heat] = torn(blocks("2 mm", held, pulled, joint), 0, 3e-5);
    let heat = heat / (ENERGY * 1e-4);
    println!("energy {heat}");
    assert!((heat - 1.0).abs() < 0.05, "{heat}");
}

#[test]
fn without_an_energy_it_breaks_at_once() {
    let joint = r#"strength = "30 MPa""#;
    // It runs apart within ten steps, whose speeds are known at their ends alone.
    let simulation = blocks("2 mm", "{ z = 0 }", r#"{ z = "0.2 m/s" }"#, joint);
    let [peak, heat] = torn(simulation, 2, 6e-3);
    println!("force {}, energy {} J/m^2", peak / 1e-4, heat / 1e-4);
    // It breaks where stress is greatest first: .78 of the strength on the mean, .74 and .78 at half and a quarter of the spacing.
    assert!((peak / (STRENGTHS[0] * 1e-4) - 0.77).abs() < 0.05, "{peak}");
    // What the bonds hold at the strength: S²/(2 K).
    let stored = STRENGTHS[0] * STRENGTHS[0] * 2e-3 / 110e9;
    assert!((heat / (stored * 1e-4) - 1.0).abs() < 0.15, "{heat}");
}

/// Joined bars turn by 69 degrees: they stay one, and nothing gives way.
#[test]
fn joined_bodies_that_spin_stay_whole() {
    let mut simulation = start(inline(
        r#"title = "Spin"
dimension = 3
spacing = "1.5 mm"
[run]
end_time = "300 us"
[material.aluminium]
library = "aluminium-6061"
[[body]]
name = "left"
material = "aluminium"
shape.box = { lower = ["-15 mm", "-3 mm", "-3 mm"], upper = [0, "3 mm", "3 mm"] }
velocity = ["-4000 /s * y", "4000 /s * x", 0]
[[body]]
name = "right"
material = "aluminium"
shape.box = { lower = [0, "-3 mm", "-3 mm"], upper = ["15 mm", "3 mm", "3 mm"] }
velocity = ["-4000 /s * y", "4000 /s * x", 0]
[[contact.pair]]
bodies = ["left", "right"]
joint.strength = "30 MPa"
"#,
    ));
    let comm = Comm::solo();
    while !simulation.is_finished() {
        simulation.advance(&comm).expect("a step");
        measurements::diagnose(&mut simulation, &comm);
    }
    let worst = &simulation.state.worst;
    println!(
        "energy {:e}, {:?}",
        worst.energy_error, worst.angular_momentum_error
    );
    assert!(worst.energy_error < 1e-6, "{:e}", worst.energy_error);
    assert!(worst.angular_momentum_error.iter().all(|&e| e < 1e-12));
    assert!(
        simulation
            .particles
            .joint_damage
            .iter()
            .all(|&damage| damage == 0.0)
    );
    let middle = |body: u32| {
        let all = &simulation.particles;
        let of = (0..all.owned()).filter(|&i| all.body[i] == body);
        let places: Vec<[f64; 3]> = of.map(|i| all.position[i]).collect();
        let sum = |a: usize| places.iter().map(|x| x[a]).sum::<f64>();
        #[allow(clippy::cast_precision_loss, reason = "few particles")]
        [0, 1].map(|a| sum(a) / places.len() as f64)
    };
    let [x, y] = [0, 1].map(|a| middle(1)[a] - middle(0)[a]);
    assert!((x.hypot(y) / 15e-3 - 1.0).abs() < 1e-3, "{x} {y}");
}
