//! Self-contact: a body that has come apart collides with itself as two bodies do, also across a
//! symmetry plane, and a ring that is squashed carries on its inside.

use std::collections::BTreeSet;

use crate::physics_support::{inline, run_with, start};
use engine::step::Simulation;

const SOFT: &str = r#"
[material.soft]
density = "1 g/cm^3"
eos.linear = { bulk_modulus = "4 MPa" }
strength.elastic = { shear_modulus = "2 MPa" }
"#;

/// A block of 8 mm height between two places (mm).
fn block(name: &str, from: f64, to: f64) -> String {
    format!(
        "[[body]]\nname = \"{name}\"\nmaterial = \"soft\"\nform = \"updated\"\n\
         shape.box = {{ lower = [\"{from} mm\", 0], upper = [\"{to} mm\", \"8 mm\"] }}\n"
    )
}

/// Momentum (kg m/s) and kinetic energy (J) of what is left and what is right of the middle.
fn sides(s: &Simulation) -> [[f64; 2]; 2] {
    let mut sides = [[0.0; 2]; 2];
    for i in 0..s.particles.owned() {
        let (m, v) = (s.particles.mass[i], s.particles.velocity[i]);
        let side = &mut sides[usize::from(s.particles.position[i][0] > 0.0)];
        side[0] += m * v[0];
        side[1] += 0.5 * m * (v[0] * v[0] + v[1] * v[1]);
    }
    sides
}

fn parts(s: &Simulation) -> usize {
    s.particles.part.iter().collect::<BTreeSet<_>>().len()
}

/// A bar whose halves stand 3 mm apart and are thrown at each other is two bodies: their velocities
/// are set by hand, and the two halves of the one body moved by hand.
#[test]
fn halves_of_a_body_collide_like_two_bodies() {
    let [two, own, welded] = [
        (
            block("left", -13.5, -1.5) + &block("right", 1.5, 13.5),
            false,
        ),
        (block("bar", -12.0, 12.0), true),
        (block("bar", -12.0, 12.0), false),
    ]
    .map(|(bodies, self_contact)| {
        let apart = bodies.matches("[[body]]").count() == 2;
        let mut s = start(inline(&format!(
            "dimension = 2\nspacing = \"1 mm\"\nrun.end_time = \"3 ms\"\n\
             contact.self_contact = {self_contact}\n{SOFT}{bodies}"
        )));
        for i in 0..s.particles.owned() {
            let side = s.particles.position[i][0].signum();
            if !apart {
                s.particles.position[i][0] += 1.5e-3 * side;
            }
            for velocity in [
                &mut s.particles.velocity[i],
                &mut s.particles.predicted_velocity[i],
            ] {
                velocity[0] = -4.0 * side;
            }
        }
        let (mut least, mut contact) = (f64::INFINITY, 0.0_f64);
        run_with(&mut s, 3e-3, |s| {
            contact = contact.max(s.state.contact_energy);
            least = s.state.worst.closest.map_or(least, |c| least.min(c));
        });
        println!(
            "{self_contact}: sides {:?}, contact {contact:e} J, closest {least}, {} parts",
            sides(&s),
            parts(&s)
        );
        (sides(&s), contact, least, s)
    });
    assert_eq!(parts(&own.3), 2);
    for side in 0..2 {
        for k in 0..2 {
            let (a, b) = (two.0[side][k], own.0[side][k]);
            assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
        }
    }
    assert!((own.1 / two.1 - 1.0).abs() < 1e-9 && own.1 > 0.0);
    assert!(own.2 > 0.28);
    // They part. Without, the faces join in the sums.
    assert!(own.0[1][0] > 0.1 && own.0[0][0] + own.0[1][0] < 1e-12);
    assert!(welded.1 == 0.0 && (welded.0[1][0] / own.0[1][0] - 1.0).abs() > 0.01);
    let row = &own.3.state.pairs[0];
    assert!(row.impulse.iter().all(|j| j.abs() < 1e-12), "{row:?}");
}

/// A bar that is pulled apart until it tears on both sides of its middle, and thrown back, free; `right` alone is its right
/// half at a symmetry plane.
fn torn(right: bool, contact: &str) -> Simulation {
    let load = |side: &str, sign: f64| {
        let (there, back) = (2.5 * sign, -5.0 * sign);
        format!(
            "[[load]]\nbody = \"bar\"\n{side}\nuntil = \"1.2 ms\"\n\
             velocity = {{ times = [0, \"1 ms\", \"1 ms\"], x = [\"{there} m/s\", \
             \"{there} m/s\", \"{back} m/s\"], y = 0 }}\n"
        )
    };
    let mut text = format!(
        "dimension = 2\nspacing = \"1 mm\"\nrun.end_time = \"5 ms\"\n{contact}\n{SOFT}\
         failure.spall = {{ pressure = \"0 Pa\", after = \"hold\" }}\n{}{}",
        block("bar", -12.0, 12.0),
        load("above.x = \"1 mm\"", 1.0)
    );
    text += &if right {
        "[[symmetry]]\naxis = \"x\"\n".to_owned()
    } else {
        load("below.x = \"-1 mm\"", -1.0)
    };
    let mut s = start(inline(&text));
    run_with(&mut s, 5e-3, |_| {});
    println!(
        "{contact} {right}: {:?}, {} parts, {:?}",
        sides(&s),
        parts(&s),
        s.state.worst
    );
    assert!(s.state.worst.momentum_error.iter().all(|&e| e < 1e-12));
    s
}

