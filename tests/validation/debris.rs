//! What a cloud costs that has spread far beyond the body it comes from.

use std::time::Instant;

use crate::common::outcome::{advance, start};
use crate::common::{body, case};
use crate::physics_support::{self, inline, run_to};
use engine::step::Simulation;
use model::{Shape, Vec3};

/// Spacings across the body.
const ACROSS: f64 = 100.0;

/// Seconds that the quickest of some steps takes.
fn seconds_a_step(simulation: &mut Simulation) -> f64 {
    advance(simulation, 1);
    let steps = (0..3).map(|_| {
        let begin = Instant::now();
        advance(simulation, 1);
        begin.elapsed().as_secs_f64()
    });
    steps.fold(f64::INFINITY, f64::min)
}

#[test]
#[ignore = "slow: a million particles"]
fn a_cloud_over_a_hundred_body_sizes_costs_what_the_body_does() {
    let half = Vec3::repeat(0.5 * ACROSS * 1e-4);
    let cube = Shape::Box {
        lower: -half,
        upper: half,
    };
    let mut simulation = start(case(3, vec![body("cube", cube, 1e-4, Vec3::zeros())], 1.0));
    // The sums of a body at rest too, as a cloud in flight has them.
    simulation.search.lists.spare_quiescent = false;
    let count = simulation.particles.owned();
    let compact = seconds_a_step(&mut simulation);
    for factor in [2.0, 10.0, 50.0, 100.0] {
        // Lattices of other spacings, which meet nobody.
        let widest = simulation.particles.position[..count]
            .iter()
            .fold(0.0, |most: f64, x| most.max(x[0]));
        let spread = factor * half[0] / widest;
        for x in &mut simulation.particles.position[..count] {
            *x = x.map(|x| spread * x);
        }
        let spread = seconds_a_step(&mut simulation);
        println!(
            "{count} particles over {factor} body sizes: {:.3} of {compact:.3} s, {:.2}",
            spread,
            spread / compact
        );
        assert!(spread <= 1.2 * compact, "{factor}: {spread} for {compact}");
    }
}

/// A quarter of a sphere of 3.18 mm that has gone through a plate of .84 mm at 7.2 km/s, in a glass of this seed.
fn quarter_of_a_cloud(seed: u32) -> Simulation {
    let text = format!(
        "dimension = 3\nspacing = \"0.14 mm\"\n[run]\nend_time = \"6 us\"\n\
         [time_step]\ncourant = 0.65\nforce = 0.2\ncontact = 1.0\n\
         [material.2024]\nlibrary = \"aluminium-2024-ductile\"\n\
         [material.6061]\nlibrary = \"aluminium-6061-ductile\"\n\
         [[body]]\nname = \"bumper\"\nmaterial = \"6061\"\nlattice = {{ kind = \"glass\", seed = {} }}\n\
         shape.cylinder = {{ axis = \"z\", radius = \"10 mm\", length = \"0.84 mm\", centre = [0, 0, \"0.42 mm\"] }}\n\
         spacing = {{ inner = \"0.14 mm\", outer = \"0.28 mm\", at = [0, 0, 0], axis = \"z\", within = \"4 mm\" }}\n\
         [[body]]\nname = \"sphere\"\nmaterial = \"2024\"\nlattice = {{ kind = \"glass\", seed = {seed} }}\n\
         shape.sphere = {{ centre = [0, 0, \"3 mm\"], radius = \"1.59 mm\" }}\n\
         velocity = [0, 0, \"-7.20 km/s\"]\ntouch = {{ body = \"bumper\", direction = \"-z\" }}\n\
         [[symmetry]]\naxis = \"x\"\n[[symmetry]]\naxis = \"y\"\n",
        seed + 50
    );
    physics_support::start(inline(&text))
}

/// Particles that fly towards a symmetry plane go on as others do in a whole model: where a wall is, 50.8 mm behind the
/// plate, the cloud is as dense at the planes as beside them. Eight whole models have 1.00 ± .06 here; 2.1 if dust sticks
/// to its images.
#[test]
#[ignore = "slow: three clouds of a quarter"]
fn a_quarter_is_as_dense_at_its_planes_as_beside_them() {
    let (mut near, mut all) = (0.0, 0.0);
    for seed in 1..4 {
        let mut s = quarter_of_a_cloud(seed);
        run_to(&mut s, 6e-6);
        for i in 0..s.particles.owned() {
            let (x, v) = (s.particles.position[i], s.particles.velocity[i]);
            if v[2] > -300.0 {
                continue;
            }
            let time = (-50.8e-3 - x[2]) / v[2];
            let at = [0, 1].map(|a| (x[a] + v[a] * time).abs());
            if libm::hypot(at[0], at[1]) > 6e-3 {
                continue;
            }
            let momentum = -s.particles.mass[i] * v[2];
            for distance in at {
                near += if distance < 0.1e-3 { momentum } else { 0.0 };
                all += if distance < 2e-3 { momentum } else { 0.0 };
            }
        }
    }
    let denser = 20.0 * near / all;
    println!("{denser:.2} times as dense within .1 mm of the planes as within 2 mm");
    assert!((0.5..1.5).contains(&denser), "{denser}");
}

/// Share of a sphere of 3.175 mm that is whole after a plate of .787 mm, at a speed (km/s), 4 µs after they have met.
fn whole_share(spacing: &str, speed: &str) -> f64 {
    let text = format!(
        "dimension = 3\nspacing = \"{spacing}\"\n[run]\nend_time = \"4 us\"\n\
         [material.2017]\nlibrary = \"aluminium-2024-ductile\"\n\
         [material.6061]\nlibrary = \"aluminium-6061-ductile\"\n\
         [[body]]\nname = \"bumper\"\nmaterial = \"6061\"\n\
         shape.cylinder = {{ axis = \"z\", radius = \"6 mm\", length = \"0.787 mm\" }}\n\
         [[body]]\nname = \"sphere\"\nmaterial = \"2017\"\n\
         shape.sphere = {{ centre = [0, 0, \"5 mm\"], diameter = \"3.175 mm\" }}\n\
         velocity = [0, 0, \"-{speed} km/s\"]\ntouch = {{ body = \"bumper\", direction = \"-z\" }}\n"
    );
    let mut s = physics_support::start(inline(&text));
    run_to(&mut s, 4e-6);
    let all = &s.particles;
    let (mut whole, mut of) = (0.0, 0.0);
    for i in (0..all.owned()).filter(|&i| all.body[i] == 1) {
        of += all.mass[i];
        whole += if all.damage[i] < 1.0 {
            all.mass[i]
        } else {
            0.0
        };
    }
    whole / of
}

/// Behind this plate walls of 4.06 mm were perforated at 2.6 to 3.1 km/s (Ryan, Bjorkman & Christiansen 2011, Int. J. Impact
/// Eng. 38, 504), which takes about half of the sphere in one piece; those of 2.54 mm held at 4.7 km/s.
#[test]
#[ignore = "slow: whole spheres through plates"]
fn a_sphere_at_three_kilometres_a_second_does_not_turn_to_dust() {
    for spacing in ["0.2 mm", "0.15 mm"] {
        let [slow, fast] = ["3", "4.7"].map(|speed| whole_share(spacing, speed));
        println!("{spacing}: {slow:.3} whole at 3 km/s, {fast:.3} at 4.7 km/s");
        assert!(slow > 0.35 && fast < 0.2, "{slow} {fast}");
    }
}
