//! Joints that hold nothing, or that the spacing makes tougher than they are.

use model::readable::short;
use model::{Case, ContactPair, Joint};
use populate;

/// Bonds are shorter than so many spacings.
const REACH: f64 = 2.5;

/// One line for each.
pub fn warnings(case: &Case, messages: &mut Vec<String>) {
    for pair in &case.contacts {
        if let Some(joint) = &pair.joint {
            messages.extend(far(case, pair).or_else(|| tough(case, pair, joint)));
        }
    }
}

/// Bodies that are too far from each other for any bond.
fn far(case: &Case, pair: &ContactPair) -> Option<String> {
    let [a, b] = pair.bodies.map(|body| &case.bodies[body]);
    let (lower, upper) = populate::bounds(b, case.dimension)?;
    let gap = a.shape.least_distance(&lower, &upper, case.dimension);
    let spacing = 0.5 * (a.lattice.coarsest() + b.lattice.coarsest());
    (gap > REACH * spacing).then(|| {
        format!(
            "the joint of `{}` and `{}` holds nothing: they begin {:.1} spacings from each other or more",
            a.name,
            b.name,
            gap / spacing
        )
    })
}

/// A joint whose bonds store more than its energy before they give way.
fn tough(case: &Case, pair: &ContactPair, joint: &Joint) -> Option<String> {
    let [a, b] = pair.bodies.map(|body| &case.bodies[body]);
    let modulus = case.contact_modulus(a).min(case.contact_modulus(b));
    let spacing = 0.5 * (a.lattice.spacing + b.lattice.spacing);
    let stored = joint.strength * joint.strength / (2.0 * Joint::stiffness(modulus, spacing));
    let energy = joint.energy.filter(|&energy| energy < stored)?;
    Some(format!(
        "the joint of `{}` and `{}` takes {} J/m^2 at this spacing, not {}: it stores as much before it gives way, so it \
         needs a spacing of {} mm",
        a.name,
        b.name,
        short(stored),
        short(energy),
        short(1e3 * spacing * energy / stored)
    ))
}
