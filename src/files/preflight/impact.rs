//! Checks that an impact is within the range of its materials' equations of state, and that they can fail
//! where it would tear them.

use std::collections::HashMap;

use super::approach::Approach;
use exact::hugoniot::{meeting, shock};
use material::{Coupling, Eos, Material, Strength};
use model::readable::shown;
use model::{Body, Case, Shape, SphForm, Vec3};

/// A linear equation of state misses the stiffening of compressed material, by a tenth of the
/// pressure and more once the strain `u/c` of the shock is a tenth or so.
const LINEAR: f64 = 0.1;
/// Tait's law is valid to some 2.5 `GPa` for water (Cole 1948, *Underwater Explosions*, section
/// 2.3), which a shock of `u/c = 0.6` reaches.
const TAIT: f64 = 0.6;
/// Material shocked to `u = c₀` has gained `c₀²/2`, about the binding energy of a metal (aluminium: 14
/// of 12 MJ/kg), and a Mie–Grüneisen solid cannot boil.
const MIE_GRUNEISEN: f64 = 1.0;

/// Shocks (Pa) above which a material should be able to fail: twice the strength of the strongest metals in
/// plane impacts, .3 to 5 `GPa` (Meyers 1994, *Dynamic Behavior of Materials*, chapter 16).
const BORNE: f64 = 10e9;

/// Speed over the bulk sound speed below which a blunt nose shears a plug out of a plate (steel: some 900 m/s).
const PLUGS: f64 = 0.2;

/// Share of the yield stress from which on the stress of artificial viscosity counts.
const COUNTS: f64 = 0.25;

/// Impacts beyond the range of an equation of state, and those whose release would tear a material that
/// cannot fail.
pub fn warnings(case: &Case, approaches: &[Approach], messages: &mut Vec<String>) {
    let mut warned = vec![false; case.materials.len()];
    let mut torn = vec![false; case.materials.len()];
    let mut braked = vec![false; case.materials.len()];
    let mut plugs = vec![false; case.materials.len()];
    let meetings = approaches.iter().filter(|pair| pair.time.is_finite());
    let mut known = HashMap::new();
    for Shock {
        pair,
        closing,
        velocity,
        pressure,
    } in meetings.flat_map(|pair| shocks(case, pair, &mut known))
    {
        let [body, partner] = pair;
        let index = body.material;
        let material = &case.materials[index];
        let meeting = format!(
            "`{}` meets `{}` at {}",
            body.name,
            partner.name,
            shown(closing, "m/s")
        );
        // The equation of state is that of the solid between pores.
        let solid = material
            .porosity
            .as_ref()
            .map(|pores| pores.solid.sound_speed());
        let ratio = velocity / solid.unwrap_or_else(|| sound_speed(material));
        if let Some(what) = beyond(&material.eos, ratio).filter(|_| !warned[index]) {
            warned[index] = true;
            messages.push(format!(
                "{meeting}, which drives `{}` to {ratio:.2} of its sound speed: {what}",
                material.name
            ));
        }
        if let Some(stress) = viscous_stress(case, body, velocity).filter(|_| !braked[index]) {
            braked[index] = true;
            messages.push(format!(
                "{meeting}: artificial viscosity resists its flow by some {}, and `{}` yields at {}; \
                 `sph.form = \"corrected\"` limits it, less `sph.alpha` or a finer spacing lowers it",
                shown(stress, "Pa"),
                material.name,
                shown(material.strength.yield_stress(), "Pa")
            ));
        }
        if punches(case, pair, closing) && keeps_its_strength(material) && !plugs[index] {
            plugs[index] = true;
            messages.push(format!(
                "{meeting} with a blunt nose, and `{}` keeps all of its strength until it has failed: no plug \
                 shears out of it as soon as it should; give it `failure.johnson_cook.coupling = \"localised\"` \
                 and a `failure.fracture_energy`",
                material.name
            ));
        }
        if case.dimension > 1 && holds_together(material) && pressure > BORNE && !torn[index] {
            torn[index] = true;
            messages.push(format!(
                "{meeting}, and `{}` cannot fail: what the release of a shock of {:.0} GPa would \
                 tear hangs together under as much tension; give it `failure`, as \
                 `failure.spall.pressure`",
                material.name,
                1e-9 * pressure
            ));
        }
    }
}

/// The shock in one of two bodies that meet.
struct Shock<'a> {
    /// This body and the other.
    pair: [&'a Body; 2],
    /// Speed at which they meet (m/s).
    closing: f64,
    /// Velocity (m/s) and pressure (Pa) behind the shock, by both Hugoniots.
    velocity: f64,
    pressure: f64,
}

