//! Blocks of rock between smooth platens: the stress at which they flow is that of the closed form.

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
