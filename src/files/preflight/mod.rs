//! Before a run: what of a valid case looks like a mistake of physics, and what memory it takes.

mod approach;
mod case;
mod costs;
mod impact;
mod initial;
pub mod memory;
mod meshes;
mod sense;
mod steps;
mod waves;

pub use approach::{Approach, approaches};
pub use costs::{Costs, UNEVEN};
pub use initial::beginning;
pub use steps::{expected_step, expected_steps};
pub use waves::{TIMES, Waiting, Waves, mean_work};

use model::{Body, Case, ContactMode};
use populate::{self, overlap};

/// Overlaps below this are within the rounding of curved faces to a lattice (spacings).
const SHALLOW: f64 = 0.2;

/// Doubtful things in a valid case, one line each: bodies that overlap a little, lattices that a
/// symmetry plane does not mirror into themselves, planes that push from the start, bodies that
/// meet without contact or never, surfaces that were mended, contact of an odd stiffness, impacts beyond an equation of state,
/// pressure that heat brings along, and values that no run has a use for; of a case whose bodies meet so.
#[must_use]
pub fn warnings(case: &Case, approaches: &[Approach]) -> Vec<String> {
    let mut found = Vec::new();
    for (a, body) in case.bodies.iter().enumerate() {
        for (b, other) in case.bodies.iter().enumerate().skip(a + 1) {
            let sees = !matches!(case.contact_between(a, b), ContactMode::None)
                && (body.rigid.is_none() || other.rigid.is_none());
            if let Some(overlap) = sees.then(|| overlap(case, a, b)).flatten()
                && overlap.depth > SHALLOW
            {
                found.push(format!(
                    "`{}` and `{}` begin {:.2} spacings within each other, which contact takes \
                     for their state of rest; `touch` would lay one against the other",
                    body.name, other.name, overlap.depth
                ));
            }
        }
        for plane in &case.symmetry {
            let layer = populate::first_layer(body, case.dimension, &case.symmetry, plane.axis);
            let Some(layer) = layer else { continue };
            let gap = (layer - plane.position) / body.lattice.spacing;
            // Particles of a file have no lattice, and glass is fitted to the plane.
            let is_apart = body.cloud().is_some() || populate::moves_sites(body);
            let is_even = (0.45..=0.55).contains(&gap) || is_apart;
            if !is_even && crosses(body, case.dimension, plane) {
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
    meshes::warnings(case, &mut found);
    case::stiffness(case, &mut found);
    case::meetings(case, approaches, &mut found);
    impact::warnings(case, approaches, &mut found);
    initial::warnings(case, &mut found);
    sense::warnings(case, approaches, &mut found);
    found
}

/// What is too coarse, one line each; a run that is meant to be coarse need not hear it.
#[must_use]
pub fn advice(case: &Case) -> Vec<String> {
    let mut found = Vec::new();
    case::thin_parts(case, &mut found);
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

/// Whether the whole body has particles behind the plane or within a spacing of it.
fn crosses(body: &Body, dimension: usize, plane: &model::SymmetryPlane) -> bool {
    populate::bounds(body, dimension)
        .is_some_and(|(lower, _)| lower[plane.axis.index()] < plane.position + body.lattice.spacing)
}
