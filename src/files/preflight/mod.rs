//! Checks before a run: likely physical mistakes in a valid case, and its memory.

mod approach;
mod case;
mod costs;
mod fragments;
mod impact;
mod initial;
mod joints;
mod kinds;
pub mod memory;
mod meshes;
mod sense;
mod steps;
mod waves;

pub use approach::{Approach, approaches};
pub use case::{Across, across};
pub use costs::{Costs, UNEVEN};
pub use initial::beginning;
pub use kinds::shortened;
pub use steps::{expected_step, expected_steps};
pub use waves::{TIMES, Waiting, Waves, mean_work};

use model::{Body, Case};
use populate::{self, Searches, close_pairs, overlap};

/// Overlaps below this are within the rounding of curved faces to a lattice (spacings).
const SHALLOW: f64 = 0.2;

/// Warnings about a valid case with these approaches, one line each: bodies that overlap a little,
/// lattices that a symmetry plane does not mirror into themselves, planes that push from the start, bodies
/// that meet without contact or never, repaired surfaces, contact of an odd stiffness, impacts beyond an
/// equation of state, pressure from heating, and values that make no sense.
#[must_use]
pub fn warnings(case: &Case, approaches: &[Approach]) -> Vec<String> {
    let mut messages = Vec::new();
    let searches = Searches::new(case);
    let mut close = close_pairs(case).into_iter().peekable();
    for (index, body) in case.bodies.iter().enumerate() {
        while let Some([a, b]) = close.next_if(|pair| pair[0] == index) {
            let found = overlap(&searches, a, b).filter(|overlap| overlap.depth > SHALLOW);
            if let Some(overlap) = found {
                messages.push(format!(
                    "`{}` and `{}` begin {:.2} spacings within each other, which contact takes \
                     for their state of rest; `touch` would lay one against the other",
                    body.name, case.bodies[b].name, overlap.depth
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
                messages.push(format!(
                    "the lattice of `{}` is not its own mirror image: its first layer lies \
                     {gap:.2} spacings from the symmetry plane of {}, not 0.5",
                    body.name,
                    plane.axis.name()
                ));
            }
        }
    }
    surfaces(case, &mut messages);
    meshes::warnings(case, &mut messages);
    case::stiffness(case, &mut messages);
    case::soft_gases(case, &mut messages);
    case::meetings(case, approaches, &mut messages);
    impact::warnings(case, approaches, &mut messages);
    initial::warnings(case, &mut messages);
    initial::squeezed(case, &mut messages);
    sense::warnings(case, approaches, &mut messages);
    joints::warnings(case, &mut messages);
    messages
}

/// Advice on coarse bodies, one line each, which a coarse run may ignore.
#[must_use]
pub fn advice(case: &Case, approaches: &[Approach]) -> Vec<String> {
    let mut messages = Vec::new();
    case::thin_sections(case, approaches, &mut messages);
    fragments::coarse(case, approaches, &mut messages);
    messages
}

/// Bodies that a rigid surface pushes from the start.
fn surfaces(case: &Case, messages: &mut Vec<String>) {
    for surface in &case.loads.surfaces {
        let acts = surface.bodies.iter();
        for (body, _) in case.bodies.iter().zip(acts).filter(|(_, acts)| **acts) {
            let spacing = body.lattice.spacing;
            let gap = populate::smallest_gap(body, case.dimension, &case.symmetry, surface);
            if gap < 0.45 * spacing {
                messages.push(format!(
                    "`{}` begins {:.2} spacings from `{}`, which pushes what is nearer than 0.5",
                    body.name,
                    gap / spacing,
                    surface.name
                ));
            }
        }
    }
}

/// Returns true if the whole body has particles behind the plane or within a spacing of it.
fn crosses(body: &Body, dimension: usize, plane: &model::SymmetryPlane) -> bool {
    populate::bounds(body, dimension)
        .is_some_and(|(lower, _)| lower[plane.axis.index()] < plane.position + body.lattice.spacing)
}
