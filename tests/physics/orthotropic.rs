//! Waves in matter with directions of its own.

use std::collections::BTreeMap;

use crate::physics_support::{inline, run_with, start};
use engine::step::Simulation;

/// Moduli `C_11`, `C_22`, `C_33` (1e9 Pa) of the lamina below, by inversion of its compliances.
const STRETCH: [f64; 3] = [142.5779, 12.4038, 11.1364];

/// Speed (m/s) of a step of velocity along x between two times (s), by where half of it is.
fn speed(fibres: &str) -> f64 {
    let mut s = start(inline(&format!(
        "dimension = 1\nspacing = \"0.5 mm\"\n[run]\nend_time = \"24 us\"\n\
         [material.lamina]\ndensity = \"1600 kg/m^3\"\n\
         eos.linear = {{ bulk_modulus = \"15 GPa\" }}\n\
         strength.orthotropic = {{ e1 = \"140 GPa\", e2 = \"10 GPa\", e3 = \"9 GPa\", nu12 = 0.3, nu13 = 0.25, \
         nu23 = 0.45, g12 = \"5 GPa\", g13 = \"4.5 GPa\", g23 = \"3.5 GPa\" }}\n\
         [[body]]\nname = \"bar\"\nmaterial = \"lamina\"\n\
         shape.box = {{ lower = [0], upper = [\"300 mm\"] }}\nfibres = {fibres}\n\
         [[load]]\nname = \"push\"\nbody = \"bar\"\nbelow = {{ x = \"1 spacing\" }}\n\
         velocity = {{ times = [0, \"2 us\"], x = [0, \"0.2 m/s\"] }}\n"
    )));
    let mut fronts = Vec::new();
    run_with(&mut s, 1.0, |s| {
        let p = &s.particles;
        let mut rows: Vec<(f64, f64)> = (0..p.owned())
            .map(|i| (p.position[i][0], p.velocity[i][0]))
            .collect();
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        if s.state.time < 8e-6 {
            return;
        }
        if let Some(k) = rows.windows(2).rposition(|w| w[0].1 >= 0.1) {
            let ((x, v), (y, w)) = (rows[k], rows[k + 1]);
            fronts.push((s.state.time, x + (y - x) * (v - 0.1) / (v - w)));
        }
    });
    let (first, last) = (fronts[0], fronts[fronts.len() - 1]);
    (last.1 - first.1) / (last.0 - first.0)
}

#[test]
fn waves_run_with_the_stiffness_of_their_direction() {
    let fibres = [
        "{}",
        "{ along = [0, 1, 0] }",
        "{ along = [0, 1, 0], normal = [1, 0, 0] }",
    ];
    for (stiffness, fibres) in STRETCH.into_iter().zip(fibres) {
        let exact = (stiffness * 1e9 / 1600.0).sqrt();
        let found = speed(fibres);
        println!("{found:.1} of {exact:.1}");
        assert!((found / exact - 1.0).abs() < 2e-3, "{found} {exact}");
    }
}

/// Young's modulus of the lamina at an angle of its fibres, and contractions and shear of a stretch of one (Jones 1999,
/// *Mechanics of Composite Materials*, equations 2.97).
fn off_axis(degrees: f64) -> [f64; 4] {
    let (s, c) = degrees.to_radians().sin_cos();
    let [e1, e2, g12] = [140e9, 10e9, 5e9];
    let along = c.powi(4) / e1 + (1.0 / g12 - 0.6 / e1) * (s * c).powi(2) + s.powi(4) / e2;
    let across =
        (1.0 / e1 + 1.0 / e2 - 1.0 / g12) * (s * c).powi(2) - 0.3 / e1 * (s.powi(4) + c.powi(4));
    let through = -(0.25 / e1 * c * c + 0.45 / e2 * s * s);
    let shear = (2.0 / e1 + 0.6 / e1 - 1.0 / g12) * s * c.powi(3)
        - (2.0 / e2 + 0.6 / e1 - 1.0 / g12) * s.powi(3) * c;
    [1.0 / along, across / along, through / along, shear / along]
}

/// Strips whose fibres are aslant are pulled between ends that move along x: their stress is along them alone.
#[test]
fn strips_off_the_axes_are_as_stiff_as_the_closed_form() {
    for degrees in [0.0, 30.0, 60.0] {
        let [modulus, across, through, shear] = off_axis(degrees);
        let rate = 200.0;
        let [y, z, yx] = [across, through, shear].map(|part| part * rate);
        let mut s = start(inline(&format!(
            "dimension = 3\nspacing = \"0.5 mm\"\n[run]\nend_time = \"10 us\"\n\
             [material.lamina]\ndensity = \"1600 kg/m^3\"\neos.linear = {{ bulk_modulus = \"15 GPa\" }}\n\
             strength.orthotropic = {{ e1 = \"140 GPa\", e2 = \"10 GPa\", e3 = \"9 GPa\", nu12 = 0.3, nu13 = 0.25, \
             nu23 = 0.45, g12 = \"5 GPa\", g13 = \"4.5 GPa\", g23 = \"3.5 GPa\" }}\n\
             [[body]]\nname = \"strip\"\nmaterial = \"lamina\"\n\
             shape.box = {{ lower = [\"-8 mm\", \"-3 mm\", \"-2 mm\"], upper = [\"8 mm\", \"3 mm\", \"2 mm\"] }}\n\
             lattice = \"cubic\"\nfibres = {{ angle = \"{degrees} deg\" }}\n\
             velocity = [\"{rate}/s * x\", \"{y}/s * y + {yx}/s * x\", \"{z}/s * z\"]\n\
             [[load]]\nname = \"left\"\nbody = \"strip\"\nbelow = {{ x = \"-7.5 mm\" }}\n\
             velocity = {{ x = \"{} m/s\" }}\n\
             [[load]]\nname = \"right\"\nbody = \"strip\"\nabove = {{ x = \"7.5 mm\" }}\n\
             velocity = {{ x = \"{} m/s\" }}\n",
            -7.75e-3 * rate,
            7.75e-3 * rate,
        )));
        let at = |s: &Simulation, i: usize| (s.particles.id[i], s.particles.position[i][0]);
        let begins: BTreeMap<u64, f64> = (0..s.particles.owned()).map(|i| at(&s, i)).collect();
        let (mut sum, mut count, mut worst) = (0.0, 0.0, 0.0_f64);
        run_with(&mut s, 1.0, |s| {
            if s.state.time < 5e-6 {
                return;
            }
            // Strain by least squares: near the ends it is less.
            let (mut stretch, mut square, mut stress, mut number) = (0.0, 0.0, 0.0, 0.0);
            for i in 0..s.particles.owned() {
                let (id, x) = at(s, i);
                let first = begins[&id];
                if first.abs() < 4e-3 {
                    let deviator = s.particles.deviatoric_stress[i];
                    let normal = |c: usize| deviator[c] - s.particles.pressure[i];
                    (stretch, square) = (stretch + (x - first) * first, square + first * first);
                    (stress, number) = (stress + normal(0), number + 1.0);
                    worst = worst.max(normal(1).abs() / (modulus * rate * s.state.time));
                }
            }
            sum += stress / number / (stretch / square);
            count += 1.0;
        });
        let found = sum / count;
        println!(
            "{degrees}: {:.4} of {modulus:e}, across {worst:.3}",
            found / modulus
        );
        assert!((found / modulus - 1.0).abs() < 0.01, "{degrees}: {found:e}");
    }
}
