//! Blocks of rock between smooth platens: the stress at which they flow is that of the closed form. A column of sand.

use crate::physics_support::{inline, run_with, start};

/// Mean axial stress (Pa, compression positive) of the middle of a block of 20 mm between platens that close at 200 /s,
/// between two times (us).
fn bears(dimension: usize, strength: &str, [from, to]: [f64; 2]) -> f64 {
    let (lower, upper, velocity) = if dimension == 2 {
        (
            "\"-10 mm\", \"-5 mm\"",
            "\"10 mm\", \"5 mm\"",
            "\"-200/s * x\", \"100/s * y\"",
        )
    } else {
        (
            "\"-10 mm\", \"-5 mm\", \"-5 mm\"",
            "\"10 mm\", \"5 mm\", \"5 mm\"",
            "\"-200/s * x\", \"70/s * y\", \"70/s * z\"",
        )
    };
    let mut s = start(inline(&format!(
        "dimension = {dimension}\nspacing = \"0.5 mm\"\n[run]\nend_time = \"{to} us\"\n\
         [sph]\nform = \"corrected\"\n\
         [material.rock]\ndensity = \"2500 kg/m^3\"\n\
         eos.linear = {{ bulk_modulus = \"30 GPa\", form = \"logarithmic\" }}\n\
         strength.{strength}\n\
         [[body]]\nname = \"block\"\nmaterial = \"rock\"\n\
         shape.box = {{ lower = [{lower}], upper = [{upper}] }}\nvelocity = [{velocity}]\n\
         [[load]]\nname = \"left\"\nbody = \"block\"\nbelow = {{ x = \"-9.5 mm\" }}\n\
         velocity = {{ x = \"1.95 m/s\" }}\n\
         [[load]]\nname = \"right\"\nbody = \"block\"\nabove = {{ x = \"9.5 mm\" }}\n\
         velocity = {{ x = \"-1.95 m/s\" }}\n"
    )));
    let (mut sum, mut count) = (0.0, 0.0);
    run_with(&mut s, 1.0, |s| {
        if s.state.time < from * 1e-6 {
            return;
        }
        for i in 0..s.particles.owned() {
            if s.particles.position[i][0].abs() < 5e-3 {
                sum += s.particles.pressure[i] - s.particles.deviatoric_stress[i][0];
                count += 1.0;
            }
        }
    });
    sum / count
}

const CONE: &str =
    "drucker_prager = { shear_modulus = \"10 GPa\", cohesion = \"10 MPa\", friction = 0.6 }";
const HEXAGON: &str = "mohr_coulomb = { shear_modulus = \"10 GPa\", cohesion = \"10 MPa\", \
    friction = 0.57735026918962576, tensile_strength = \"2 MPa\" }";

fn assert_bears(dimension: usize, strength: &str, times: [f64; 2], exact: f64) {
    let found = bears(dimension, strength, times);
    println!("{dimension}-D: {found} {exact}");
    assert!((found / exact - 1.0).abs() < 0.03, "{found} {exact}");
}

/// In plane strain the deviator across is lost as matter flows: `√J₂ = p = σ/2`. Later the block flows in bands.
#[test]
fn a_block_in_plane_strain_bears_what_its_friction_holds() {
    assert_bears(2, CONE, [14.0, 26.0], 2.0 * 10e6 / (1.0 - 0.6));
}

/// Drucker and Prager's cone: with free sides `√J₂ = q/√3` and `p = q/3`. Mohr and Coulomb: `q = 2 c cos φ/(1 − sin φ)`.
/// Free sides of particles press by a hundredth of that at twenty particles across, and less of finer ones.
#[test]
#[ignore = "slow: 16,000 particles for 800 steps, twice"]
fn a_block_bears_what_its_friction_holds() {
    let root_3 = 3.0_f64.sqrt();
    assert_bears(3, CONE, [12.0, 36.0], root_3 * 10e6 / (1.0 - 0.6 / root_3));
    assert_bears(3, HEXAGON, [12.0, 36.0], root_3 * 10e6 / 0.5);
}

