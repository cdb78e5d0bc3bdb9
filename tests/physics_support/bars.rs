//! The elastic bars of the paper's sections 3.1 and 3.2.

use whipple::model::Case;
use whipple::step::Simulation;

use super::inline;

/// Steel and aluminium whose uniaxial strain follows `σ̇ = M D`: E = 2.1 Mbar, ν = .28,
/// ρ = 7.83 g/cm³; E = .70 Mbar, ν = .33, ρ = 2.70 g/cm³.
pub const BAR_MATERIALS: &str = r#"
[material.steel]
density = "7830 kg/m^3"
eos.linear = { bulk_modulus = "159.0909 GPa", form = "logarithmic" }
strength.elastic.shear_modulus = "82.03125 GPa"

[material.aluminium]
density = "2700 kg/m^3"
eos.linear = { bulk_modulus = "68.62745 GPa", form = "logarithmic" }
strength.elastic.shear_modulus = "26.31579 GPa"
"#;

/// √(M/ρ) of that steel (m/s).
pub const STEEL_SPEED: f64 = 5855.5;

/// Velocity of the step wave (m/s).
pub const STEP: f64 = 10.0;

/// A steel bar of 100 particles, 1 cm apart, that runs into a plane at 10 m/s, in one piece or in
/// two: the step wave of section 3.1 in the frame of the undisturbed bar.
pub fn step_bar(pieces: usize, smoothing: f64, contact: &str) -> Case {
    let piece = |name: &str, lower: u32, upper: u32| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"steel\"\nvelocity = [\"-{STEP} m/s\"]\n\
             shape.box = {{ lower = [\"{lower} cm\"], upper = [\"{upper} cm\"] }}\n"
        )
    };
    let bodies = match pieces {
        1 => piece("bar", 0, 100),
        _ => piece("left", 0, 50) + &piece("right", 50, 100),
    };
    inline(&format!(
        "dimension = 1\nspacing = \"1 cm\"\n[sph]\nsmoothing = {smoothing}\n\
         [run]\nend_time = \"200 us\"\n[contact]\nmode = \"{contact}\"\n\
         [[symmetry]]\naxis = \"x\"\n{BAR_MATERIALS}\n{bodies}"
    ))
}

/// Velocities along a [`step_bar`] in the frame of its undisturbed part (m/s).
pub fn bar_velocities(s: &Simulation) -> Vec<f64> {
    let mut all: Vec<usize> = (0..s.store.owned()).collect();
    all.sort_by(|&a, &b| s.store.position[a][0].total_cmp(&s.store.position[b][0]));
    all.iter().map(|&i| s.store.velocity[i][0] + STEP).collect()
}
