//! Waves in matter with directions of its own.

use crate::physics_support::{inline, run_with, start};

/// Moduli `C_11`, `C_22`, `C_33` (GPa) of the lamina below, by inversion of its compliances.
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
         velocity = {{ times = [0, \"2 us\"], x = [0, \"1 m/s\"] }}\n"
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
        if let Some(k) = rows.windows(2).rposition(|w| w[0].1 >= 0.5) {
            let ((x, v), (y, w)) = (rows[k], rows[k + 1]);
            fronts.push((s.state.time, x + (y - x) * (v - 0.5) / (v - w)));
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