/// A column of sand as high as it is wide falls to one side and comes to rest: it runs out by 1.2 of its width, and its back
/// keeps its height (Lube et al. 2005, Phys. Rev. E 72, 041301; Lajeunesse et al. 2005, Phys. Fluids 17, 103302: plane
/// channels, any sand). Their fits spread by a tenth; a particle is a twentieth of the width.
#[test]
#[ignore = "slow: .5 s of sand, some 15,000 steps"]
fn a_column_of_sand_runs_out_as_far_as_sand_does() {
    let mut s = start(inline(
        "dimension = 2\nspacing = \"5 mm\"\ngravity = [0, \"-9.81 m/s^2\"]\n\
         [run]\nend_time = \"0.5 s\"\n[material.sand]\nlibrary = \"regolith\"\n\
         [[body]]\nname = \"column\"\nmaterial = \"sand\"\n\
         shape.box = { lower = [0, 0], upper = [\"0.1 m\", \"0.1 m\"] }\n\
         [[symmetry]]\naxis = \"x\"\n\
         [[plane]]\nname = \"floor\"\nnormal = \"+y\"\nfriction = 0.577\n",
    ));
    run_with(&mut s, 1.0, |_| {});
    let (bin, mut counts, mut highest, mut energy) = (0.02, [0.0; 40], 0.0_f64, 0.0);
    for i in 0..s.particles.owned() {
        let [x, y, _] = s.particles.position[i];
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "small"
        )]
        let place = (x / bin) as usize;
        counts[place.min(39)] += 1.0;
        if place == 0 {
            highest = highest.max(y);
        }
        let v = s.particles.velocity[i];
        energy += 0.5 * (v[0] * v[0] + v[1] * v[1]) / 400.0;
    }
    // Where the deposit is as thick as a particle.
    let depths = counts.map(|n| n * 0.005 * 0.005 / bin);
    let last = depths.iter().rposition(|&depth| depth >= 0.005).unwrap();
    let share = (depths[last] - 0.005) / (depths[last] - depths[last + 1]);
    #[allow(clippy::cast_precision_loss, reason = "few")]
    let front = bin * (last as f64 + 0.5 + share);
    let runout = (front - 0.1) / 0.1;
    println!("runs out by {runout}, {highest} m high, mean v²/2 {energy}");
    assert!((runout / 1.2 - 1.0).abs() < 0.2, "{runout}");
    assert!(highest > 0.8 * 0.1, "{highest}");
    // At rest: a fiftieth of the speed of its fall.
    assert!(energy < 0.0004 * 9.81 * 0.1, "{energy}");
}

/// Rock that has failed and keeps friction bears shear, which the corrected form hands on without a torque.
#[test]
fn broken_rock_turns_by_nothing() {
    let mut s = start(inline(
        "dimension = 3\nspacing = \"1 mm\"\n[run]\nend_time = \"4 us\"\n\
         [material.rock]\nlibrary = \"granite\"\n\
         [material.al]\nlibrary = \"aluminium-6061-ductile\"\n\
         [[body]]\nname = \"target\"\nmaterial = \"rock\"\n\
         shape.cylinder = { axis = \"z\", radius = \"10 mm\", length = \"8 mm\", centre = [0, 0, \"-4 mm\"] }\n\
         [[body]]\nname = \"sphere\"\nmaterial = \"al\"\n\
         shape.sphere = { centre = [0, 0, \"3 mm\"], diameter = \"5 mm\" }\n\
         velocity = [\"1 km/s\", 0, \"-1.5 km/s\"]\ntouch = { body = \"target\", direction = \"-z\" }\n",
    ));
    run_with(&mut s, 1.0, |_| {});
    let failed = (0..s.particles.owned()).filter(|&i| s.particles.damage[i] >= 1.0);
    assert!(failed.count() > 200);
    let worst = &s.state.worst;
    println!("{:?}", worst.angular_momentum_error);
    assert!(
        worst.angular_momentum_error.iter().all(|&e| e < 1e-12),
        "{worst:?}"
    );
}
