//! Stress beside an interface: what contact forces carry is part of what matter bears there
//! (theory page "Contact").

use crate::physics_support::bars::interface_force;
use crate::physics_support::{inline, ready, run_to, sorted_by, start};
use comm::Comm;
use engine::step::Simulation;
use engine::step::contact_stress;
use exact::hugoniot::{Medium, impact};

/// Both forms, and how far from the plateau the layers in contact may be.
const FORMS: [&str; 2] = ["conventional", "corrected"];
const BOUND: f64 = 0.03;

/// Layers from an interface inwards.
struct Layers {
    /// Normal stress of the material over the plateau, compression positive.
    material: Vec<f64>,
    /// The same with what contact carries.
    whole: Vec<f64>,
    /// Layers that contact presses on.
    touching: usize,
}

impl Layers {
    /// The first six of `body` from its side `near` (±1) along `axis`, of particles within `aside`
    /// (m) of this axis, over a plateau (Pa).
    fn of(
        s: &mut Simulation,
        (body, axis, near): (u32, usize, f64),
        (aside, plateau): (f64, f64),
    ) -> Self {
        contact_stress::measure_in(s, &Comm::solo());
        let p = &s.particles;
        let depth = |i: usize| -near * p.position[i][axis];
        let mut order = sorted_by(s, body, depth);
        order.retain(|&i| (0..3).all(|a| a == axis || p.position[i][a].abs() < aside));
        let spacing = s.case.bodies[0].lattice.spacing;
        let face = depth(order[0]);
        let first = |i: &&usize| depth(**i) - face < 0.2 * spacing;
        let row = order.iter().take_while(first).count();
        let mean = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let rows = order.chunks(row).take(6);
            #[allow(clippy::cast_precision_loss, reason = "few particles")]
            let mean = |of: &[usize]| of.iter().map(|&i| value(i)).sum::<f64>() / of.len() as f64;
            rows.map(mean).collect()
        };
        let own = |i: usize| (p.pressure[i] - p.deviatoric_stress[i][axis]) / plateau;
        let by_contact = |i: usize| -p.contact_stress[i][axis] / plateau;
        let carried = mean(&by_contact);
        Self {
            touching: carried.iter().take_while(|&&c| c != 0.0).count(),
            material: mean(&own),
            whole: mean(&|i| own(i) + by_contact(i)),
        }
    }

    /// How far from the plateau that `plateau` is, the worst of the layers that touch is.
    fn worst(&self, name: &str, plateau: f64) -> f64 {
        let touching = self.whole[..self.touching].iter();
        let worst = touching
            .map(|w| (w / plateau - 1.0).abs())
            .fold(0.0, f64::max);
        println!(
            "{name}: material {:.3?}, with contact {:.3?}, off by {worst:.3}",
            self.material, self.whole
        );
        assert!(self.touching >= 2, "{name} does not touch");
        worst
    }
}

/// Plates of 2024 aluminium at h = 1.3 Δp. In the conventional form the outermost layers pair up
/// from 2 km/s on: their volumes m/ρ are then no longer the room that they have.
#[test]
fn plates_bear_the_plateau_up_to_the_face() {
    for (form, speed, bound) in [
        ("corrected", 0.2, BOUND),
        ("corrected", 1.0, BOUND),
        ("corrected", 2.0, BOUND),
        ("corrected", 4.0, BOUND),
        ("corrected", 7.0, BOUND),
        ("conventional", 0.2, BOUND),
        ("conventional", 1.0, BOUND),
        ("conventional", 2.0, 0.08),
        ("conventional", 4.0, 0.12),
        ("conventional", 7.0, 0.12),
    ] {
        let case = ready(
            "flyer-plate",
            &[
                &format!("sph.form={form}"),
                &format!("body.flyer.velocity=[\"{speed} km/s\"]"),
                "run.end_time=\"2 us\"",
            ],
        );
        let medium = Medium::of(&case.materials[0]).expect("Mie-Grueneisen");
        let exact = impact(&medium, &medium, 1e3 * speed);
        let mut s = start(case);
        run_to(&mut s, 0.7 * 4e-3 / exact.target.shock_speed);
        let layers = Layers::of(&mut s, (0, 0, -1.0), (1.0, exact.pressure));
        let worst = layers.worst(&format!("{form}, {speed} km/s"), 1.0);
        assert!(worst < bound, "{form}, {speed} km/s: {worst}");
    }
}