/// Velocities (m/s) and pressures (Pa) behind shocks, by materials, whether the other body is rigid, and closing speed.
type Known = HashMap<([usize; 2], bool, u64), [f64; 2]>;

/// The shocks in those of two bodies that deform.
fn shocks<'a>(case: &'a Case, approach: &Approach, known: &mut Known) -> Vec<Shock<'a>> {
    let [a, b] = approach.bodies.map(|body| &case.bodies[body]);
    let closing = approach.speed;
    let deforming = [[a, b], [b, a]].into_iter();
    let deforming = deforming.filter(|[body, _]| body.rigid.is_none());
    let shock_in = |pair: [&'a Body; 2]| {
        let (indices, rigid) = (pair.map(|body| body.material), pair[1].rigid.is_some());
        let behind = || {
            let materials = indices.map(|material| &case.materials[material]);
            let behind = if rigid {
                shock(materials[0], closing)
            } else {
                let [behind, _] = meeting(materials, closing);
                behind
            };
            [behind.particle_velocity, behind.pressure]
        };
        let key = (indices, rigid, closing.to_bits());
        let [velocity, pressure] = *known.entry(key).or_insert_with(behind);
        Shock {
            pair,
            closing,
            velocity,
            pressure,
        }
    };
    deforming.map(shock_in).collect()
}

/// Stress (Pa) of the linear viscosity in a body that flows over its thickness at a velocity (m/s), `½ α
/// (h/Δp) ρ c u/N` (theory page "Smoothed particle hydrodynamics"), where nothing limits it and it counts beside the
/// yield stress.
fn viscous_stress(case: &Case, body: &Body, velocity: f64) -> Option<f64> {
    let material = &case.materials[body.material];
    // What friction holds follows the pressure.
    let by_pressure = material.strength.keeps_friction();
    if case.dimension == 1 || case.sph.form == SphForm::Corrected || by_pressure {
        return None;
    }
    let across = super::case::thickness(body, case) / body.lattice.spacing;
    let smoothing = body.smoothing_length / body.lattice.spacing;
    let stress = 0.5 * case.sph.alpha * smoothing * impedance(material) * velocity / across;
    (stress > COUNTS * material.strength.yield_stress()).then_some(stress)
}

/// Returns true where the second body meets the first, a plate no thicker than it is wide, with a flat end and
/// slowly.
fn punches(case: &Case, [plate, striker]: [&Body; 2], closing: f64) -> bool {
    let way = striker.velocity - plate.velocity;
    let axis = way.iamax();
    let straight = way[axis].abs() > 0.9 * closing;
    let slow = closing < PLUGS * sound_speed(&case.materials[plate.material]);
    let (Some(plate), Some(striker)) = (extent(&plate.shape, axis), extent(&striker.shape, axis))
    else {
        return false;
    };
    let across = |extent: Vec3| extent[(axis + 1) % 3].min(extent[(axis + 2) % 3]);
    case.dimension == 3
        && straight
        && slow
        && plate[axis] <= across(striker)
        && across(plate) > 1.5 * across(striker)
}

/// Edges (m) of the box about a body with flat ends along an axis; `None` for any other.
fn extent(shape: &Shape, along: usize) -> Option<Vec3> {
    match shape {
        Shape::Box { lower, upper } => Some(upper - lower),
        Shape::Cylinder {
            axis,
            radius,
            length,
            ..
        } if axis.index() == along => {
            let mut edges = Vec3::repeat(2.0 * radius);
            edges[along] = *length;
            Some(edges)
        }
        _ => None,
    }
}

/// Returns true for a material that fails by plastic flow, which takes nothing of its strength before.
fn keeps_its_strength(material: &Material) -> bool {
    let failure = &material.failure;
    let coupled = |law: &material::JohnsonCookFailure| law.coupling != Coupling::Uncoupled;
    let fails = failure.johnson_cook.is_some() || failure.plastic_strain.is_some();
    fails && !failure.johnson_cook.as_ref().is_some_and(coupled)
}

/// Returns true for a solid that bears any tension.
fn holds_together(material: &Material) -> bool {
    material.failure.is_none()
        && !material.strength.bounds_tension()
        && !matches!(material.strength, Strength::None | Strength::Viscous(_))
}

/// A warning if a ratio of particle velocity to sound speed is beyond an equation of state.
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
    (material.bulk_modulus() / material.reference_density).sqrt()
}

fn impedance(material: &Material) -> f64 {
    material.reference_density * sound_speed(material)
}
