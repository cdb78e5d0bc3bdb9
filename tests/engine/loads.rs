//! Loads in whole steps: what is prescribed holds exactly, and what loads put in is booked.

use crate::physics_support::bars::{BAR_MATERIALS, STEEL_SPEED};
use crate::physics_support::{inline, run_to, run_with, sorted_by, start};
use engine::contact::ContactTable;
use engine::step::{Reason, Simulation};
use model::Case;

/// ρ c v of the bar's step (Pa).
const PLATEAU: f64 = 0.004_584_9e11;

/// Gravity counts in the acceleration that limits steps.
#[test]
fn steps_heed_gravity() {
    let s = start(inline(
        r#"
dimension = 1
spacing = "1 mm"
gravity = ["1e11 m/s2"]
run.end_time = "1 us"
material.a.library = "copper"
[[body]]
name = "bar"
material = "a"
shape.box = { size = ["20 mm"] }
"#,
    ));
    let (h, force) = (s.case.bodies[0].smoothing_length, s.case.time_step.force);
    assert_eq!(s.state.dt_reason, Reason::Force);
    assert!((s.state.dt / (force * (h / 1e11).sqrt()) - 1.0).abs() < 1e-12);
}

/// Free fall is exact: velocity g t, place ½ g t², and no force inside, to the bit.
#[test]
fn free_fall() {
    let mut s = start(inline(
        r#"
dimension = 2
spacing = "1 mm"
gravity = ["1.5 m/s2", "-9.81 m/s2"]
run.end_time = "0.1 ms"
material.a.library = "copper"
[[body]]
name = "block"
material = "a"
shape.box = { size = ["8 mm", "8 mm"] }
velocity = ["2 m/s", 0]
"#,
    ));
    let first = sorted_by(&s, 0, |_| 0.0)
        .into_iter()
        .map(|i| (s.particles.id[i], s.particles.position[i]))
        .collect::<std::collections::BTreeMap<_, _>>();
    run_to(&mut s, 1e-4);
    let (t, g) = (s.state.time, [1.5, -9.81]);
    #[allow(clippy::cast_precision_loss, reason = "few steps")]
    let steps = s.state.step as f64;
    for i in 0..s.particles.owned() {
        let begin = first[&s.particles.id[i]];
        for a in 0..2 {
            let v0 = [2.0, 0.0][a];
            let v = v0 + g[a] * t;
            let x = begin[a] + v0 * t + 0.5 * g[a] * t * t;
            // A rounding or two of each step.
            assert!(
                (s.particles.velocity[i][a] - v).abs() < 4e-16 * steps,
                "velocity"
            );
            assert!(
                (s.particles.position[i][a] - x).abs() < 2e-18 * steps,
                "place"
            );
        }
        assert_eq!(s.particles.acceleration[i], [0.0; 3]);
    }
    let worst = &s.state.worst;
    println!("{steps} steps: {worst:?}");
    // The work of gravity is a small part of the kinetic energy that it is seen in.
    assert!(
        worst.energy_error < 4e-16 * steps,
        "{:e}",
        worst.energy_error
    );
    assert!(worst.momentum_error.iter().all(|&e| e < 4e-16 * steps));
}

/// The bar of the paper's section 3.1, its first particle driven.
fn driven_bar(spacing: f64, more: &str, load: &str) -> Simulation {
    start(inline(&format!(
        r#"
dimension = 1
spacing = "{spacing} cm"
sph.smoothing = 1.0
run.end_time = "400 us"
{more}
{BAR_MATERIALS}
[[body]]
name = "bar"
material = "steel"
shape.box = {{ lower = [0], upper = ["100 cm"] }}
[[load]]
body = "bar"
below.x = "1 spacing"
{load}
"#
    )))
}

