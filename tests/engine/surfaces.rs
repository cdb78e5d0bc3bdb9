//! Rigid surfaces in whole steps: a mesh acts as the plane that it is, corners hold what falls into
//! them, and what moving and turning surfaces put in is booked.

use crate::physics_support::{inline, run_to, run_with, start};
use engine::step::Simulation;

/// A soft elastic block that falls, and what it falls on.
fn fall(velocity: &str, surfaces: &str) -> Simulation {
    start(inline(&format!(
        r#"
dimension = 3
spacing = "1 mm"
time_step.courant = 0.2
sph.alpha = 0.1
sph.beta = 0.2
run.end_time = "1 s"
[material.soft]
density = "1000 kg/m^3"
eos.linear.bulk_modulus = "10 MPa"
strength.elastic.shear_modulus = "3 MPa"
[[body]]
name = "block"
material = "soft"
shape.box = {{ lower = ["1 mm", "1 mm", "1 mm"], upper = ["6 mm", "7 mm", "8 mm"] }}
lattice = "cubic"
velocity = {velocity}
{surfaces}
"#
    )))
}

/// The die of the punch case, 10 × 10 × 12 mm, with its lower corner at the origin.
const ROOM: &str = r#"
[[surface]]
name = "room"
side = "inside"
shape.stl = { file = "inputs/punch/die.stl", unit = "1 mm", at = ["5 mm", "5 mm", 0] }
"#;

/// A floor of triangles is a plane, also over their seam, and also upside down from within.
#[test]
fn a_face_is_a_plane() {
    let down = "[0, 0, \"-1 m/s\"]";
    let plane = "[[plane]]\nnormal = \"+z\"\n";
    let plug = "[[surface]]\nshape.stl = { file = \"inputs/punch/punch.stl\", unit = \"2 mm\", \
                at = [0, 0, \"-1 cm\"] }\n";
    let ball =
        "[[surface]]\nshape.sphere = { radius = \"1000 km\", centre = [0, 0, \"-1000 km\"] }\n";
    let mut runs = [plane, plug, ROOM, ball].map(|floor| fall(down, floor));
    for s in &mut runs {
        run_to(s, 2.5e-3);
        assert!(s.state.loads[0].impulse[2] > 1e-4);
    }
    let [plane, others @ ..] = &runs;
    for other in others {
        let away = (0..plane.particles.owned())
            .map(|i| {
                let k = other
                    .particles
                    .id
                    .iter()
                    .position(|id| *id == plane.particles.id[i]);
                let y = other.particles.position[k.expect("the same particles")];
                let x = plane.particles.position[i];
                (0..3).map(|a| (x[a] - y[a]).abs()).fold(0.0, f64::max)
            })
            .fold(0.0, f64::max);
        println!("{}: {away:e} m", other.case.loads.surfaces[0].name);
        // Gaps from the ball's surface round to .1 nm, which the bounce passes on.
        let close = if other.case.loads.surfaces[0].one_foot() {
            1e-8
        } else {
            1e-12
        };
        assert!(away < close, "{away:e}");
    }
}

/// A block thrown into the corner of a closed room, and of a can with curved walls: it stays inside
/// and bounces back, energy is kept to the order of the scheme and momentum to round-off.
#[test]
fn corners_hold_what_falls_into_them() {
    let can = "[[surface]]\nside = \"inside\"\nshape.cylinder = { radius = \"6.2 mm\", \
               length = \"1 cm\", centre = [\"3.5 mm\", \"4 mm\", \"5 mm\"] }\n";
    for walls in [ROOM, can] {
        let mut s = fall("[\"-0.7 m/s\", \"-0.6 m/s\", \"-0.8 m/s\"]", walls);
        let initial = s.state.initial.kinetic_energy;
        run_to(&mut s, 8e-3);
        let worst = &s.state.worst;
        println!("{worst:?}");
        let rest = s.state.totals.kinetic_energy / initial;
        println!(
            "kinetic energy {rest}, impulse {:?}",
            s.state.loads[0].impulse
        );
        assert!(worst.momentum_error.iter().all(|&e| e < 1e-12));
        assert!(worst.energy_error < 0.01, "{:e}", worst.energy_error);
        assert!(s.state.loads[0].impulse.iter().all(|&j| j > 0.0));
        assert_eq!(s.state.loads[0].work, 0.0);
        let surface = &s.case.loads.surfaces[0];
        let deepest = s.particles.position.iter().map(|x| surface.gap(x, 1e-3));
        assert!(deepest.fold(1.0, f64::min) > 0.0);
        assert!(rest > 0.3);
    }
}

/// A paddle that turns hits the block: what it puts in is what the block has got, torque and all.
#[test]
fn the_work_of_a_turning_surface() {
    let paddle = r#"
[[surface]]
name = "paddle"
shape.stl = { file = "tests/common/hook.stl", unit = "1 mm", at = ["2 mm", "4 mm", "13 mm"] }
motion.z = "-0.5 m/s"
rotation = { axis = "x", point = [0, "8 mm", "12 mm"], times = [0, "3 ms"], rate = ["300 rad/s", 0] }
"#;
    for courant in ["0.2", "0.1"] {
        let mut s = fall("[0, 0, 0]", &format!("{paddle}\n"));
        s.case.time_step.courant = courant.parse().expect("a number");
        let mut twist = 0.0_f64;
        run_with(&mut s, 6e-3, |s| {
            twist = twist.max(s.state.loads[0].torque.abs());
        });
        let (worst, load) = (&s.state.worst, &s.state.loads[0]);
        println!("courant {courant}: {load:?} {worst:?}");
        assert!(twist > 0.0 && load.work > 0.0);
        assert!(worst.momentum_error.iter().all(|&e| e < 1e-12));
        assert!(worst.energy_error < 0.02, "{:e}", worst.energy_error);
        let gained = s.state.totals.energy() - s.state.initial.energy();
        assert!((gained / load.work - 1.0).abs() < 0.02);
    }
}
