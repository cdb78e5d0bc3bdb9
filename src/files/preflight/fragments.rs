//! What a sphere that a bumper breaks leaves in one piece, beside the particles that it has.

use std::fmt::Write;

use super::approach::Approach;
use model::{Body, Case, Shape};

/// Rate of the sphere's lateral flow as it breaks, over its speed and diameter: .3 to .46 from the tenth to the six tenths
/// of its particles that fail (2024, .25 diameters of 6061, 3.0 and 4.4 km/s).
const RATE: f64 = 0.4;
/// Particles across a fragment by which a rear wall is struck as by the fragment: six are too few, eight are enough
/// (theory page "Failure").
const ACROSS_FRAGMENT: f64 = 8.0;
/// Energy of a shock over that which melts, from which on a release leaves drops: some 65 `GPa` of aluminium, 200 of copper
/// (a shock of `u = 2.75 km/s`, 9 times the energy to the melting point).
const MELTS: f64 = 9.0;
/// Fragments larger than this share of the sphere stand on its axis.
const CENTRAL: f64 = 0.3;

/// Spheres that thin plates break before walls that they have not enough particles for, one line each.
pub fn coarse(case: &Case, approaches: &[Approach], messages: &mut Vec<String>) {
    let soft = case.bodies.iter().filter(|body| body.rigid.is_none());
    if case.dimension != 3 || soft.count() < 3 {
        return;
    }
    let mut told = vec![false; case.bodies.len()];
    let meetings = approaches.iter().filter(|pair| pair.time.is_finite());
    for (pair, [sphere, bumper]) in meetings
        .flat_map(|pair| [pair.bodies, [pair.bodies[1], pair.bodies[0]]].map(|of| (pair, of)))
    {
        let (body, plate) = (&case.bodies[sphere], &case.bodies[bumper]);
        let Some([size, diameter]) = fragment(case, body, plate, pair.speed) else {
            continue;
        };
        let across = size / body.lattice.spacing;
        let splits = !case.symmetry.is_empty() && size > CENTRAL * diameter;
        if told[sphere] || (across >= ACROSS_FRAGMENT && !splits) {
            continue;
        }
        told[sphere] = true;
        let mut doubt = format!(
            "`{}` breaks in `{}` into fragments of some {:.0} um, {across:.1} particles across",
            body.name,
            plate.name,
            1e6 * size
        );
        if across < ACROSS_FRAGMENT {
            let _ = write!(
                doubt,
                "; fewer than {ACROSS_FRAGMENT} are dust, which walls behind bear better: a verdict takes a spacing of {:.0} um",
                1e6 * size / ACROSS_FRAGMENT
            );
        }
        if splits {
            doubt += "; planes of symmetry split the one on the axis: take a whole model";
        }
        messages.push(doubt);
    }
}

/// Sizes (m) of the largest fragments of a sphere that a thinner plate breaks, and of the sphere: the size by which the
/// energy of the cracks is the kinetic energy of its expansion, `(24 G/(ρ ε̇²))^⅓` (Grady 1988, J. Mech. Phys. Solids 36,
/// 353, with `K² = ρ c² G`).
fn fragment(case: &Case, body: &Body, plate: &Body, speed: f64) -> Option<[f64; 2]> {
    let &Shape::Sphere { radius, .. } = &body.shape else {
        return None;
    };
    let (material, diameter) = (&case.materials[body.material], 2.0 * radius);
    let energy = material.failure.options.fracture_energy;
    let breaks = material.failure.spall.is_some() && energy > 0.0;
    let thin = plate.rigid.is_none() && super::case::thickness(plate, case) < diameter;
    let heat = material.thermal.as_ref()?.constants();
    let heat = heat.specific_heat * (heat.melting_temperature? - heat.reference_temperature);
    let melts = speed * speed / 8.0 > MELTS * heat;
    if !breaks || !thin || melts {
        return None;
    }
    let rate = RATE * speed / diameter;
    let size = (24.0 * energy / (material.reference_density * rate * rate)).cbrt();
    (size < diameter).then_some([size, diameter])
}
