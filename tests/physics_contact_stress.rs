//! Stress beside an interface: that of the material, and with what contact forces carry.

mod physics_support;

use physics_support::{ready, run_to, sorted_by, start};
use whipple::exact::hugoniot::{Medium, impact};
use whipple::step::Simulation;

/// Normal stress of a particle along `axis` over −`plateau` (Pa): of the material, and with that by
/// contact.
fn stresses(s: &Simulation, i: usize, axis: usize, plateau: f64) -> [f64; 2] {
    let p = &s.particles;
    let own = p.deviatoric_stress[i][axis] - p.pressure[i];
    [own, own + p.contact_stress[i][axis]].map(|stress| -stress / plateau)
}

fn table(s: &mut Simulation, axis: usize, plateau: f64, layers: usize) {
    s.measure_contact_stress();
    let dx = s.case.bodies[0].lattice.spacing;
    for body in 0..2 {
        let sign = if body == 0 { 1.0 } else { -1.0 };
        let pos = |i: usize| s.particles.position[i];
        let mean: f64 = 0.0;
        let _ = mean;
        let other: f64 = {
            let o = sorted_by(s, 1 - body, |i| pos(i)[axis]);
            let m = sorted_by(s, body, |i| pos(i)[axis]);
            if pos(o[0])[axis] > pos(m[0])[axis] {
                1.0
            } else {
                -1.0
            }
        };
        let _ = sign;
        let order = sorted_by(s, body, |i| -other * pos(i)[axis]);
        let near: Vec<usize> = order
            .into_iter()
            .filter(|&i| (0..3).all(|a| a == axis || pos(i)[a].abs() < 3.0 * dx))
            .collect();
        let mut k = 0;
        let mut layer = 0;
        while layer < layers && k < near.len() {
            let x0 = pos(near[k])[axis];
            let mut sums = [0.0; 4];
            let mut n = 0.0;
            while k < near.len() && (pos(near[k])[axis] - x0).abs() < 0.3 * dx {
                let i = near[k];
                let [a, b] = stresses(s, i, axis, plateau);
                let p = &s.particles;
                let c = p.contact_stress[i];
                let lateral = if axis == 0 { c[1] } else { c[0] };
                let v = [
                    a,
                    b,
                    -lateral / plateau,
                    (p.pressure[i] - (c[0] + c[1] + c[2]) / 3.0) / plateau,
                ];
                for q in 0..4 {
                    sums[q] += v[q];
                }
                n += 1.0;
                k += 1;
            }
            let m = sums.map(|x| x / n);
            println!(
                "  body {body} layer {layer}: own {:.4} with {:.4} lateral {:.4} total p {:.4}  ({n}) x {:.4}",
                m[0],
                m[1],
                m[2],
                m[3],
                x0 / dx
            );
            layer += 1;
        }
    }
}

#[test]
fn measure_flyer() {
    for form in ["conventional", "corrected"] {
        for speed in [1.0, 7.0] {
            let case = ready(
                "flyer-plate",
                &[
                    &format!("sph.form={form}"),
                    "spacing=\"2e-5 m\"",
                    &format!("body.flyer.velocity=[\"{speed} km/s\"]"),
                    "run.end_time=\"1 us\"",
                ],
            );
            let medium = Medium::of(&case.materials[0]).unwrap();
            let exact = impact(&medium, &medium, speed * 1e3);
            let mut s = start(case);
            run_to(&mut s, 0.6 * 4e-3 / exact.target.shock_speed);
            println!("flyer {form} {speed}");
            table(&mut s, 0, exact.pressure, 10);
        }
    }
}

#[test]
fn measure_blocks() {
    for form in ["conventional", "corrected"] {
        let mut s = start(ready(
            "block-impact",
            &[&format!("sph.form={form}"), "spacing=\"0.01 cm\""],
        ));
        run_to(&mut s, 0.7e-6);
        println!("block {form}");
        table(&mut s, 1, 0.0733e11, 10);
    }
}

#[test]
fn measure_bars() {
    for form in ["conventional", "corrected"] {
        let mut s = start(ready("bar-impact", &[&format!("sph.form={form}")]));
        run_to(&mut s, 0.5e-6);
        println!(
            "bars {form} {:?}",
            s.case
                .bodies
                .iter()
                .map(|b| (b.lattice.spacing, b.smoothing_length / b.lattice.spacing))
                .collect::<Vec<_>>()
        );
        let f = physics_support::bars::interface_force(&s);
        table(&mut s, 0, f, 10);
    }
}