#[test]
fn a_torn_bar_bounces_and_half_of_it_from_its_image() {
    let [welded, own] = ["", "contact.self_contact = true"].map(|contact| torn(false, contact));
    let half = torn(true, "contact.self_contact = true");
    assert_eq!((parts(&own), parts(&half)), (3, 2));
    let [[left, _], [right, energy]] = sides(&own);
    assert!(
        right > 0.2 && (left + right).abs() < 1e-12,
        "{left} {right}"
    );
    // Faces that join in the sums take most of the energy with them.
    assert!(sides(&welded)[1][1] < 0.3 * energy);
    let [_, [momentum, kinetic]] = sides(&half);
    assert!((momentum / right - 1.0).abs() < 1e-6, "{momentum} {right}");
    assert!((kinetic / energy - 1.0).abs() < 1e-6, "{kinetic} {energy}");
    for s in [&own, &half] {
        let worst = &s.state.worst;
        assert!(worst.closest.is_some_and(|c| c > 0.28) && worst.contact_defect < 0.01);
    }
}

/// Two discs press the sides of a thin ring together and let go. With folds its inside carries, and
/// it opens again.
#[test]
fn a_ring_that_is_squashed_carries_on_its_inside() {
    for (contact, carries) in [
        ("contact.self_contact = { folds = 8 }", true),
        ("contact.self_contact = true", false),
    ] {
        let disc = |sign: f64| {
            let speed = 2.04 * sign;
            format!(
                "[[surface]]\nshape.sphere = {{ radius = \"4 mm\", centre = [0, \"{} mm\"] }}\n\
                 motion = {{ times = [0, \"4 ms\", \"4 ms\"], y = [\"{} m/s\", \"{} m/s\", \
                 \"{speed} m/s\"] }}\n",
                14.1 * sign,
                -speed,
                -speed
            )
        };
        let mut s = start(inline(&format!(
            "dimension = 2\nspacing = \"0.5 mm\"\nrun.end_time = \"8 ms\"\n\
             sph.artificial_stress = 0.3\n{contact}\n{SOFT}[[body]]\nname = \"ring\"\n\
             material = \"soft\"\nshape.sphere = {{ radius = \"10 mm\", inner_radius = \"8 mm\" }}\n\
             {}{}",
            disc(1.0),
            disc(-1.0)
        )));
        let (mut energy, mut pressed) = (0.0_f64, 0.0_f64);
        run_with(&mut s, 8e-3, |s| {
            energy = s
                .state
                .pairs
                .first()
                .map_or(energy, |pair| energy.max(pair.energy));
            pressed = pressed.max(-s.state.loads[0].force[1]);
        });
        let opening = |s: &Simulation| {
            let inside = s.particles.position.iter().filter(|x| x[0].abs() < 2e-3);
            inside.map(|x| x[1].abs()).fold(1.0, f64::min)
        };
        let worst = &s.state.worst;
        println!(
            "{contact}: energy {energy:e} J, force {pressed} N, opening {:e} m, {} parts, {worst:?}",
            opening(&s),
            parts(&s)
        );
        // Of two discs that push against each other.
        let impulse = s.state.loads[0].impulse[1].abs();
        let off = worst.momentum_deviation.map(|d| d / impulse);
        assert!(off.iter().all(|&d| d < 1e-12), "{off:?}");
        assert_eq!(parts(&s), 1);
        assert_eq!(energy > 0.0, carries);
        if carries {
            assert!(worst.closest.is_some_and(|c| c >= 0.28));
            assert!(opening(&s) > 1e-3);
        }
    }
}

/// What is wrong with self-contact in an input.
#[test]
fn mistakes_are_told() {
    for (contact, told) in [
        ("self_contact = 3", "true, false, or a table with `folds`"),
        (
            "self_contact = { folds = 2 }",
            "`folds` must be at least 2.60 spacings, the support",
        ),
        ("self_contact = { fold = 8 }", "unknown key `fold`"),
        (
            "self_contact = true\nmode = \"kernel\"",
            "self-contact knows no bodies that are joined by `kernel` contact",
        ),
    ] {
        let text = format!(
            "dimension = 2\nspacing = \"1 mm\"\nrun.end_time = \"1 ms\"\n[contact]\n{contact}\n\
             {SOFT}{}",
            block("bar", -12.0, 12.0)
        );
        let error = files::input::parse("test.toml", &text, &[]).expect_err("a mistake");
        assert!(error.to_string().contains(told), "{error}");
    }
}
