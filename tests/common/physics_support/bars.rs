//! The elastic bars of the paper's sections 3.1 and 3.2.

use engine::step::Simulation;
use model::{Case, Shape};

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

/// Stress ρ c v behind it (Pa).
pub const PLATEAU: f64 = 0.004_584_9e11;

/// A steel bar of 100 particles, 1 cm apart, that runs into a plane at 10 m/s: the step wave of
/// section 3.1 in the frame of the undisturbed bar.
pub fn step_bar(smoothing: f64) -> Case {
    inline(&format!(
        "dimension = 1\nspacing = \"1 cm\"\n[sph]\nsmoothing = {smoothing}\n\
         [run]\nend_time = \"200 us\"\n[[symmetry]]\naxis = \"x\"\n{BAR_MATERIALS}\n\
         [[body]]\nname = \"bar\"\nmaterial = \"steel\"\nvelocity = [\"-{STEP} m/s\"]\n\
         shape.box = {{ lower = [0], upper = [\"100 cm\"] }}\n"
    ))
}

/// Velocities along a [`step_bar`] in the frame of its undisturbed part (m/s).
pub fn bar_velocities(s: &Simulation) -> Vec<f64> {
    let all = in_order(s).into_iter();
    all.map(|i| s.particles.velocity[i][0] + STEP).collect()
}

/// The first bar of a case made as long as all together, and alone.
pub fn in_one_piece(mut case: Case) -> Case {
    let Some(Shape::Box { upper: end, .. }) = case.bodies.last().map(|bar| bar.shape.clone())
    else {
        panic!("a bar is a box");
    };
    case.bodies.truncate(1);
    case.bodies[0].filled = None;
    if let Shape::Box { upper, .. } = &mut case.bodies[0].shape {
        *upper = end;
    }
    case
}

/// All particles from left to right.
pub fn in_order(s: &Simulation) -> Vec<usize> {
    let mut all: Vec<usize> = (0..s.particles.owned()).collect();
    all.sort_by(|&a, &b| s.particles.position[a][0].total_cmp(&s.particles.position[b][0]));
    all
}

/// Stress of a particle along the bar (Pa), tension positive.
pub fn axial_stress(s: &Simulation, i: usize) -> f64 {
    s.particles.deviatoric_stress[i][0] - s.particles.pressure[i]
}

/// Force (Pa, positive to the right) that the particles up to the `first`-th from the left exert
/// on all others in the SPH sums: what accelerates these.
pub fn force_on_right(s: &Simulation, first: usize) -> f64 {
    let right = in_order(s).split_off(first);
    let force = |&i: &usize| s.particles.mass[i] * s.particles.acceleration[i][0];
    right.iter().map(force).sum()
}

/// Force of the second bar on the first, compression positive (Pa), from the pair ledger.
pub fn interface_force(s: &Simulation) -> f64 {
    s.state.pairs.first().map_or(0.0, |pair| -pair.force[0])
}