/// Blocks with shear strength in two dimensions at h = 1.2 Δp, and bars of two materials at
/// 1.25 Δp.
#[test]
fn blocks_and_bars_bear_the_plateau_up_to_the_face() {
    for form in FORMS {
        let form = format!("sph.form={form}");
        let mut s = start(ready("block-impact", &[&form, "spacing=\"0.01 cm\""]));
        run_to(&mut s, 0.7e-6);
        let layers = Layers::of(&mut s, (1, 1, -1.0), (1e-3, 0.0733e11));
        assert!(layers.worst(&format!("blocks, {form}"), 1.0) < BOUND);
        let mut s = start(ready("bar-impact", &[&form]));
        run_to(&mut s, 0.5e-6);
        let force = interface_force(&s);
        for (body, near) in [(0, 1.0), (1, -1.0)] {
            let layers = Layers::of(&mut s, (body, 0, near), (1.0, force));
            assert!(layers.worst(&format!("bar {body}, {form}"), 1.0) < BOUND);
        }
    }
}

/// A plate that runs into a rigid wall: the matter between the outermost layer and the wall bears
/// the traction too. The wall presses on that layer alone, so there is nothing to average with: 7 to
/// 9 % above the plateau.
#[test]
fn a_plate_on_a_wall_bears_the_plateau() {
    for form in FORMS {
        let mut s = start(inline(&format!(
            "dimension = 1\nspacing = \"0.02 mm\"\n[run]\nend_time = \"1 us\"\n\
             [sph]\nform = \"{form}\"\n\
             [material.aluminium]\nlibrary = \"aluminium-2024\"\nstrength = \"none\"\n\
             [[body]]\nname = \"plate\"\nmaterial = \"aluminium\"\nvelocity = [\"-100 m/s\"]\n\
             shape.box = {{ lower = [0], upper = [\"4 mm\"] }}\n\
             [[plane]]\nname = \"wall\"\nnormal = \"+x\"\n"
        )));
        let medium = Medium::of(&s.case.materials[0]).expect("Mie-Grueneisen");
        let exact = impact(&medium, &medium, 200.0);
        run_to(&mut s, 0.7 * 4e-3 / exact.target.shock_speed);
        contact_stress::measure_in(&mut s, &Comm::solo());
        let p = &s.particles;
        let first = sorted_by(&s, 0, |i| p.position[i][0])[0];
        let own = p.pressure[first] - p.deviatoric_stress[first][0];
        let whole = (own - p.contact_stress[first][0]) / exact.pressure;
        println!(
            "{form}: material {:.3}, with the wall {whole:.3}",
            own / exact.pressure
        );
        assert!((whole - 1.0).abs() < 0.1, "{form}: {whole}");
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
            let (p, carried) = (&s.particles, contact_stress::carried_in(&s));
            assert_eq!(carried.len(), 4);
            for body in 0..2 {
                let (mut borne, mut pushed, mut size) = (0.0, 0.0, 0.0);
                for of in carried.iter().filter(|of| p.body[of.particle] == body) {
                    let i = of.particle;
                    let (x, mass) = (p.position[i][0], p.mass[i]);
                    let [by_stress, by_contact] =
                        [p.acceleration[i][0], p.contact_acceleration[i][0]];
                    borne -= mass / p.density[i] * of.stress[0];
                    pushed += x * mass * (by_stress + by_contact);
                    size += (x * mass * by_contact).abs();
                }
                let off = (borne - pushed) / size;
                println!("{form} {contact}: {borne:.6e} J, {off:.1e}");
                assert!(off.abs() < 1e-12);
            }
        }
    }
}
