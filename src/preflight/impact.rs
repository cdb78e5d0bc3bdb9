//! Whether an impact is within what the equations of state of its materials stand for.

use super::approach::Approach;
use crate::material::{Eos, Material};
use crate::model::Case;
use crate::model::readable::shown;

/// A linear equation of state misses the stiffening of compressed matter, by a tenth of the
/// pressure and more once the strain `u/c` of the shock is a tenth or so.
const LINEAR: f64 = 0.1;
/// Tait's law is right to some 2.5 `GPa` for water (Cole 1948, *Underwater Explosions*, section
/// 2.3), which a shock of `u/c = 0.6` reaches.
const TAIT: f64 = 0.6;
/// Matter shocked to `u = c₀` has gained `c₀²/2`, about what binds a metal (aluminium: 14 of
/// 12 MJ/kg), and a Mie–Grüneisen solid cannot boil.
const MIE_GRUNEISEN: f64 = 1.0;

/// Impacts beyond the range of an equation of state. The velocity behind the shock is that by
/// acoustic impedances, `u_a = v Z_b/(Z_a + Z_b)`.
pub fn warnings(case: &Case, approaches: &[Approach], found: &mut Vec<String>) {
    let mut told = vec![false; case.materials.len()];
    for pair in approaches.iter().filter(|pair| pair.time.is_finite()) {
        let materials = pair.bodies.map(|body| case.bodies[body].material);
        for (own, other) in [(0, 1), (1, 0)] {
            let index = materials[own];
            let body = &case.bodies[pair.bodies[own]];
            if body.rigid.is_some() || told[index] {
                continue;
            }
            let partner = &case.bodies[pair.bodies[other]];
            let material = &case.materials[index];
            let share = if partner.rigid.is_some() {
                1.0
            } else {
                let (z, z_other) = (
                    impedance(material),
                    impedance(&case.materials[materials[other]]),
                );
                z_other / (z + z_other)
            };
            let ratio = pair.speed * share / sound_speed(material);
            if let Some(what) = beyond(&material.eos, ratio) {
                told[index] = true;
                found.push(format!(
                    "`{}` meets `{}` at {}, which drives `{}` to {ratio:.2} of its sound \
                     speed: {what}",
                    body.name,
                    partner.name,
                    shown(pair.speed, "m/s"),
                    material.name
                ));
            }
        }
    }
}

/// What is wrong at a ratio of particle velocity to sound speed, if anything is.
fn beyond(eos: &Eos, ratio: f64) -> Option<&'static str> {
    match eos {
        Eos::Linear(_) if ratio > LINEAR => Some(
            "`eos.linear` knows no shocks; take `mie_gruneisen`, or a library material that has it",
        ),
        Eos::Tait(_) if ratio > TAIT => {
            Some("`eos.tait` stands for liquids below some 0.6; take `mie_gruneisen`")
        }
        Eos::MieGruneisen(_) if ratio > MIE_GRUNEISEN => Some(
            "its shock heats it enough to vaporise, which `eos.mie_gruneisen` does not know; take \
             `tillotson`",
        ),
        _ => None,
    }
}

fn sound_speed(material: &Material) -> f64 {
    let rho = material.reference_density;
    (material.eos.bulk_modulus(rho) / rho).sqrt()
}

fn impedance(material: &Material) -> f64 {
    material.reference_density * sound_speed(material)
}
