//! `penalty` contact in whole steps: bodies in touch, sliding, impact; and the figures that it is
//! compared by.

use crate::physics_support::{inline, ready, run_to, run_with, start};

/// The boundary of a block: its faces with their normals, its edges as corners, nothing inside.
/// Laid on another body, its faces are free of force.
#[test]
fn boundaries_have_normals() {
    for dimension in [2, 3] {
        let list = |x: &str| vec![x; dimension].join(", ");
        let up = ["y", "z"][dimension - 2];
        let s = start(inline(&format!(
            r#"
dimension = {dimension}
spacing = "1 mm"
run.end_time = "1 s"
contact.mode = "penalty"
material.a.library = "copper"
[[body]]
name = "below"
material = "a"
shape.box = {{ lower = [{}], upper = [{}] }}
lattice = "cubic"
[[body]]
name = "above"
material = "a"
shape.box = {{ size = [{}] }}
lattice = "cubic"
touch = {{ body = "below", direction = "-{up}" }}
"#,
            list("\"-10 mm\""),
            list("\"10 mm\""),
            list("\"8 mm\""),
        )));
        let top = dimension - 1;
        let (mut faces, mut corners) = (0, 0);
        let places = |body: u32| -> Vec<f64> {
            let rows = s.particles.body.iter().zip(&s.particles.position);
            rows.filter(|(b, _)| **b == body)
                .map(|(_, x)| x[top])
                .collect()
        };
        let lowest = places(1).into_iter().fold(1.0, f64::min);
        let highest = places(0).into_iter().fold(-1.0, f64::max);
        assert!((lowest - highest - 1e-3).abs() < 1e-12);
        for i in 0..s.particles.owned() {
            let (x, n) = (s.particles.position[i], s.particles.boundary_normal[i]);
            let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
            if s.particles.body[i] == 1 && (x[top] - lowest).abs() < 1e-6 {
                let edge = (0..top).any(|a| x[a].abs() > 3.2e-3);
                assert!(length > 0.0);
                if edge {
                    corners += 1;
                } else if (0..top).all(|a| x[a].abs() < 1e-3) {
                    faces += 1;
                    assert!((n[top] / length + 1.0).abs() < 1e-9, "{n:?}");
                }
            } else if s.particles.body[i] == 1
                && (x[top] - lowest - 1e-3).abs() < 1e-6
                && (0..top).all(|a| x[a].abs() < 1.1e-3)
            {
                assert_eq!(length, 0.0, "second layer: {n:?}");
            }
        }
        assert!(faces > 0 && corners > 0);
        // Normals lean near edges, so that there is some force there; in the middle of the faces
        // none.
        let modulus = s.case.materials[0].p_wave_modulus();
        let (mut middle, mut rim) = (0.0_f64, 0.0_f64);
        for i in 0..s.particles.owned() {
            let density = s.particles.density[i];
            let x = s.particles.position[i];
            let inside = (0..top).all(|a| x[a].abs() < 1.1e-3);
            let largest = if inside { &mut middle } else { &mut rim };
            for a in s.particles.contact_acceleration[i] {
                *largest = largest.max((density * 1e-3 * a / modulus).abs());
            }
        }
        println!(
            "{dimension}-D: pressure at the start {middle:.1e} M inside, {rim:.1e} M at edges"
        );
        assert!(middle < 1e-12, "{middle:e}");
        assert!(rim < 0.05, "{rim:e}");
    }
}

/// Two blocks collide by either law: momentum to round-off; the energy of `hertz` is that of a
/// function of places but for the turning of normals, `pinball` loses some.
#[test]
fn blocks_collide_and_part() {
    for (law, most) in [("hertz", 0.02), ("pinball", 1.0)] {
        let overrides = [
            "contact.mode=penalty".to_owned(),
            format!("contact.penalty.law={law}"),
        ];
        let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
        let mut s = start(ready("block-impact", &overrides));
        run_to(&mut s, 2e-6);
        let worst = &s.state.worst;
        println!("{law}: {worst:?}");
        println!("force {:?}", s.state.pairs[0].force);
        assert!(worst.momentum_error.iter().all(|&e| e < 1e-12));
        assert!(worst.contact_defect < most, "{:e}", worst.contact_defect);
        assert!(worst.closest.is_some_and(|c| c > 0.28));
        // The case ends at 2 µs, when but the edges touch: a hundredth of the impact's force.
        let force = s.state.pairs[0].force[1];
        assert!(force.abs() < 1e-2 * 7.33e9 * 1e-2, "{force}");
    }
}

/// The figures by which contact is compared: a block that slides, and a coarse quarter impact.
#[test]
#[ignore = "slow: make validation"]
fn validation_sliding_and_impact() {
    for law in ["hertz", "pinball"] {
        let law_is = format!("contact.penalty.law={law}");
        for angle in [0.0, 30.0] {
            let lattice = format!("body.block.lattice={{kind=\"cubic\",angle=\"{angle} deg\"}}");
            let mut s = start(ready(
                "sliding-block",
                &[
                    "contact.mode=penalty",
                    &law_is,
                    &lattice,
                    "run.end_time=\"0.5 ms\"",
                ],
            ));
            let (mut samples, mut along, mut normal, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
            run_with(&mut s, 0.5e-3, |s| {
                if s.state.time > 0.3e-3 {
                    let [x, y, z] = s.state.pairs[0].force;
                    samples += 1.0;
                    along += x;
                    normal -= z;
                    largest = largest.max(x.hypot(y));
                }
            });
            println!(
                "{law} {angle}: friction mean {:+.4}, largest {:.4}, pressure {:.2e} M, closest \
                 {:?}, defect {:.1e}, {} steps, {} limited by contact",
                along / normal,
                largest * samples / normal,
                normal / (samples * 1e-4 * s.case.materials[0].p_wave_modulus()),
                s.state.worst.closest,
                s.state.worst.contact_defect,
                s.state.step,
                s.state.worst.contact_limited_steps,
            );
            assert!(normal > 0.0);
        }
        let mut s = start(ready(
            "quarter-impact",
            &[
                "contact.mode=penalty",
                &law_is,
                "spacing=\"0.05 mm\"",
                "run.end_time=\"0.1 us\"",
            ],
        ));
        run_to(&mut s, 0.1e-6);
        println!("{law} quarter: {} steps, {:?}", s.state.step, s.state.worst);
        assert!(s.is_finished());
        let worst = &s.state.worst;
        assert!(worst.momentum_error.iter().all(|&e| e < 1e-12));
    }
}
