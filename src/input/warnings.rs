//! What is allowed but looks like a mistake.

use crate::model::{Body, Case, ContactMode};
use crate::populate;

/// Doubtful things in a valid case, one line each: bodies whose particles may lie closer than a
/// spacing, lattices that a symmetry plane does not mirror into themselves.
#[must_use]
pub fn warnings(case: &Case) -> Vec<String> {
    let mut found = Vec::new();
    for (a, body) in case.bodies.iter().enumerate() {
        for (b, other) in case.bodies.iter().enumerate().skip(a + 1) {
            let sees = !matches!(case.contact_between(a, b), ContactMode::None)
                && (body.rigid.is_none() || other.rigid.is_none());
            if sees && may_overlap(body, other, case.dimension) {
                found.push(format!(
                    "the particles of `{}` and `{}` may overlap at the start: their bounding \
                     boxes do; `touch` would lay one against the other",
                    body.name, other.name
                ));
            }
        }
        for plane in &case.symmetry {
            let layer = populate::first_layer(body, case.dimension, &case.symmetry, plane.axis);
            let Some(layer) = layer else { continue };
            let gap = (layer - plane.position) / body.lattice.spacing;
            if !(0.45..=0.55).contains(&gap) && crosses(body, case.dimension, plane) {
                found.push(format!(
                    "the lattice of `{}` is not its own mirror image: its first layer lies \
                     {gap:.2} spacings from the symmetry plane of {}, not 0.5",
                    body.name,
                    plane.axis.name()
                ));
            }
        }
    }
    surfaces(case, &mut found);
    found
}

/// Bodies that a rigid surface pushes from the start.
fn surfaces(case: &Case, found: &mut Vec<String>) {
    for surface in &case.loads.surfaces {
        let acts = surface.bodies.iter();
        for (body, _) in case.bodies.iter().zip(acts).filter(|(_, acts)| **acts) {
            let spacing = body.lattice.spacing;
            let gap = populate::smallest_gap(body, case.dimension, &case.symmetry, surface);
            if gap < 0.45 * spacing {
                found.push(format!(
                    "`{}` begins {:.2} spacings from `{}`, which pushes what is nearer than 0.5",
                    body.name,
                    gap / spacing,
                    surface.name
                ));
            }
        }
    }
}

/// Whether the boxes around all particles come closer than half a spacing on every axis.
fn may_overlap(a: &Body, b: &Body, dimension: usize) -> bool {
    let (Some((a_lower, a_upper)), Some((b_lower, b_upper))) = (
        populate::bounds(a, dimension),
        populate::bounds(b, dimension),
    ) else {
        return false;
    };
    let near = 0.25 * (a.lattice.spacing + b.lattice.spacing);
    (0..dimension).all(|x| a_lower[x] < b_upper[x] + near && b_lower[x] < a_upper[x] + near)
}

/// Whether the whole body has particles behind the plane or within a spacing of it.
fn crosses(body: &Body, dimension: usize, plane: &crate::model::SymmetryPlane) -> bool {
    populate::bounds(body, dimension)
        .is_some_and(|(lower, _)| lower[plane.axis.index()] < plane.position + body.lattice.spacing)
}