/// Stress (Pa) behind the front of the step is the exact one, the front runs at the wave's speed
/// from the driven particle, and energy and momentum are balanced to round-off.
#[test]
#[allow(clippy::cast_precision_loss, reason = "few particles")]
fn a_step_of_velocity_on_a_bar() {
    let mut s = driven_bar(1.0, "", "velocity.x = \"0.001 cm/us\"");
    assert_eq!(s.particles.velocity[0][0].to_bits(), 10f64.to_bits());
    let before = s
        .particles
        .position
        .iter()
        .map(|x| x[0])
        .fold(1.0, f64::min);
    run_with(&mut s, 128.8e-6, |s| {
        let first = sorted_by(s, 0, |i| s.particles.position[i][0])[0];
        assert_eq!(s.particles.velocity[first][0].to_bits(), 10f64.to_bits());
        let place = before + 10.0 * s.state.time;
        assert!((s.particles.position[first][0] - place).abs() < 1e-15);
    });
    let order = sorted_by(&s, 0, |i| s.particles.position[i][0]);
    let stress = |i: usize| s.particles.pressure[i] - s.particles.deviatoric_stress[i][0];
    let plateau: Vec<f64> = order[15..60].iter().map(|&i| stress(i)).collect();
    let mean = plateau.iter().sum::<f64>() / 45.0;
    // ρ c v = .0045849 Mbar; the lattice's own stiffness at h = Δp is exact.
    println!(
        "plateau {mean:e} Pa, {:.5} of the exact one",
        mean / PLATEAU
    );
    assert!((mean / PLATEAU - 1.0).abs() < 0.005);
    let v = |k: usize| s.particles.velocity[order[k]][0];
    let k = (0..99)
        .find(|&k| v(k) > 5.0 && v(k + 1) <= 5.0)
        .expect("a front");
    let reference = |k: usize| 0.01 * (k as f64 + 0.5);
    let front = reference(k) + 0.01 * (v(k) - 5.0) / (v(k) - v(k + 1));
    // The driven particle is the first one: half a spacing from the bar's end.
    let exact = STEEL_SPEED * s.state.time + 0.005;
    println!("front {front} m, exact {exact} m");
    assert!((front - exact).abs() < 0.01);
    let worst = &s.state.worst;
    println!("{worst:?}");
    assert!(worst.energy_error < 1e-13, "{:e}", worst.energy_error);
    assert!(worst.momentum_error[0] < 1e-14);
    // The work is traction × velocity × time but for the start of the wave.
    let expected = PLATEAU * 10.0 * s.state.time;
    assert!((s.state.load_work() / expected - 1.0).abs() < 0.02);
}

/// Where the pulse of 35 µs stands at 128.8 µs on the bar of particles `spacing` (cm) apart: half
/// heights of its tail and its head in reference coordinates, in cm from the driven particle.
fn pulse(spacing: f64) -> (f64, f64) {
    let more = format!("time_step.max = \"{} us\"", 0.5 * spacing);
    let load = "velocity.x = \"0.001 cm/us\"\nuntil = \"35 us\"";
    let mut s = driven_bar(spacing, &more, load);
    run_to(&mut s, 35e-6);
    assert!(s.state.time - 35e-6 < 1.5 * s.state.last_dt);
    let put_in = s.state.load_work();
    run_to(&mut s, 128.8e-6);
    let one_step = PLATEAU * 10.0 * s.state.last_dt;
    assert!(
        s.state.load_work() - put_in < 1.1 * one_step,
        "driven too long"
    );
    let worst = &s.state.worst;
    println!("{worst:?}");
    assert!(worst.energy_error < 1e-13 && worst.momentum_error[0] < 1e-13);
    let order = sorted_by(&s, 0, |i| s.particles.position[i][0]);
    let v = |k: usize| s.particles.velocity[order[k]][0];
    assert!(
        v(0).abs() < 0.5,
        "free and at rest behind the pulse: {}",
        v(0)
    );
    let above = |k: &usize| v(*k) > 5.0;
    let first = (0..order.len()).find(above).expect("a pulse");
    let last = (0..order.len()).rfind(above).expect("a pulse");
    #[allow(clippy::cast_precision_loss, reason = "few particles")]
    let place = |k: usize, next: usize| {
        let part = (v(k) - 5.0) / (v(k) - v(next));
        spacing * (k as f64 + part * (next as f64 - k as f64))
    };
    (place(first, first - 1), place(last, last + 1))
}

