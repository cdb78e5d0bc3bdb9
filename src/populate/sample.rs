//! Places all over a body, to see what varies within it.

use super::{Site, count, sites};
use model::{Body, LatticeKind, SymmetryPlane};

/// Ratio of the spacings of one try and the one before.
const WIDER: f64 = 1.2;

/// The sites of a body above all symmetry planes and whether these are all of them: of a body with more
/// than `most`, the sites of a cubic lattice so wide that there are about as many in its shape.
pub fn sample(
    body: &Body,
    dimension: usize,
    symmetry: &[SymmetryPlane],
    most: u64,
) -> (impl Iterator<Item = Site> + use<>, bool) {
    let mut coarse = body.clone();
    let mut particles = count(body, dimension, symmetry, None);
    let is_all = particles <= most;
    // Of particles that a file gives every few are taken.
    let every = if body.cloud().is_some() {
        particles.div_ceil(most).max(1)
    } else {
        1
    };
    if !is_all && every == 1 {
        coarse.filled = None;
        coarse.lattice.kind = LatticeKind::Cubic;
        coarse.lattice.angle = 0.0;
        coarse.lattice.axis = None;
        coarse.lattice.fit = false;
        coarse.lattice.grade(None);
        while particles > most {
            coarse.lattice.spacing *= WIDER;
            particles = count(&coarse, dimension, symmetry, None);
        }
        // Thin bodies lose their last layer at once.
        while particles == 0 {
            coarse.lattice.spacing /= WIDER;
            particles = count(&coarse, dimension, symmetry, None);
        }
    }
    let every = usize::try_from(every).unwrap_or(usize::MAX);
    let sites = sites(&coarse, dimension, symmetry, None);
    (sites.step_by(every), is_all)
}
