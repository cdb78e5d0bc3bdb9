//! Number and bounds of the sites of bodies, counted once for all that asks for them.

use rayon::prelude::*;

use super::filling::Filling;
use super::row::cuts;
use super::visits;
use model::{Body, Filled, SymmetryPlane};

/// Counts the sites of bodies that stand in their final places, above all symmetry planes, where that has not been done.
pub fn fill(bodies: &mut [Body], dimension: usize, symmetry: &[SymmetryPlane]) {
    // Each body by itself, so the same bits in any order.
    let uncounted = bodies.par_iter_mut().filter(|body| body.filled.is_none());
    let seen =
        uncounted.map(|body| visits::of(|| body.filled = Some(filled(body, dimension, symmetry))));
    let seen: Vec<u64> = seen.collect();
    visits::add(seen.into_iter().sum());
}

fn filled(body: &Body, dimension: usize, symmetry: &[SymmetryPlane]) -> Filled {
    let filling = Filling::of(body, dimension, symmetry);
    let cuts = cuts(symmetry, None);
    let above = filling.extremes(&cuts);
    Filled {
        symmetry: symmetry.to_vec(),
        count: filling.count(&cuts),
        whole: if symmetry.is_empty() {
            above
        } else {
            Filling::of(body, dimension, &[]).extremes(&[])
        },
        above,
    }
}

/// What has been counted of a body above some planes.
pub(super) fn known<'a>(body: &'a Body, symmetry: &[SymmetryPlane]) -> Option<&'a Filled> {
    let filled = body.filled.as_ref();
    filled.filter(|filled| filled.symmetry == symmetry)
}