/// After `until` the particles are free and nothing more is put in. Head and tail of the pulse
/// stand at 75.42 and 54.92 cm (from the driven particle; the tail from the bar's end, half a
/// spacing behind it) but for a number of spacings.
#[test]
fn a_pulse_ends_and_frees_its_particles() {
    for spacing in [1.0, 0.25] {
        let (tail, head) = pulse(spacing);
        println!("spacing {spacing} cm: pulse from {tail:.2} to {head:.2} cm");
        assert!((head - 75.42).abs() < spacing, "{head}");
        assert!((tail - 54.92).abs() < 2.5 * spacing, "{tail}");
    }
}

/// A table of time: velocities at whole steps are the table's, places its integral, also across
/// corners and jumps, and free axes stay free.
#[test]
fn velocities_and_places_follow_the_table() {
    let mut s = start(inline(
        r#"
dimension = 2
spacing = "1 mm"
run.end_time = "10 us"
material.a.library = "copper"
[[body]]
name = "block"
material = "a"
shape.box = { lower = [0, 0], upper = ["8 mm", "4 mm"] }
[[load]]
name = "left"
body = "block"
below.x = "1 spacing"
velocity = { times = [0, "2 us", "4 us", "4 us", "6 us"], x = [0, "10 m/s", "10 m/s", "-5 m/s", 0] }
[[load]]
name = "bottom"
body = "block"
below.y = "1 spacing"
velocity.y = 0
"#,
    ));
    let begin = s.particles.clone();
    let at = |id: u64| begin.id.iter().position(|&x| x == id).unwrap();
    let velocity = |t: f64| match t * 1e6 {
        t if t < 2.0 => 5.0 * t,
        t if t < 4.0 => 10.0,
        t if t < 6.0 => -5.0 + 2.5 * (t - 4.0),
        _ => 0.0,
    };
    let moved = |t: f64| {
        1e-6 * match t * 1e6 {
            t if t < 2.0 => 2.5 * t * t,
            t if t < 4.0 => 10.0 + 10.0 * (t - 2.0),
            t if t < 6.0 => 30.0 - 5.0 * (t - 4.0) + 1.25 * (t - 4.0) * (t - 4.0),
            _ => 25.0,
        }
    };
    let mut stretched = false;
    run_with(&mut s, 10e-6, |s| {
        let (particles, t) = (&s.particles, s.state.time);
        for i in 0..particles.owned() {
            let first = begin.position[at(particles.id[i])];
            if first[0] < 1e-3 {
                assert!((particles.velocity[i][0] - velocity(t)).abs() < 1e-12);
                let place = first[0] + moved(t);
                assert!((particles.position[i][0] - place).abs() < 1e-16, "{t:e}");
                stretched |= first[1] > 1e-3 && particles.velocity[i][1].abs() > 1e-3;
            }
            if first[1] < 1e-3 {
                assert_eq!(particles.velocity[i][1], 0.0);
                assert_eq!(particles.position[i][1], first[1]);
            }
        }
    });
    assert!(stretched, "the free axis of driven particles");
    let worst = &s.state.worst;
    println!("{:?} {worst:?}", s.state.loads);
    assert!(worst.energy_error < 1e-13);
    assert!(worst.momentum_error.iter().all(|&e| e < 1e-13));
}

