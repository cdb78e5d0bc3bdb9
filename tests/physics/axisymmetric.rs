//! Axial symmetry: rings in a linear field, under a uniform stress, at the axis, and a shell that implodes.

use std::f64::consts::{FRAC_PI_3, TAU};

use crate::physics_support::{inline, run_with, start};
use comm::Comm;
use engine::step::Simulation;

/// A disc of metal of radius 4 mm about the axis, with a velocity and more.
fn block(lattice: &str, velocity: &str, more: &str) -> Simulation {
    start(inline(&format!(
        "dimension = 2\naxisymmetric = true\nspacing = \"0.4 mm\"\n[run]\nend_time = \"1 us\"\n\
         [material.metal]\ndensity = \"2700 kg/m^3\"\n\
         eos.mie_gruneisen = {{ c0 = \"5 km/s\", s1 = 1.4, gamma0 = 2.0, b = 0 }}\n\
         strength.elastic = {{ shear_modulus = \"27 GPa\" }}\n\
         [[body]]\nname = \"disc\"\nmaterial = \"metal\"\nlattice = \"{lattice}\"\n\
         shape.box = {{ lower = [0, \"-4 mm\"], upper = [\"4 mm\", \"4 mm\"] }}\n\
         velocity = {velocity}\n{more}"
    )))
}

/// Masses are those of rings, together that of what turns.
#[test]
fn rings_have_the_mass_of_the_body() {
    let mass = |text: &str| {
        let s = start(inline(&format!(
            "dimension = 2\naxisymmetric = true\nspacing = \"0.1 mm\"\nrun.end_time = \"1 us\"\n\
             [material.water]\ndensity = \"1000 kg/m^3\"\n\
             eos.mie_gruneisen = {{ c0 = \"1.5 km/s\", s1 = 1.9, gamma0 = 0.5, b = 0 }}\nstrength = \"none\"\n\
             [[body]]\nname = \"a\"\nmaterial = \"water\"\n{text}"
        )));
        s.particles.mass[..s.particles.owned()].iter().sum::<f64>()
    };
    let ball = mass("shape.sphere.radius = \"2 mm\"");
    let exact = 4.0 * FRAC_PI_3 * 8e-9 * 1000.0;
    assert!((ball / exact - 1.0).abs() < 1e-3, "{ball} {exact}");
    let half = mass("shape.sphere.radius = \"2 mm\"\n[[symmetry]]\naxis = \"y\"");
    assert!((2.0 * half / ball - 1.0).abs() < 1e-3, "{half} {ball}");
    let tube = mass("shape.box = { lower = [\"1 mm\", 0], upper = [\"3 mm\", \"2 mm\"] }");
    let exact = TAU / 2.0 * 8e-6 * 2e-3 * 1000.0;
    assert!((tube / exact - 1.0).abs() < 1e-6, "{tube} {exact}");
}

/// `v_r = a r + b y`, `v_y = c r + d y`: gradients are exact inside the body and at the axis, with `v_r/r` round it.
#[test]
fn gradients_of_a_linear_field_are_exact() {
    for lattice in ["cubic", "glass"] {
        let mut s = block(
            lattice,
            "[\"3e3/s * x\", \"-5e3/s * y\"]",
            "[[symmetry]]\naxis = \"y\"\n[time_step]\nmax = \"1 ps\"\n",
        );
        s.advance(&Comm::solo()).expect("a step");
        let p = &s.particles;
        let exact = [3e3, 0.0, 0.0, 0.0, -5e3, 0.0, 0.0, 0.0, 3e3];
        let mut seen = 0;
        for i in 0..p.owned() {
            if p.position[i][0] > 3e-3 || p.position[i][1] > 3e-3 {
                continue;
            }
            seen += 1;
            for (found, exact) in p.velocity_gradient[i].iter().zip(exact) {
                let off = (found - exact).abs();
                assert!(off < 15.0, "{lattice} {:?}: {found} {exact}", p.position[i]);
            }
        }
        assert!(seen > 40, "{seen}");
    }
}

/// Under a pressure that is the same everywhere nothing inside is pushed, least of all at the axis: accelerations are
/// small against those of a pressure that falls to nothing within a spacing.
#[test]
fn a_uniform_pressure_pushes_nothing_at_the_axis() {
    let s = block("cubic", "[0, 0]", "pressure = \"1 GPa\"\n");
    let p = &s.particles;
    let scale = 1e9 / (2700.0 * 0.4e-3);
    for i in 0..p.owned() {
        let [x, y, _] = p.position[i];
        if x < 3e-3 && y.abs() < 3e-3 {
            let a = p.acceleration[i];
            let size = a[0].hypot(a[1]) / scale;
            assert!(size < 3e-2, "{:?}: {size} {a:?}", [x, y]);
            assert!(a[2] == 0.0);
        }
    }
}

