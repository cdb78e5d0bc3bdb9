//! Debris on a wall: what single particles and lumps of a few leave it with.

use std::fmt::Write as _;

use crate::physics_support::{inline, run_to, start};

/// Spacing (mm).
const SPACING: f64 = 0.32;

/// A plate with cubes of one, two and three particles a side over it, at three places of the lattice
/// each, at `speed` (km/s).
fn rain(speed: f64) -> String {
    let mut text = format!(
        "dimension = 3\nspacing = \"{SPACING} mm\"\n[run]\nend_time = \"9 us\"\n\
         [time_step]\ncourant = 0.3\ncontact = 0.3\n\
         [material.2024]\nlibrary = \"aluminium-2024-ductile\"\n\
         [[body]]\nname = \"plate\"\nmaterial = \"2024\"\n\
         shape.box = {{ size = [\"12.8 mm\", \"12.8 mm\", \"3.84 mm\"], centre = [0, 0, \"-1.92 mm\"] }}\n"
    );
    for (side, x) in [(1.0, -4.0), (2.0, 0.0), (3.0, 4.0)] {
        for (place, y) in [-4.0, 0.0, 4.0].into_iter().enumerate() {
            let aside = [0.0, 0.25, 0.5][place] * SPACING;
            let size = side * SPACING * 1.0001;
            writeln!(
                text,
                "[[body]]\nname = \"cube-{side}-{place}\"\nmaterial = \"2024\"\n\
                 shape.box = {{ size = [\"{size} mm\", \"{size} mm\", \"{size} mm\"], \
                 centre = [\"{x} mm\", \"{y} mm\", \"{z} mm\"] }}\n\
                 velocity = [0, 0, \"-{speed} km/s\"]",
                x = x + aside,
                y = y + 0.7 * aside,
                z = 2.0 * SPACING + 0.5 * size
            )
            .unwrap();
        }
    }
    text + "[contact]\nmode = \"overlap\"\n"
}

/// A particle alone has no sums that could take heat: contact takes it, so that it leaves a wall as
/// slowly as lumps do, and energy is kept.
#[test]
#[ignore = "slow"]
fn single_particles_stay_where_lumps_do() {
    for (speed, time, bounds) in [(5.7, 1e-6, [0.25, 0.15]), (3.0, 1.6e-6, [0.4, 0.2])] {
        let mut s = start(inline(&rain(speed)));
        run_to(&mut s, time);
        let mut momentum = [[0.0; 2]; 10];
        for i in 0..s.particles.owned() {
            let [sum, mass] = &mut momentum[s.particles.body[i] as usize];
            *sum += s.particles.mass[i] * s.particles.velocity[i][2];
            *mass += s.particles.mass[i];
        }
        let left: Vec<f64> = momentum[1..]
            .iter()
            .map(|[sum, mass]| sum / mass / (1e3 * speed))
            .collect();
        let error = s.state.worst.energy_error;
        println!("{speed} km/s: {left:.3?}, energy {error:.1e}");
        for (place, &left) in left.iter().enumerate() {
            let bound = bounds[usize::from(place >= 3)];
            assert!((-0.05..bound).contains(&left), "{place}: {left}");
        }
        // Of contact's time integration, and of second order in the step.
        assert!(error < 4e-3, "{error}");
        // Half-spaces are not isolated.
        let plate = (0..s.particles.owned()).filter(|&i| s.particles.body[i] == 0);
        let alone = plate.filter(|&i| s.particles.isolation[i] > 0.0).count();
        assert!(alone < 40, "{alone} particles of the plate are isolated");
    }
}