/// An elastic block of ten by ten particles on a floor.
fn block_on(floor: &str, more: &str) -> Case {
    inline(&format!(
        r#"
dimension = 2
spacing = "1 mm"
run.end_time = "1 s"
{more}
[material.soft]
density = "1000 kg/m^3"
eos.linear.bulk_modulus = "10 MPa"
strength.elastic.shear_modulus = "3 MPa"
[[body]]
name = "block"
material = "soft"
shape.box = {{ lower = [0, 0], upper = ["10 mm", "10 mm"] }}
{floor}
"#
    ))
}

const PLANE: &str = "[[plane]]\nname = \"floor\"\nnormal = \"+y\"\n";
const RIGID: &str = "[[body]]\nname = \"floor\"\nrigid = true\n\
     shape.box = { lower = [\"-5 mm\", \"-4 mm\"], upper = [\"15 mm\", 0] }\n";

/// A block under gravity comes to rest on a plane and on a rigid body: the support carries its
/// weight, and energy is balanced to the order of the scheme.
#[test]
fn a_block_rests_on_the_floor() {
    for floor in [PLANE, RIGID] {
        let mut s = start(block_on(
            floor,
            "gravity = [0, \"-1000 m/s2\"]\nsph.alpha = 2.0",
        ));
        let weight = 1000.0 * 1e-4 * 1000.0;
        let (mut mean, mut count) = (0.0, 0);
        run_with(&mut s, 20e-3, |s| {
            if s.state.time > 4e-3 {
                mean += s.state.loads[0].force[1];
                count += 1;
            }
        });
        let mean = mean / f64::from(count);
        let fastest = s
            .particles
            .velocity
            .iter()
            .map(|v| v[1].abs())
            .fold(0.0, f64::max);
        let worst = &s.state.worst;
        println!("carried {mean} of {weight} N/m, speed {fastest:e}, {worst:?}");
        assert!((mean / weight - 1.0).abs() < 0.01);
        // A thousandth of what falling its own height would give.
        assert!(fastest < 5e-3, "{fastest}");
        assert!(worst.energy_error < 1e-3, "{:e}", worst.energy_error);
        assert!(worst.momentum_error.iter().all(|&e| e < 1e-12));
        let lowest = s
            .particles
            .position
            .iter()
            .zip(&s.particles.body)
            .filter(|(_, b)| **b == 0);
        let lowest = lowest.map(|(x, _)| x[1]).fold(1.0, f64::min);
        assert!((lowest - 0.5e-3).abs() < 0.1e-3, "{lowest}");
    }
}

/// Largest energy error and the speed that an elastic block leaves with, over that of its fall.
fn bounce(floor: &str, courant: f64) -> (f64, f64) {
    let more = format!(
        "time_step.courant = {courant}\ntime_step.force = {}\nsph.alpha = 0.1\nsph.beta = 0.2",
        0.5 * courant
    );
    let floor = floor.replace("\"-4 mm\"", "\"-5 mm\"");
    let mut case = block_on(
        &floor.replace("\"15 mm\", 0", "\"15 mm\", \"-1 mm\""),
        &more,
    );
    case.bodies[0].velocity.y = -1.0;
    let mut s = start(case);
    let momentum = s.state.initial.momentum[1];
    run_with(&mut s, 3.5e-3, |s| {
        assert_ne!(s.state.last_reason, Reason::Contact);
        assert!(s.state.loads[0].force[1] >= 0.0);
    });
    let worst = &s.state.worst;
    assert!(worst.momentum_error.iter().all(|&e| e < 1e-13), "{worst:?}");
    assert!((worst.energy_error - worst.contact_defect).abs() < 1e-12);
    assert_eq!(s.state.contact_energy, 0.0, "it has left");
    assert_eq!(s.state.load_work(), 0.0, "what stands still does no work");
    (worst.energy_error, -s.state.totals.momentum[1] / momentum)
}

/// The speed that a block of [`bounce`] leaves a plane with, of .125 mm instead of 1 mm.
const RESOLVED_BOUNCE: f64 = 0.729;

