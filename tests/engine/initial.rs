//! What bodies begin with: velocity, spin about any point, temperature, specific energy and plastic
//! strain, as constants and as formulas of the place.

use std::time::Instant;

use crate::physics_support::{inline, run_to, run_with, start};
use comm::Comm;
use engine::step::Simulation;
use files::preflight::{approaches, beginning, warnings};
use model::{Case, Vec3};

/// A copper block of 6 × 5 × 4 mm about (1, 2, 3) mm.
fn block(spacing: &str, more: &str) -> Case {
    inline(&format!(
        "dimension = 3\nspacing = \"{spacing}\"\n[run]\nend_time = \"20 us\"\n\
         [material.copper]\nlibrary = \"copper-johnson-cook\"\n\
         [[body]]\nname = \"block\"\nmaterial = \"copper\"\n\
         shape.box = {{ centre = [\"1 mm\", \"2 mm\", \"3 mm\"], size = [\"6 mm\", \"5 mm\", \"4 mm\"] }}\n\
         lattice = \"cubic\"\n\
         {more}\n"
    ))
}

/// Fails unless two values are the same to a few roundings.
#[track_caller]
fn same(found: f64, expected: f64, scale: f64) {
    assert!(
        (found - expected).abs() < 1e-13 * scale,
        "{found} is not {expected}"
    );
}

fn places(s: &Simulation) -> impl Iterator<Item = (usize, Vec3)> {
    let p = &s.particles;
    (0..p.owned()).map(|i| (i, p.position[i].into()))
}

#[test]
fn each_particle_begins_as_its_formula_says() {
    let s = start(block(
        "0.5 mm",
        "velocity = [\"0.1 km/s * (x - x0) / 1 mm\", \"10 m/s * sin(2 * pi * y / 10 mm)\", \
         \"-3 km/s * (1 - (r / 5 mm)^2)\"]\n\
         angular_velocity = [0, 0, \"1e4 rad/s\"]\n\
         temperature = \"20 °C + 20 K/mm * z\"\n\
         plastic_strain = \"0.1 * step(z - 3 mm)\"",
    ));
    let case = &s.case;
    let material = &case.materials[case.bodies[0].material];
    let centre = Vec3::new(1e-3, 2e-3, 3e-3);
    assert_eq!(s.particles.owned(), 12 * 10 * 8);
    for (i, x) in places(&s) {
        let arm = x - centre;
        let r = arm.norm();
        let v = s.particles.velocity[i];
        same(v[0], 1e5 * arm[0] - 1e4 * arm[1], 300.0);
        let wave = 10.0 * libm::sin(200.0 * std::f64::consts::PI * x[1]);
        same(v[1], wave + 1e4 * arm[0], 40.0);
        same(v[2], -3e3 * (1.0 - r * r / 25e-6), 3e3);
        assert_eq!(v, s.particles.predicted_velocity[i]);
        let (rho, e) = (s.particles.density[i], s.particles.specific_energy[i]);
        let temperature = material.temperature(rho, e, [0.0, 0.0]).unwrap();
        same(temperature, 293.15 + 2e4 * x[2], 400.0);
        let strain = if x[2] > 3e-3 { 0.1 } else { 0.0 };
        same(s.particles.plastic_strain[i], strain, 1.0);
    }
    // What the speeds of contact and of the numerical limits are taken from.
    let body = &case.bodies[0];
    for (i, _) in places(&s) {
        let off = Vec3::from(s.particles.velocity[i]) - body.velocity;
        assert!(off.norm() <= body.speed_spread());
    }
    assert!(body.initial.velocity_spread < 1600.0, "{:?}", body.initial);
    assert!(case.impact_speed() >= 3e3);
    let hottest = case.initial_energy(body);
    assert!(places(&s).all(|(i, _)| s.particles.specific_energy[i] <= hottest));
}

