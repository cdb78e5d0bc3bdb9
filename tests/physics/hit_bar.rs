//! A free elastic bar that another one hits near its end: it turns, on and on in one direction, and angular
//! momentum stays to rounding.

use crate::physics_support::{inline, run_to, start};
use engine::step::Simulation;

/// A bar of 40 x 8 (x 8) mm at rest and a block that hits it from below at a twentieth of the speed of sound.
/// `half`: a symmetry plane at z = 0.
fn bars(dimension: usize, lattice: &str, half: bool) -> Simulation {
    let (spacing, depth) = match (dimension, half) {
        (2, _) => (1, ["", ""]),
        (_, false) => (2, [", \"-4 mm\"", ", \"4 mm\""]),
        (_, true) => (2, [", 0", ", \"4 mm\""]),
    };
    let body = |name: &str, [left, right]: [i32; 2], [lower, upper]: [i32; 2], more: &str| {
        let [near, far] = depth;
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"soft\"\nlattice = \"{lattice}\"\n\
             shape.box = {{ lower = [\"{left} mm\", \"{lower} mm\"{near}], \
             upper = [\"{right} mm\", \"{upper} mm\"{far}] }}\n{more}\n"
        )
    };
    let bar = body("bar", [-20, 20], [-4, 4], "");
    let zero = if dimension == 2 { "" } else { ", 0" };
    let velocity = format!("velocity = [0, \"5 m/s\"{zero}]");
    let block = body("block", [12, 20], [-14, -6], &velocity);
    let plane = if half {
        "[[symmetry]]\naxis = \"z\"\n"
    } else {
        ""
    };
    start(inline(&format!(
        "dimension = {dimension}\nspacing = \"{spacing} mm\"\nrun.end_time = \"10 ms\"\n\
         [material.soft]\ndensity = \"1000 kg/m^3\"\neos.linear.bulk_modulus = \"10 MPa\"\n\
         strength.elastic.shear_modulus = \"3 MPa\"\n{bar}{block}{plane}"
    )))
}

/// Angle (degrees) between the x axis and the line through the means of the bar's halves.
fn angle(s: &Simulation, right: &[u64]) -> f64 {
    let p = &s.particles;
    let mut means = [[0.0; 3]; 2];
    for i in (0..p.owned()).filter(|&i| p.body[i] == 0) {
        let side = usize::from(right.contains(&p.id[i]));
        means[side][0] += p.position[i][0];
        means[side][1] += p.position[i][1];
        means[side][2] += 1.0;
    }
    let [left, right] = means.map(|[x, y, n]| [x / n, y / n]);
    (right[1] - left[1]).atan2(right[0] - left[0]).to_degrees()
}

#[test]
#[ignore = "slow"]
fn a_bar_that_is_hit_turns_on() {
    for (dimension, lattice, half) in [
        (2, "cubic", false),
        (2, "hexagonal", false),
        (3, "cubic", false),
        (3, "hexagonal", false),
        (3, "cubic", true),
    ] {
        let mut s = bars(dimension, lattice, half);
        let p = &s.particles;
        let right = (0..p.owned()).filter(|&i| p.body[i] == 0 && p.position[i][0] > 0.0);
        let right: Vec<u64> = right.map(|i| p.id[i]).collect();
        let first = angle(&s, &right);
        let mut angles = Vec::new();
        for k in 1..=5 {
            run_to(&mut s, 2e-3 * f64::from(k));
            angles.push(angle(&s, &right) - first);
        }
        let worst = &s.state.worst;
        println!(
            "{dimension}-D {lattice} {half}: {} steps, turns by {angles:.1?} degrees, angular momentum \
             {:.0e}, energy {:.0e}",
            s.state.step,
            worst
                .angular_momentum_error
                .iter()
                .fold(0.0_f64, |a, &b| a.max(b)),
            worst.energy_error
        );
        assert!(
            worst.angular_momentum_error.iter().all(|&e| e < 1e-12),
            "{worst:?}"
        );
        assert!(worst.momentum_error.iter().all(|&e| e < 1e-12), "{worst:?}");
        let steps = angles.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(angles[0] > 2.0 && steps.clone().fold(f64::INFINITY, f64::min) > 2.0);
        // As fast at the end as after the impact, but for the bar's vibration.
        let steps: Vec<f64> = steps.collect();
        assert!((steps[3] / steps[0] - 1.0).abs() < 0.1, "{steps:?}");
    }
}