/// An elastic block thrown on a plane and on a rigid body: it comes back as fast as a resolved one, and
/// the energy error is of second order.
#[test]
fn a_block_bounces_off() {
    let plane = "[[plane]]\nnormal = \"+y\"\npoint = [0, \"-1 mm\"]\n";
    for floor in [RIGID, plane] {
        let [(coarse, _), (fine, speed)] = [0.4, 0.1].map(|courant| bounce(floor, courant));
        println!("energy error {coarse:e}, {fine:e}, leaves with {speed:.3}");
        // Who meets a spring of frequency ω within a step gains or loses up to ¼ ω² Δt² of his
        // energy: here one row of ten, all at once, at κ = 2.
        let step = 0.4 * 1.3 / (1.0 + 0.6 * 0.1);
        assert!(coarse < 1.2 * 0.25 * 2.0 * step * step / 10.0);
        assert!(fine < coarse / 10.0);
        // The rest of the fall's energy rings on inside.
        assert!((speed / RESOLVED_BOUNCE - 1.0).abs() < 0.05, "{speed}");
    }
}

/// A punch that moves at a given velocity drives a wave: its work is what the model gains, and the
/// same punch as a moving plane does the same to the order of the contact's stiffness.
#[test]
fn a_moving_punch_does_work() {
    let rigid = "[[body]]\nname = \"punch\"\nrigid = true\nvelocity = [\"0.001 cm/us\"]\n\
                 shape.box = { lower = [\"-6 cm\"], upper = [0] }\n";
    let plane = "[[plane]]\nname = \"punch\"\nnormal = \"+x\"\nmotion.x = \"0.001 cm/us\"\n";
    let table = "[[body]]\nname = \"punch\"\nrigid = true\nshape.box = { lower = [\"-6 cm\"], \
                 upper = [0] }\nmotion = { times = [0, \"300 us\"], x = [\"10 m/s\", \"10 m/s\"] }\n";
    for punch in [rigid, plane, table] {
        let mut s = start(inline(&format!(
            r#"
dimension = 1
spacing = "1 cm"
sph.smoothing = 1.0
run.end_time = "400 us"
{BAR_MATERIALS}
[[body]]
name = "bar"
material = "steel"
shape.box = {{ lower = [0], upper = ["100 cm"] }}
{punch}
"#
        )));
        assert_eq!(s.state.initial.kinetic_energy, 0.0);
        run_to(&mut s, 128.8e-6);
        let order = sorted_by(&s, 0, |i| s.particles.position[i][0]);
        let stress = |i: usize| s.particles.pressure[i] - s.particles.deviatoric_stress[i][0];
        let mean = order[15..60].iter().map(|&i| stress(i)).sum::<f64>() / 45.0;
        let load = &s.state.loads[0];
        let worst = &s.state.worst;
        println!(
            "plateau {:.4}, force {:.4} of the exact one; {worst:?}",
            mean / PLATEAU,
            load.force[0] / PLATEAU
        );
        assert!((mean / PLATEAU - 1.0).abs() < 0.005);
        assert!((load.force[0] / PLATEAU - 1.0).abs() < 0.01);
        assert!((load.work / (load.impulse[0] * 10.0) - 1.0).abs() < 1e-12);
        assert!((worst.energy_error - worst.contact_defect).abs() < 1e-12);
        assert!(worst.energy_error < 1e-3);
        assert!(worst.momentum_error[0] < 1e-13);
    }
}