/// A disc that oscillates keeps its energy and its momentum along the axis to rounding.
#[test]
fn energy_and_axial_momentum_hold() {
    for lattice in ["cubic", "glass"] {
        let velocity = "[\"2e5/s * x * cos(y/(1 mm))\", \"100 m/s * sin(x/(1 mm)) + 3e4/s*y\"]";
        let mut s = block(lattice, velocity, "");
        run_with(&mut s, 1e-6, |_| {});
        let worst = &s.state.worst;
        assert!(worst.energy_error < 1e-12, "{}", worst.energy_error);
        assert!(
            worst.momentum_error[1] < 1e-13,
            "{:?}",
            worst.momentum_error
        );
        assert!(
            s.particles
                .position
                .iter()
                .all(|x| x[0] > 0.0 && x[2] == 0.0)
        );
    }
}

/// A shell of beryllium (Verney) from 80 and 100 mm, five particles across: it stops with its inner face at 40.0 mm, and
/// keeps its energy to rounding.
#[test]
fn an_imploding_shell_stops_where_it_must() {
    for (lattice, bound) in [("cubic", 1.5e-3), ("glass", 2.5e-3)] {
        let component = |x: &str| format!("\"-625.65 m/s * (80 mm)^2 * {x} / r^3\"");
        let [x, y] = ["x", "y"].map(component);
        let mut s = start(inline(&format!(
            "dimension = 2\naxisymmetric = true\nspacing = \"4 mm\"\n[run]\nend_time = \"160 us\"\n\
             [material.beryllium]\ndensity = \"1845 kg/m^3\"\n\
             eos.mie_gruneisen = {{ c0 = \"7998 m/s\", s1 = 1.124, gamma0 = 1.11, b = 0.16 }}\n\
             strength.von_mises = {{ shear_modulus = \"151 GPa\", yield_stress = \"330 MPa\" }}\n\
             [[body]]\nname = \"shell\"\nmaterial = \"beryllium\"\nlattice = \"{lattice}\"\n\
             shape.sphere = {{ radius = \"100 mm\", inner_radius = \"80 mm\" }}\n\
             velocity = [{x}, {y}]\n[[symmetry]]\naxis = \"y\"\n"
        )));
        run_with(&mut s, 160e-6, |_| {});
        let p = &s.particles;
        let (mut mass, mut sum) = (0.0, 0.0);
        for i in 0..p.owned() {
            let [x, y, _] = p.position[i];
            mass += p.mass[i];
            sum += p.mass[i] * x.hypot(y).powi(3);
        }
        let face = (sum / mass - 0.5 * (0.1_f64.powi(3) - 0.08_f64.powi(3))).cbrt();
        println!("{lattice}: {:.2} mm of 40.0", 1e3 * face);
        assert!((face - 0.04).abs() < bound, "{lattice}: {face}");
        assert!(s.state.worst.energy_error < 1e-12);
    }
}

/// A disc that meets a plate: energy and axial momentum hold, nothing is interpenetrated, and the measures are those of
/// the model in space.
#[test]
fn a_ball_goes_through_a_plate() {
    let case = crate::physics_support::ready("axisymmetric-impact", &["spacing=0.03mm"]);
    let mut s = start(case);
    run_with(&mut s, 0.2e-6, |_| {});
    let found = engine::step::measurements::findings(&mut s, &Comm::solo());
    let worst = &s.state.worst;
    println!(
        "energy {}, momentum {:?}",
        worst.energy_error, worst.momentum_error
    );
    assert!(worst.energy_error < 3e-3 && worst.momentum_error[1] < 1e-13);
    assert_eq!(worst.interpenetrated, 0);
    let figures = &found[0].figures;
    let hole = figures
        .iter()
        .find(|figure| figure.name == "opening_diameter");
    let Some(engine::measure::Told::Number(hole)) = hole.map(|figure| figure.value) else {
        panic!("no hole")
    };
    println!("hole {:.4} mm", 1e3 * hole);
    // 1.31 mm in space at half the spacing.
    assert!((hole / 1.31e-3 - 1.0).abs() < 0.05, "{hole}");
}
