//! Stress beside an interface: what contact forces carry is part of what matter bears there.

mod physics_support;

use physics_support::bars::interface_force;
use physics_support::{inline, ready, run_to, sorted_by, start};
use whipple::comm::Comm;
use whipple::exact::hugoniot::{Medium, impact};
use whipple::step::Simulation;

const FORMS: [&str; 2] = ["conventional", "corrected"];

/// Normal stress along `axis` of a particle (Pa, compression positive): of the material, and with
/// that by contact.
fn pressing(s: &Simulation, i: usize, axis: usize) -> [f64; 2] {
    let p = &s.particles;
    let own = p.pressure[i] - p.deviatoric_stress[i][axis];
    [own, own - p.contact_stress[i][axis]]
}

/// Means of [`pressing`] over the particles of a body in its first layers from its `near` side,
/// within `aside` (m) of the axis.
fn layers<const N: usize>(
    s: &mut Simulation,
    (body, axis, near): (u32, usize, f64),
    aside: f64,
) -> [[f64; 2]; N] {
    s.measure_contact_stress(&Comm::solo());
    let x = |i: usize| s.particles.position[i];
    let mut order = sorted_by(s, body, |i| -near * x(i)[axis]);
    order.retain(|&i| (0..3).all(|a| a == axis || x(i)[a].abs() < aside));
    let row = order.len().min(
        order
            .iter()
            .filter(|&&i| {
                (x(i)[axis] - x(order[0])[axis]).abs() < 0.2 * s.case.bodies[0].lattice.spacing
            })
            .count(),
    );
    #[allow(clippy::cast_precision_loss, reason = "few particles")]
    let mean = |k: usize, which: usize| {
        let of = &order[k * row..(k + 1) * row];
        of.iter().map(|&i| pressing(s, i, axis)[which]).sum::<f64>() / row as f64
    };
    std::array::from_fn(|k| [mean(k, 0), mean(k, 1)])
}

fn show<const N: usize>(name: &str, layers: &[[f64; 2]; N], plateau: f64) {
    let over = |which: usize| layers.map(|layer| layer[which] / plateau);
    println!(
        "{name}: material {:.3?}, with contact {:.3?}",
        over(0),
        over(1)
    );
}

#[test]
fn measure_flyer() {
    for form in ["conventional", "corrected", "normalised"] {
        for speed in [0.2, 1.0, 2.0, 4.0, 7.0] {
            let case = ready(
                "flyer-plate",
                &[
                    &format!("sph.form={form}"),
                    "spacing=\"2e-5 m\"",
                    &format!("body.flyer.velocity=[\"{speed} km/s\"]"),
                    "run.end_time=\"2 us\"",
                ],
            );
            let medium = Medium::of(&case.materials[0]).unwrap();
            let exact = impact(&medium, &medium, speed * 1e3);
            let mut s = start(case);
            let arrival = 4e-3 / exact.target.shock_speed;
            for part in [0.4, 0.6, 0.8] {
                run_to(&mut s, part * arrival);
                show(
                    &format!("flyer {form} {speed}"),
                    &layers::<6>(&mut s, (0, 0, -1.0), 1.0),
                    exact.pressure,
                );
            }
        }
    }
}

#[test]
fn measure_blocks() {
    for form in ["conventional", "corrected", "normalised"] {
        for spacing in ["0.02", "0.01"] {
            let mut s = start(ready(
                "block-impact",
                &[
                    &format!("sph.form={form}"),
                    &format!("spacing=\"{spacing} cm\""),
                ],
            ));
            for time in [0.6e-6, 0.7e-6, 0.8e-6] {
                run_to(&mut s, time);
                show(
                    &format!("block {form} {spacing}"),
                    &layers::<6>(&mut s, (1, 1, -1.0), 1e-3),
                    0.0733e11,
                );
            }
        }
    }
}

#[test]
fn measure_bars() {
    for form in ["conventional", "corrected", "normalised"] {
        let mut s = start(ready("bar-impact", &[&format!("sph.form={form}")]));
        run_to(&mut s, 0.5e-6);
        let f = interface_force(&s);
        show(
            &format!("bars {form}"),
            &layers::<6>(&mut s, (0, 0, 1.0), 1.0),
            f,
        );
        show(
            &format!("bars {form}"),
            &layers::<6>(&mut s, (1, 0, -1.0), 1.0),
            f,
        );
    }
}

/// Two bodies of two particles each, all of which touch: what they bear, summed over a body, is
/// what accelerates its matter times its distance from the face, to rounding.
#[test]
fn what_a_body_bears_is_the_traction_on_it() {
    for form in FORMS {
        for contact in ["overlap", "potential"] {
            let mut s = start(inline(&format!(
                "dimension = 1\nspacing = \"1 mm\"\n[run]\nend_time = \"1 us\"\n\
                 [sph]\nform = \"{form}\"\nalpha = 0\nbeta = 0\n[contact]\nmode = \"{contact}\"\n\
                 [material.steel]\nlibrary = \"steel-bar\"\n\
                 [[body]]\nname = \"left\"\nmaterial = \"steel\"\nvelocity = [\"50 m/s\"]\n\
                 shape.box = {{ lower = [\"-2 mm\"], upper = [0] }}\n\
                 [[body]]\nname = \"right\"\nmaterial = \"steel\"\nvelocity = [\"-50 m/s\"]\n\
                 shape.box = {{ lower = [0], upper = [\"2 mm\"] }}\n"
            )));
            run_to(&mut s, 0.1e-6);
            let (p, carried) = (&s.particles, s.carried_in_contact());
            assert!(carried.iter().all(|of| of.normal.is_some()));
            for body in 0..2 {
                let (mut borne, mut pushed, mut size) = (0.0, 0.0, 0.0);
                for i in (0..p.owned()).filter(|&i| p.body[i] == body) {
                    let (x, mass) = (p.position[i][0], p.mass[i]);
                    let [by_stress, by_contact] =
                        [p.acceleration[i][0], p.contact_acceleration[i][0]];
                    borne -= mass / p.density[i] * carried[i].stress[0];
                    pushed += x * mass * (by_stress + by_contact);
                    size += (x * mass * by_contact).abs();
                }
                println!(
                    "{form} {contact}: {borne:.6e} J, {:.1e}",
                    (borne - pushed) / size
                );
                assert!((borne - pushed).abs() < 1e-12 * size);
            }
        }
    }
}