/// Laid in touch, nothing happens: with rigid bodies and planes, in one, two and three dimensions,
/// also beneath a turned lattice.
#[test]
fn in_touch_at_rest_nothing_happens() {
    for (dimension, lattice) in [(1, "cubic"), (2, "cubic"), (3, "cubic"), (2, "turned")] {
        let point = |x: &str| {
            let mut point = vec!["\"-3 mm\""; dimension];
            point[dimension - 1] = x;
            point.join(", ")
        };
        let wide = |x: &str| point(x).replace("-3 mm", "-8 mm");
        let positive = |text: String| text.replace("\"-", "\"");
        let up = ["+x", "+y", "+z"][dimension - 1];
        let angle = if lattice == "turned" {
            "lattice = { kind = \"cubic\", angle = \"30 deg\" }"
        } else {
            ""
        };
        let mut s = start(inline(&format!(
            r#"
dimension = {dimension}
spacing = "1 mm"
run.end_time = "1 s"
material.a.library = "copper"
[[body]]
name = "tool"
rigid = true
shape.box = {{ lower = [{}], upper = [{}] }}
[[body]]
name = "block"
material = "a"
{angle}
shape.box = {{ lower = [{}], upper = [{}] }}
touch = {{ body = "tool", direction = "-{}" }}
[[plane]]
normal = "{up}"
point = [{}]
"#,
            wide("\"-5 mm\""),
            positive(wide("0")),
            point("\"1 mm\""),
            positive(point("\"7 mm\"")),
            &up[1..],
            vec!["0"; dimension].join(", "),
        )));
        let contact = s.particles.contact_acceleration.clone();
        assert!(
            contact.iter().flatten().all(|a| a.abs() < 1e-3),
            "{dimension} {lattice}"
        );
        run_to(&mut s, 20e-6);
        let fastest = s
            .particles
            .velocity
            .iter()
            .flatten()
            .map(|v| v.abs())
            .fold(0.0, f64::max);
        println!("{dimension}-D {lattice}: {fastest:e} m/s");
        assert!(fastest < 1e-6, "{fastest:e}");
    }
}

/// The core of `overlap` is as stiff, `κ_c max(M, .85 ρ v²)`, as the fastest meeting takes that
/// tables of loads state: v is that of the tables up to `until`, and along free axes that of the
/// start.
#[test]
fn the_core_knows_the_speeds_that_loads_prescribe() {
    let core = |loads: &str| {
        let text = format!(
            r#"
dimension = 2
spacing = "1 mm"
run.end_time = "1 us"
material.a.library = "copper"
[[body]]
name = "flyer"
material = "a"
shape.box = {{ lower = [0, 0], upper = ["4 mm", "4 mm"] }}
velocity = [0, "3 km/s"]
[[body]]
name = "target"
material = "a"
shape.box = {{ lower = ["5 mm", 0], upper = ["9 mm", "4 mm"] }}
velocity = [0, "3 km/s"]
{loads}"#
        );
        let case = inline(&text);
        let table = ContactTable::new(&case);
        let material = &case.materials[0];
        let classes = [0, 1].map(|body| table.foreign.size_classes.smallest(body));
        let core = |a: usize, b: usize| table.overlap(classes[a], classes[b]).core_modulus;
        assert_eq!(core(0, 1), core(1, 0));
        // 2.2 is the default of κ_c.
        let scale = core(0, 1) / 2.2;
        (scale / (0.85 * material.reference_density)).sqrt()
    };
    let at_rest = core("");
    assert!(at_rest < 6e3, "{at_rest}");
    let load = |body: &str, v: &str, until: &str| {
        format!(
            "[[load]]\nbody = \"{body}\"\nvelocity = {{ x = {v}, times = [0, \"1 us\", \"2 us\"] }}\n\
             {until}\n"
        )
    };
    let ramp = r#"[0, "10 km/s", "1 km/s"]"#;
    for (loads, speed) in [
        (load("flyer", r#"[0, "1 km/s", "2 km/s"]"#, ""), at_rest),
        (load("flyer", ramp, ""), 10e3),
        (load("flyer", ramp, "until = \"0.8 us\""), 8e3),
        (
            load("flyer", ramp, "") + &load("target", r#"[0, 0, "-2 km/s"]"#, ""),
            12e3,
        ),
    ] {
        let found = core(&loads);
        assert!((found / speed - 1.0).abs() < 1e-12, "{found} for {speed}");
    }
}
