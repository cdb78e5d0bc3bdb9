//! What contact must show (physics page, section 5), at small scale.

use crate::physics_support::{inline, ready, run_with, start};
use comm::Comm;
use engine::step::Simulation;

/// Particles of every body keep their bits when nothing moves.
fn assert_at_rest(text: &str) {
    let mut s = start(inline(text));
    let before = s.particles.clone();
    let forced = |s: &Simulation| {
        s.particles
            .contact_acceleration
            .iter()
            .filter(|a| **a != [0.0; 3])
            .count()
    };
    assert_eq!(forced(&s), 0, "a force at the start");
    assert!(
        s.particles.foreign_fraction.iter().any(|&f| f > 0.1),
        "no touch"
    );
    for _ in 0..5 {
        s.advance(&Comm::solo()).expect("a step");
        assert_eq!(forced(&s), 0, "a force in step {}", s.state.step);
    }
    assert!(s.particles.velocity.iter().all(|v| *v == [0.0; 3]));
    assert_eq!(s.state.contact_energy.to_bits(), 0);
    let mut old: Vec<_> = before.id.iter().zip(&before.position).collect();
    let mut new: Vec<_> = s.particles.id.iter().zip(&s.particles.position).collect();
    old.sort_by_key(|row| row.0);
    new.sort_by_key(|row| row.0);
    assert_eq!(old, new);
}

#[test]
fn bodies_laid_in_touch_stay_free_of_force() {
    for dimension in 1..=3_usize {
        let text = |values: [&str; 3]| format!("[{}]", values[..dimension].join(", "));
        let size = text(["\"8 mm\"", "\"6 mm\"", "\"4 mm\""]);
        assert_at_rest(&format!(
            r#"
dimension = {dimension}
spacing = "1 mm"
[run]
end_time = "1 us"
[material.aluminium]
library = "aluminium-2024"
[[body]]
name = "a"
material = "aluminium"
shape.box = {{ size = {size} }}
[[body]]
name = "b"
material = "aluminium"
shape.box = {{ size = {size} }}
touch = {{ body = "a", direction = "+x" }}
"#
        ));
    }
}

/// Curved, turned and unequal lattices meet the touching value of none of them, and are relieved.
#[test]
fn any_face_in_touch_starts_free_of_force() {
    assert_at_rest(
        r#"
dimension = 3
spacing = "1 mm"
[run]
end_time = "1 us"
[material.aluminium]
library = "aluminium-2024"
[material.copper]
library = "copper"
[[body]]
name = "plate"
material = "aluminium"
shape.box = { size = ["14 mm", "14 mm", "4 mm"] }
[[body]]
name = "ball"
material = "copper"
lattice = "hexagonal"
spacing = "0.8 mm"
shape.sphere = { centre = [0, 0, "9 mm"], radius = "4 mm" }
touch = { body = "plate", direction = "-z" }
[[body]]
name = "block"
material = "copper"
lattice = { kind = "cubic", angle = "30 deg" }
shape.box = { centre = [0, 0, "-9 mm"], size = ["8 mm", "8 mm", "4 mm"] }
touch = { body = "plate", direction = "+z" }
"#,
    );
}

/// Glass has no faces of a lattice; the sizes of a graded body differ along its face.
#[test]
fn glass_and_graded_bodies_in_touch_start_free_of_force() {
    let graded =
        "spacing = { inner = \"1 mm\", outer = \"3 mm\", at = [0, 0, \"4 mm\"], ratio = 1.3 }";
    for (a, b) in [
        (
            "lattice = \"glass\"",
            "lattice = { kind = \"glass\", seed = 4 }",
        ),
        ("lattice = \"glass\"", "lattice = \"cubic\""),
        (graded, "lattice = \"glass\""),
        (graded, "lattice = \"hexagonal\""),
        (graded, graded),
    ] {
        assert_at_rest(&format!(
            r#"
dimension = 3
spacing = "1 mm"
[run]
end_time = "1 us"
[material.aluminium]
library = "aluminium-2024"
[[body]]
name = "a"
material = "aluminium"
shape.box = {{ size = ["20 mm", "14 mm", "8 mm"] }}
{a}
[[body]]
name = "b"
material = "aluminium"
shape.box = {{ size = ["16 mm", "10 mm", "5 mm"], centre = [0, 0, "9 mm"] }}
{b}
touch = {{ body = "a", direction = "-z" }}
"#
        ));
    }
}

/// A copper ball on the seam of two different plates: the case in which a pair force of a
/// fraction-weighted energy could change its sign.
const SEAM: &str = r#"
dimension = 3
spacing = "0.1 mm"
[run]
end_time = "1 us"
[material.aluminium]
library = "aluminium-2024"
[material.steel]
library = "steel-304"
[material.copper]
library = "copper"
[[body]]
name = "left"
material = "aluminium"
shape.box = { lower = ["-1 mm", "-0.8 mm", "-0.4 mm"], upper = [0, "0.8 mm", 0] }
lattice = "cubic"
[[body]]
name = "right"
material = "steel"
shape.box = { lower = [0, "-0.8 mm", "-0.4 mm"], upper = ["1 mm", "0.8 mm", 0] }
lattice = "cubic"
[[body]]
name = "ball"
material = "copper"
lattice = "hexagonal"
shape.sphere = { centre = ["0.03 mm", "0.01 mm", "0.6 mm"], radius = "0.4 mm" }
velocity = [0, 0, "-3 km/s"]
touch = { body = "left", direction = "-z" }
"#;

