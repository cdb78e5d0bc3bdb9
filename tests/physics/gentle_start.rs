//! Gentle starts: stresses that bodies begin under, the weight above, pressures on faces, relaxation.

use crate::physics_support::{inline, median, run_with, sorted_by, start};
use engine::step::Simulation;

/// Sound has 6 km/s.
const ELASTIC: &str = "material.a.density = \"2 g/cm^3\"\n\
    material.a.eos.linear = { bulk_modulus = \"52 GPa\", form = \"logarithmic\" }\n\
    material.a.strength.elastic.shear_modulus = \"15 GPa\"\n";
const K: f64 = 52e9;
const RHO: f64 = 2000.0;
const C: f64 = 6000.0;

fn case(text: &str) -> Simulation {
    start(inline(&format!("{ELASTIC}{text}")))
}

fn fastest(s: &Simulation) -> f64 {
    let speed = |v: &[f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    s.particles.velocity[..s.particles.owned()]
        .iter()
        .map(speed)
        .fold(0.0, f64::max)
}

/// A pressure on the end of a bar sends a wave of the velocity p/(ρ c) into it, and gives it the impulse p t.
#[test]
fn a_pressure_on_the_end_of_a_bar() {
    let (p, end) = (1e7, 25e-6);
    let mut s = case(&format!(
        "dimension = 1\nspacing = \"1 mm\"\nrun.end_time = \"{end} s\"\n\
         [[pressure]]\nname = \"end\"\nbody = \"bar\"\nbelow.x = \"8 spacing\"\nvalue = \"{p} Pa\"\n\
         [[body]]\nname = \"bar\"\nmaterial = \"a\"\n\
         shape.box = {{ lower = [0], upper = [\"200 mm\"] }}\n"
    ));
    run_with(&mut s, end, |_| {});
    let order = sorted_by(&s, 0, |i| s.particles.position[i][0]);
    // Behind the front, at 150 mm.
    let behind = order[20..100].iter();
    let velocity = median(
        behind
            .clone()
            .map(|&i| s.particles.velocity[i][0])
            .collect(),
    );
    let pressed = median(
        behind
            .map(|&i| s.particles.deviatoric_stress[i][0] - s.particles.pressure[i])
            .collect(),
    );
    let (u, impulse) = (p / (RHO * C), s.state.loads[0].impulse[0]);
    let first = s.particles.velocity[order[0]][0];
    println!(
        "u {:.5}, stress {:.5}, first {:.5}, impulse {:.6}",
        velocity / u,
        -pressed / p,
        first / u,
        impulse / (p * end)
    );
    assert!((velocity / u - 1.0).abs() < 0.01, "{velocity} of {u}");
    assert!((pressed / p + 1.0).abs() < 0.01, "{pressed}");
    // The end and the layers behind it, too.
    assert!((first / u - 1.0).abs() < 0.03, "{first} of {u}");
    assert!((impulse / (p * end) - 1.0).abs() < 2e-3, "{impulse}");
    let worst = &s.state.worst;
    println!(
        "energy {:e}, momentum {:e}",
        worst.energy_error, worst.momentum_error[0]
    );
    assert!(worst.energy_error < 1e-9 && worst.momentum_error[0] < 1e-9);
}

/// A ball, of glass and cut in four by two planes of symmetry, is pressed on all sides by a pressure that rises slowly, and
/// comes to rest at the density of that pressure.
#[test]
fn a_ball_under_pressure_on_all_sides() {
    let p = 5e8;
    let text = |more: &str, symmetry: &str| {
        format!(
            "dimension = 3\nspacing = \"1 mm\"\nrun.end_time = \"60 us\"\n{more}\n\
             [[body]]\nname = \"ball\"\nmaterial = \"a\"\nshape.sphere.radius = \"6 mm\"\n\
             lattice = \"glass\"\n{symmetry}\n"
        )
    };
    let ramp = format!(
        "relaxation.until = \"55 us\"\n\
         [[pressure]]\nbody = \"ball\"\ntimes = [0, \"20 us\"]\nvalue = [0, \"{p} Pa\"]"
    );
    for symmetry in ["", "[[symmetry]]\naxis = \"x\"\n[[symmetry]]\naxis = \"y\""] {
        let mut s = case(&text(&ramp, symmetry));
        run_with(&mut s, 60e-6, |_| {});
        let owned = s.particles.owned();
        let sum = |of: &dyn Fn(usize) -> f64| (0..owned).map(of).sum::<f64>();
        let volume = sum(&|i| s.particles.mass[i] / s.particles.density[i]);
        let before = sum(&|i| s.particles.mass[i] / RHO);
        // ρ = ρ₀ exp(p/K)
        let (strain, exact) = ((before / volume).ln(), p / K);
        let worst = &s.state.worst;
        println!(
            "volume {:.5}, fastest {:e}, energy {:e}, momentum {:?}, impulse {:?}",
            strain / exact,
            fastest(&s),
            worst.energy_error,
            worst.momentum_error,
            s.state
                .loads
                .iter()
                .map(|load| load.impulse)
                .collect::<Vec<_>>()
        );
        assert!((strain / exact - 1.0).abs() < 0.01, "{strain} of {exact}");
        assert!(fastest(&s) < 0.02 * p / (RHO * C));
        assert!(worst.energy_error < 1e-9);
        assert!(worst.momentum_error.iter().all(|&error| error < 1e-9));
        if symmetry.is_empty() {
            // All round a pressure has no resultant.
            let scale = p * 55e-6 * std::f64::consts::PI * 36e-6;
            assert!(
                s.state.loads[1]
                    .impulse
                    .iter()
                    .all(|x| x.abs() < 1e-12 * scale)
            );
        }
    }
    // Under a pressure that it has inside nothing moves at all.
    let even = format!("[[pressure]]\nbody = \"ball\"\nvalue = \"{p} Pa\"");
    let text = text(&even, "").replace("lattice =", &format!("pressure = \"{p} Pa\"\nlattice ="));
    let mut s = case(&text);
    let density = s.particles.density[0];
    assert!((density / (RHO * (p / K).exp()) - 1.0).abs() < 1e-12);
    run_with(&mut s, 10e-6, |_| {});
    println!("even: {:e}", fastest(&s) / (p / (RHO * C)));
    assert!(fastest(&s) < 1e-10 * p / (RHO * C));
}

/// A pressure on the top of a plate accelerates it by p over its areal mass, whatever its filling.
#[test]
fn a_plate_under_pressure() {
    for (lattice, bound) in [("cubic", 0.01), ("glass", 0.01)] {
        let (p, end) = (1e8, 10e-6);
        let mut s = case(&format!(
            "dimension = 3\nspacing = \"1 mm\"\nrun.end_time = \"{end} s\"\n\
             [[pressure]]\nbody = \"plate\"\nabove.z = \"4 mm\"\nvalue = \"{p} Pa\"\n\
             [[body]]\nname = \"plate\"\nmaterial = \"a\"\nlattice = \"{lattice}\"\n\
             shape.box = {{ lower = [0, 0, 0], upper = [\"16 mm\", \"12 mm\", \"8 mm\"] }}\n"
        ));
        run_with(&mut s, end, |_| {});
        let (impulse, exact) = (s.state.loads[0].impulse, p * 16e-3 * 12e-3 * end);
        let worst = &s.state.worst;
        println!(
            "{lattice}: {:.5}, across {:e}, momentum {:?}, angular {:?}, energy {:e}",
            -impulse[2] / exact,
            impulse[0] / exact,
            worst.momentum_error,
            worst.angular_momentum_error,
            worst.energy_error
        );
        assert!(
            (impulse[2] / exact + 1.0).abs() < bound,
            "{lattice} {impulse:?}"
        );
        assert!(impulse[0].abs() < bound * exact);
        assert!((s.state.totals.momentum[2] / impulse[2] - 1.0).abs() < 1e-9);
        assert!(worst.momentum_error.iter().all(|&error| error < 1e-9));
        assert!(
            worst
                .angular_momentum_error
                .iter()
                .all(|&error| error < 1e-9)
        );
        assert!(worst.energy_error < 1e-9);
    }
}

/// A column of rock, 100 m high, on a fixed foot: its free sides bear nothing.
fn column(dimension: usize, start_of: &str, more: &str, end: f64) -> Simulation {
    let (upper, gravity, foot) = match dimension {
        1 => ("[\"100 m\"]", "[\"-9.81 m/s^2\"]", "x"),
        2 => ("[\"24 m\", \"100 m\"]", "[0, \"-9.81 m/s^2\"]", "y"),
        _ => (
            "[\"16 m\", \"16 m\", \"100 m\"]",
            "[0, 0, \"-9.81 m/s^2\"]",
            "z",
        ),
    };
    let lower = ["0"; 3][..dimension].join(", ");
    case(&format!(
        "dimension = {dimension}\nspacing = \"2 m\"\nrun.end_time = \"{end} s\"\ngravity = {gravity}\n{more}\n\
         [[load]]\nbody = \"rock\"\nbelow.{foot} = \"3 spacing\"\nvelocity.{foot} = 0\n\
         [[body]]\nname = \"rock\"\nmaterial = \"a\"\nlattice = \"cubic\"\n{start_of}\n\
         shape.box = {{ lower = [{lower}], upper = {upper} }}\n"
    ))
}

/// Vertical stress of a column 20 m above its foot over the weight above, in the middle of its breadth.
fn carried(s: &Simulation, body: u32, axis: usize) -> f64 {
    let order = sorted_by(s, body, |i| (s.particles.position[i][axis] - 20.0).abs());
    let share = |&i: &usize| {
        let stress = s.particles.deviatoric_stress[i][axis] - s.particles.pressure[i];
        -stress / (RHO * 9.81 * (100.0 - s.particles.position[i][axis]))
    };
    let layer = order
        .iter()
        .filter(|&&i| (s.particles.position[i][axis] - 20.0).abs() < 2.0);
    median(layer.map(share).collect())
}

/// Under its own weight from the start a column stays as it is, and without it falls onto itself.
#[test]
fn a_column_stands_under_its_own_weight() {
    // Twelve travel times of sound, or three. Layers at free sides settle.
    for (dimension, overburden, end, bound) in [
        (1, "overburden = true", 0.2, 0.01),
        (2, "overburden.lateral = 0", 0.2, 0.2),
        (3, "overburden.lateral = 0", 0.05, 0.2),
    ] {
        let largest = |start_of: &str| {
            let mut s = column(dimension, start_of, "", end);
            let mut largest = 0.0_f64;
            run_with(&mut s, end, |s| largest = largest.max(fastest(s)));
            assert!(
                s.state.worst.energy_error < 1e-3,
                "{}",
                s.state.worst.energy_error
            );
            (largest, s)
        };
        let (falls, _) = largest("");
        let (stands, s) = largest(overburden);
        let fall = 9.81 * end;
        println!(
            "{dimension} D: {:.5} of g t, without {:.4}",
            stands / fall,
            falls / fall
        );
        assert!(falls > 0.05 * fall);
        assert!(stands < bound * falls, "{stands} of {falls}");
        let axis = dimension - 1;
        let carried = carried(&s, 0, axis);
        assert!((carried - 1.0).abs() < 0.03, "{carried}");
    }
}

/// What lies on a body weighs on it, and what stands beside it does not.
#[test]
fn layers_weigh_on_each_other() {
    let s = case(
        "dimension = 2\nspacing = \"1 km\"\nrun.end_time = \"1 s\"\ngravity = [0, \"-10 m/s^2\"]\ncontact.mode = \"kernel\"\n\
         [material.b]\ndensity = \"3 g/cm^3\"\neos.linear.bulk_modulus = \"1e7 GPa\"\nstrength = \"none\"\n\
         [[body]]\nname = \"low\"\nmaterial = \"a\"\noverburden.lateral = 0.5\n\
         shape.box = { lower = [0, \"-30 km\"], upper = [\"20 km\", \"-10 km\"] }\n\
         [[body]]\nname = \"top\"\nmaterial = \"b\"\noverburden = true\n\
         shape.box = { lower = [0, \"-10 km\"], upper = [\"20 km\", 0] }\n\
         [[body]]\nname = \"tower\"\nmaterial = \"b\"\noverburden = true\n\
         shape.box = { lower = [\"20 km\", \"-30 km\"], upper = [\"30 km\", \"30 km\"] }\n",
    );
    // σ_v = 3e8 Pa at the interface, then dσ_v/dz = ρ₀ g exp(p/K) with p = 2/3 σ_v.
    let m = 52e9 * 1.5;
    let below = |depth: f64| {
        let start = (-3e8_f64 / m).exp();
        -m * (start - RHO * 10.0 * depth / m).ln()
    };
    for i in 0..s.particles.owned() {
        let y = s.particles.position[i][1];
        let [xx, yy, zz, ..] =
            s.particles.deviatoric_stress[i].map(|c| c - s.particles.pressure[i]);
        let expected = match s.particles.body[i] {
            0 => below(-1e4 - y),
            1 => -3e4 * y,
            _ => 3e4 * (3e4 - y),
        };
        let lateral = if s.particles.body[i] == 0 { 0.5 } else { 1.0 };
        for (found, share) in [(yy, 1.0), (xx, lateral), (zz, lateral)] {
            assert!(
                (found + share * expected).abs() < 1e-6 * expected,
                "{y} {found} {expected}"
            );
        }
        let volume = s.particles.mass[i] / s.particles.density[i];
        assert!((volume / 1e6 - 1.0).abs() < 1e-9, "{volume}");
    }
}

/// A column without the stress of its weight comes to rest under it, the ball above it waits, and what the drag takes is booked.
#[test]
fn a_column_comes_to_rest_before_the_ball_starts() {
    let more = "relaxation = { until = \"0.3 s\", waiting = [\"ball\"] }\ncontact.mode = \"overlap\"\n\
         [[body]]\nname = \"ball\"\nmaterial = \"a\"\nlattice = \"cubic\"\nvelocity = [0, \"-300 m/s\"]\n\
         shape.sphere = { centre = [\"12 m\", \"140 m\"], radius = \"6 m\" }";
    let mut s = column(2, "", more, 0.32);
    let ball = |s: &Simulation| {
        let order = sorted_by(s, 0, |i| s.particles.position[i][1]);
        let middle = |of: &dyn Fn(usize) -> f64| median(order.iter().map(|&i| of(i)).collect());
        [
            middle(&|i| s.particles.position[i][1]),
            middle(&|i| s.particles.velocity[i][1]),
        ]
    };
    let speed = |s: &Simulation| {
        let order = sorted_by(s, 1, |i| s.particles.position[i][1]);
        order
            .iter()
            .map(|&i| s.particles.velocity[i][1].abs())
            .fold(0.0, f64::max)
    };
    let (mut most, mut still, mut started) = (0.0_f64, 1.0, None);
    run_with(&mut s, 0.32, |s| {
        if s.state.time < 0.3 {
            assert!((ball(s)[0] - 140.0).abs() < 1e-9 && ball(s)[1] == 0.0);
            most = most.max(speed(s));
            still = speed(s);
        } else if started.is_none() {
            started = Some(ball(s));
        }
    });
    println!(
        "most {most}, still {still}, started {started:?}, {:e}",
        s.state.worst.energy_error
    );
    for (name, load) in s.case.load_names().zip(&s.state.loads) {
        println!("{name}: work {:e}, impulse {:?}", load.work, load.impulse);
    }
    assert!(still < 2e-3 * most, "{still} of {most}");
    let [place, velocity] = started.expect("a start");
    assert!((velocity + 300.0).abs() < 1e-9 && place < 140.0 && place > 139.0);
    let [place, _] = ball(&s);
    // 20 ms at 300 m/s, and g t²/2.
    assert!(
        (place - 140.0 + 6.0 + 0.5 * 9.81 * 4e-4).abs() < 1e-3,
        "{place}"
    );
    assert!(
        s.state.worst.energy_error < 1e-3,
        "{}",
        s.state.worst.energy_error
    );
    let carried = carried(&s, 1, 1);
    println!("carried {carried}");
    assert!((carried - 1.0).abs() < 0.02, "{carried}");
}