/// Heat at the reference density is pressure: `Γ ρ c_v ΔT` of Mie–Grüneisen's equation.
#[test]
fn a_temperature_is_an_energy_with_its_pressure() {
    let case = block("1 mm", "temperature = \"600 K\"");
    let material = &case.materials[case.bodies[0].material];
    let rho = material.reference_density;
    let heat = material.thermal.as_ref().unwrap().constants().specific_heat;
    let energy = case.initial_energy(&case.bodies[0]);
    let cold = material.energy(rho, 293.15).unwrap();
    assert!((energy - cold - heat * (600.0 - 293.15)).abs() < 1e-9 * energy);
    let pressure = material.eos.at(rho, rho, energy).pressure;
    // Γ = 2.02, ρ = 8930 kg/m³, c_v = 383 J/(kg K), from 298 K or so.
    assert!((1.9e9..2.3e9).contains(&pressure), "{pressure}");
    let said = warnings(&case, &approaches(&case)).join("\n");
    assert!(said.contains("begins with a pressure of 2.07"), "{said}");
    let density = said.split("at a `density` of ").nth(1).expect(&said);
    let density = density.split(" it is free").next().unwrap();
    let free = block(
        "1 mm",
        &format!("temperature = \"600 K\"\ndensity = \"{density}\""),
    );
    let body = &free.bodies[0];
    let state = material
        .eos
        .at(rho, free.initial_density(body), free.initial_energy(body));
    assert!(state.pressure.abs() < 1e7, "{}", state.pressure);
    assert!(
        !warnings(&free, &approaches(&free))
            .join("\n")
            .contains("begins with a pressure")
    );
    let s = start(free);
    for (i, _) in places(&s) {
        let (rho, e) = (s.particles.density[i], s.particles.specific_energy[i]);
        let found = material.temperature(rho, e, [0.0, 0.0]).unwrap();
        assert!((found - 600.0).abs() < 1e-9, "{found}");
    }
}

/// What a cut-off has torn is denser than its mean: its energy is found all the same.
#[test]
fn torn_matter_has_the_temperature_that_it_is_given() {
    let case = inline(
        "dimension = 1\nspacing = \"1 mm\"\n[run]\nend_time = \"1 us\"\n\
         [material.copper]\nlibrary = \"copper-johnson-cook\"\nfailure.spall.pressure = \"-1 GPa\"\n\
         [[body]]\nname = \"bar\"\nmaterial = \"copper\"\nshape.box.size = [\"9 mm\"]\n\
         density = \"8.5 g/cm^3\"\ntemperature = \"500 K\"\n",
    );
    let body = &case.bodies[0];
    let material = &case.materials[body.material];
    let (rho, e) = (case.initial_density(body), case.initial_energy(body));
    assert!(material.eos.at(8930.0, rho, e).pressure < -2e9);
    let found = material.temperature(rho, e, [0.0, 0.0]).unwrap();
    assert!((found - 500.0).abs() < 1e-9, "{found}");
}

#[test]
fn a_turn_about_a_point_keeps_its_angular_momentum_there() {
    let about = Vec3::new(2e-2, -1e-2, 0.0);
    let rate = Vec3::new(0.0, 0.0, 2e3);
    for (velocity, own) in [
        ("", Vec3::zeros()),
        ("velocity = [0, 0, \"30 m/s * (2 - z / z0)\"]\n", Vec3::z()),
    ] {
        let mut s = start(block(
            "1 mm",
            &format!(
                "{velocity}angular_velocity = {{ rate = [0, 0, \"2000 rad/s\"], \
                 about = [\"20 spacing\", \"-1 cm\", 0] }}"
            ),
        ));
        let momentum = |s: &Simulation| {
            let each = places(s).map(|(i, x)| {
                (x - about).cross(&Vec3::from(s.particles.velocity[i])) * s.particles.mass[i]
            });
            each.fold(Vec3::zeros(), |sum, l| sum + l)
        };
        for (i, x) in places(&s) {
            let field = own * (30.0 * (2.0 - x[2] / 3e-3));
            let expected = field + rate.cross(&(x - about));
            let off = Vec3::from(s.particles.velocity[i]) - expected;
            assert!(off.norm() < 1e-13 * 60.0, "{off}");
        }
        let before = momentum(&s);
        run_to(&mut s, 3e-6);
        assert!(s.state.step > 10);
        let moved = (momentum(&s) - before).norm() / before.norm();
        assert!(moved < 1e-12, "{moved:e}");
    }
    // In two dimensions about z, and the velocity of the centre is that by the turn.
    let case = inline(
        "dimension = 2\nspacing = \"1 mm\"\n[run]\nend_time = \"1 us\"\n\
         [material.copper]\nlibrary = \"copper\"\n\
         [[body]]\nname = \"disc\"\nmaterial = \"copper\"\n\
         shape.sphere = { centre = [\"30 mm\", 0], radius = \"8 mm\" }\nvelocity = [\"5 m/s\", 0]\n\
         angular_velocity = { rate = [\"100 rad/s\"], about = [0, 0] }\n",
    );
    let v = case.bodies[0].velocity;
    assert!((v - Vec3::new(5.0, 3.0, 0.0)).norm() < 1e-13, "{v}");
}