/// Smallest slope of a particle's contact energy by its fraction of another body, over the
/// largest: the pair force is the sum of two of these times a positive factor.
fn least_slope(s: &Simulation) -> (f64, f64) {
    let particles = &s.particles;
    let (mut least, mut most) = (0.0_f64, 0.0_f64);
    for i in (0..particles.owned()).filter(|&i| particles.contact_excess[i] > 0.0) {
        let body = particles.body[i] as usize;
        for other in (0..s.case.bodies.len()).filter(|&b| b != body) {
            let pair = s.contact().overlap(body, other);
            let (modulus, excess) = (particles.contact_modulus[i], particles.contact_excess[i]);
            let fraction = particles.foreign_fraction[i];
            let slope =
                modulus * excess * (1.0 - (pair.touching - particles.touching_value[i]) / fraction)
                    + 0.5 * excess * excess * (pair.modulus - modulus) / fraction;
            least = least.min(slope);
            most = most.max(slope);
        }
    }
    (least, most)
}

#[test]
fn every_pair_force_is_repulsive() {
    let mut s = start(inline(SEAM));
    let mut touched = false;
    run_with(&mut s, 0.3e-6, |s| {
        let (least, most) = least_slope(s);
        touched |= most > 0.0;
        assert!(least >= 0.0, "step {}: {least} of {most} Pa", s.state.step);
        for pair in s.state.pairs.iter().skip(1) {
            // The plates lie below the ball and are pushed down by it.
            assert!(pair.force[2] <= 0.0, "step {}: {pair:?}", s.state.step);
        }
    });
    let worst = &s.state.worst;
    println!("{} steps, {worst:?}", s.state.step);
    assert!(touched);
    assert_eq!(worst.interpenetrated, 0);
    assert!(worst.momentum_error.iter().all(|&e| e < 1e-12));
    assert!(worst.contact_defect < 0.001);
}

/// `potential` of the range "spacing": bodies laid in touch begin without force and energy, however
/// the round-off of their places falls, and part with the energy that they had.
#[test]
fn a_potential_of_the_spacing_begins_at_rest_and_keeps_energy() {
    let mode = ["contact.mode=potential", "contact.potential.range=spacing"];
    let soft = "contact.potential.stiffness=0.03";
    // Measured .0007, .0038 and .0009: errors of the step, as those of `overlap` are.
    for (name, most) in [
        ("bar-impact", 0.001),
        ("block-impact", 0.005),
        ("elastic-impact", 0.002),
    ] {
        let still = |case| {
            let s = start(case);
            let kinetic = s.state.initial.kinetic_energy;
            assert!(s.state.contact_energy.abs() < 1e-12 * kinetic, "{name}");
            let force = |a: &[f64; 3]| a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let contact = s.particles.contact_acceleration.iter().map(force);
            // That of one spacing within a body under a billionth of its modulus.
            let case = &s.case;
            let body = &case.bodies[0];
            let material = &case.materials[body.material];
            let unit =
                material.p_wave_modulus() / (case.initial_density(body) * body.lattice.spacing);
            let strongest = contact.fold(0.0, f64::max) / unit;
            assert!(strongest < 1e-9, "{name}: {strongest:e}");
            s
        };
        still(ready(name, &mode));
        let mut s = still(ready(name, &[mode[0], mode[1], soft]));
        run_with(&mut s, f64::INFINITY, |_| {});
        let worst = &s.state.worst;
        println!("{name}: {} steps, {worst:?}", s.state.step);
        assert_eq!(worst.interpenetrated, 0, "{name}");
        assert!(worst.energy_error < most, "{name}: {}", worst.energy_error);
    }
}

/// Sandstone under fast steel bears 2.5 times its modulus. With contact as soft as the stone at rest 21 particles of both
/// stood between those of the other for long.
#[test]
fn soft_stone_lets_no_fast_steel_in() {
    let mut s = start(inline(
        "dimension = 3\nspacing = \"0.5 mm\"\n[run]\nend_time = \"0.8 us\"\n\
         [material.stone]\nlibrary = \"sandstone\"\n[material.steel]\nlibrary = \"iron-armco-ductile\"\n\
         [[body]]\nname = \"stone\"\nmaterial = \"stone\"\n\
         shape.cylinder = { axis = \"z\", radius = \"8 mm\", length = \"5 mm\", centre = [0, 0, \"-2.5 mm\"] }\n\
         [[body]]\nname = \"sphere\"\nmaterial = \"steel\"\n\
         shape.sphere = { centre = [0, 0, \"3 mm\"], diameter = \"4 mm\" }\n\
         velocity = [\"1.5 km/s\", 0, \"-2.6 km/s\"]\n\
         touch = { body = \"stone\", direction = \"-z\" }\n",
    ));
    run_with(&mut s, f64::INFINITY, |_| {});
    let worst = &s.state.worst;
    println!("{} steps, {worst:?}", s.state.step);
    assert_eq!(worst.interpenetrated, 0);
    assert!(worst.energy_error < 2e-3, "{}", worst.energy_error);
}
