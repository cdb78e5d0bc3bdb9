//! Cloth in one dimension: pressed through its thickness, pulled along its yarns.

use crate::physics_support::{inline, run_with, start};
use material::library;

/// A layer that flies against a rigid wall at 500 m/s crushes its pores by a shock, with the pressure, density and speed of the jump conditions.
#[test]
fn cloth_is_crushed_by_the_shock_of_the_jump_conditions() {
    let cloth = library::find("nextel-312-fabric").unwrap();
    let (rho0, speed) = (cloth.reference_density, 500.0);
    // p = ρ₀ U u, ρ (U − u) = ρ₀ U, e = u²/2: of the density, by bisection.
    let (mut low, mut high) = (1.2 * rho0, 4.0 * rho0);
    let pressure = |rho: f64| rho0 * speed * speed * rho / (rho - rho0);
    for _ in 0..100 {
        let rho = 0.5 * (low + high);
        if cloth.loaded(rho, 0.5 * speed * speed).pressure < pressure(rho) {
            low = rho;
        } else {
            high = rho;
        }
    }
    let mut s = start(inline(
        "dimension = 1\nspacing = \"0.1 mm\"\n[run]\nend_time = \"20 us\"\n\
         [material.cloth]\nlibrary = \"nextel-312-fabric\"\n\
         [[body]]\nname = \"layer\"\nmaterial = \"cloth\"\n\
         shape.box = { lower = [0], upper = [\"20 mm\"] }\nvelocity = [\"-500 m/s\"]\n\
         [[plane]]\nname = \"wall\"\nnormal = \"+x\"\n",
    ));
    let mut found = [0.0; 2];
    run_with(&mut s, 1.0, |s| {
        let p = &s.particles;
        if s.state.time < 15e-6 {
            return;
        }
        let inside = |i: &usize| (1e-3..3e-3).contains(&p.position[*i][0]);
        let rows: Vec<usize> = (0..p.owned()).filter(inside).collect();
        let count = f64::from(u32::try_from(rows.len()).unwrap());
        let mean = |of: &dyn Fn(usize) -> f64| rows.iter().map(|&i| of(i)).sum::<f64>() / count;
        // Direction 3 is along x, through the layer, so that no yarn bears any of it.
        assert!(rows.iter().all(|&i| p.normal[i][0] == 1.0));
        found = [
            mean(&|i| p.pressure[i] - p.deviatoric_stress[i][0]),
            mean(&|i| p.density[i]),
        ];
    });
    let exact = [pressure(low), low];
    println!("{found:?} of {exact:?}");
    assert!(
        (found[0] / exact[0] - 1.0).abs() < 0.02,
        "{found:?} {exact:?}"
    );
    assert!(
        (found[1] / exact[1] - 1.0).abs() < 0.02,
        "{found:?} {exact:?}"
    );
}

/// A pull runs along the yarns with the speed of their fibres, half of which lie that way.
#[test]
fn a_pull_runs_along_the_yarns() {
    let mut s = start(inline(
        "dimension = 1\nspacing = \"0.5 mm\"\n[run]\nend_time = \"40 us\"\n\
         [material.cloth]\nlibrary = \"nextel-312-fabric\"\n\
         [[body]]\nname = \"strip\"\nmaterial = \"cloth\"\n\
         shape.box = { lower = [0], upper = [\"300 mm\"] }\nfibres = { normal = \"z\" }\n\
         [[load]]\nname = \"pull\"\nbody = \"strip\"\nbelow = { x = \"1 spacing\" }\n\
         velocity = { times = [0, \"2 us\"], x = [0, \"-0.2 m/s\"] }\n",
    ));
    let mut fronts = Vec::new();
    run_with(&mut s, 1.0, |s| {
        let p = &s.particles;
        let mut rows: Vec<(f64, f64)> = (0..p.owned())
            .map(|i| (p.position[i][0], -p.velocity[i][0]))
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
    let found = (last.1 - first.1) / (last.0 - first.0);
    let exact = (75e9_f64 / 2700.0).sqrt();
    println!("{found:.1} of {exact:.1}");
    assert!((found / exact - 1.0).abs() < 5e-3, "{found} {exact}");
}