#[test]
fn check_tells_what_bodies_begin_with() {
    let told = |more: &str| {
        let case = block("0.5 mm", more);
        beginning(&case, &case.bodies[0]).unwrap_or_default()
    };
    assert_eq!(told(""), "");
    assert_eq!(
        told("velocity = [0, 0, \"-3 km/s\"]"),
        "velocity [0, 0, -3] km/s"
    );
    assert_eq!(
        told("velocity = [0, 0, \"1 km/s * z / 1 mm\"]\nplastic_strain = 0.2"),
        "z velocity 1.25 km/s to 4.75 km/s, plastic strain 0.2"
    );
    assert_eq!(
        told("angular_velocity = [0, 0, \"1000 rad/s\"]"),
        "x velocity -2.25 m/s to 2.25 m/s, y velocity -2.75 m/s to 2.75 m/s"
    );
    let hot = told("temperature = \"300 K + 100 K * step(z - z0)\"");
    assert!(
        hot.starts_with("temperature 300 K to 400 K, pressure "),
        "{hot}"
    );
    let hot = told("specific_energy = \"10 kJ/kg * exp(-r / 1 mm)\"");
    assert!(hot.starts_with("specific energy "), "{hot}");
    let cold = told("density = \"8.8 g/cm^3\"");
    assert!(
        cold.starts_with("density 8800 kg/m^3, pressure -"),
        "{cold}"
    );
}

/// Each particle is looked at as the run begins, of large bodies too.
#[test]
fn a_particle_out_of_range_stops_the_start() {
    let case = inline(
        "dimension = 2\nspacing = \"0.1 mm\"\n[run]\nend_time = \"1 us\"\n\
         [material.copper]\nlibrary = \"copper\"\n\
         [[body]]\nname = \"plate\"\nmaterial = \"copper\"\n\
         shape.box = { centre = [\"3 mm\", 0], size = [\"40 mm\", \"40 mm\"] }\n\
         velocity = [\"1 m/s / step(r - 0.08 mm)\", 0]\n",
    );
    let Err(error) = Simulation::start(case, &Comm::solo()) else {
        panic!("it starts");
    };
    let said = error.to_string();
    assert!(
        said.starts_with("`velocity` of `plate` is inf m/s at ["),
        "{said}"
    );
    assert!(said.ends_with("and must be slower than light"), "{said}");
}

/// A formula is followed in less than a microsecond, and a body of a billion particles is read in
/// seconds.
#[test]
fn formulas_are_fast() {
    let more = "velocity = [\"100 m/s * sin(2 * pi * x / 3 mm)\", 0, \"-3 km/s * (1 - (r / 5 mm)^2)\"]\n\
                temperature = \"300 K + 50 K * exp(-(r / 2 mm)^2)\"";
    let case = block("0.1 mm", more);
    let body = &case.bodies[0];
    let sites: Vec<Vec3> = populate::sites(body, 3, &[], None)
        .map(|site| site.position.into())
        .collect();
    assert_eq!(sites.len(), 120_000);
    let begun = Instant::now();
    let sum: f64 = sites
        .iter()
        .map(|x| case.beginning(body, x).velocity[2])
        .sum();
    let each = begun.elapsed().as_secs_f64() / 120_000.0;
    assert!(sum.is_finite());
    println!("{:.0} ns a particle", 1e9 * each);
    // Ten times what it takes on a busy core without optimisation.
    assert!(each < 1e-5, "{each}");
    let begun = Instant::now();
    let huge = block("5 um", more);
    let count = populate::count(&huge.bodies[0], 3, &[], None);
    assert_eq!(count, 1200 * 1000 * 800);
    let spread = huge.bodies[0].initial.velocity_spread;
    assert!(
        (spread / body.initial.velocity_spread - 1.0).abs() < 0.1,
        "{spread}"
    );
    assert!(begun.elapsed().as_secs() < 30);
}

/// What begins at rest, or nearly so, has errors as well: of the largest motion so far, not of the first.
#[test]
fn errors_are_of_the_largest_motion_so_far() {
    for first in ["0 m/s", "1 um/s"] {
        let mut s = start(block(
            "1 mm",
            &format!("density = \"9500 kg/m^3\"\nvelocity = [\"{first}\", 0, 0]"),
        ));
        let (mut motion, mut energy) = (0.0_f64, 0.0_f64);
        run_with(&mut s, 2e-6, |s| {
            motion = motion.max(s.state.totals.momentum_scale);
            energy = energy.max(s.state.totals.kinetic_energy);
        });
        let worst = s.state.worst;
        println!("{first}: {energy} J, {motion} N s; {worst:?}");
        assert!(s.state.initial.kinetic_energy < 1e-12 * energy);
        assert_eq!(worst.energy_error, worst.energy_deviation / energy);
        for a in 0..3 {
            assert_eq!(
                worst.momentum_error[a],
                worst.momentum_deviation[a] / motion
            );
        }
        assert!((0.0..1e-10).contains(&worst.energy_error) && worst.energy_error > 0.0);
        assert!(worst.momentum_error.iter().all(|&e| e < 1e-13));
        let turned = worst.angular_momentum_error.into_iter().fold(0.0, f64::max);
        assert!(turned > 0.0 && turned < 1e-3, "{turned:e}");
    }
}
