//! Bodies in touch: the distance that `touch` moves a body by, and the touching value of contact.

use super::bounds;
use super::cells::has_rows;
use super::lattice::{pitches, shifts};
use model::{Axis, Body, LatticeKind};
use numerics::kernel::{Kernel, SUPPORT};

/// The distance by which `body` has to move along `axis` (m, signed) to come into touch with
/// `other`, when it moves towards larger (`forward`) or smaller coordinates: the outermost particle
/// layers of the two then lie one mean spacing apart. `None` if a body has no particles.
#[must_use]
pub fn touching_distance(
    body: &Body,
    other: &Body,
    dimension: usize,
    axis: Axis,
    forward: bool,
) -> Option<f64> {
    let a = axis.index();
    let (lower, upper) = layers(body, dimension)?;
    let (other_lower, other_upper) = layers(other, dimension)?;
    let gap = 0.5 * (body.lattice.spacing + other.lattice.spacing);
    Some(if forward {
        other_lower[a] - gap - upper[a]
    } else {
        other_upper[a] + gap - lower[a]
    })
}

/// Smallest and largest coordinates (m) of the outermost layers of a body; where the spacing is
/// graded, of such as the finest would have: half a spacing below the faces.
fn layers(body: &Body, dimension: usize) -> Option<([f64; 3], [f64; 3])> {
    let extent = bounds(body, dimension)?;
    if body.lattice.grading.is_none() {
        return Some(extent);
    }
    let (lower, upper) = body.shape.solid(dimension).bounds();
    let half = 0.5 * body.lattice.spacing;
    Some((
        lower.add_scalar(half).into(),
        upper.add_scalar(-half).into(),
    ))
}

/// Touching value `C*_{A|B}` of overlap contact: the foreign volume fraction `Σ V_j W_ij` of a
/// particle of `a` one mean spacing in front of the flat face of a half-space of `b`, with the
/// cubic B-spline at the mean smoothing length.
///
/// The particle is straight before a particle of the first layer. Elsewhere along the face of a
/// cubic lattice the sum differs by −.004 to .002 for h = 1.0–1.5 Δp; contact's initial overlap
/// offset forgives the difference at the start. The face of a cubic lattice is a cube face; that of
/// a hexagonal one is its close-packed layer (normal to z), in two dimensions its close-packed row.
#[must_use]
pub fn touching_value(a: &Body, b: &Body, dimension: usize) -> f64 {
    let h = 0.5 * (a.smoothing_length + b.smoothing_length);
    let gap = 0.5 * (a.lattice.spacing + b.lattice.spacing);
    if !has_rows(b) {
        // No face of its lattice faces the particle: the volume is spread evenly.
        return even_fraction(gap - 0.5 * b.lattice.spacing, dimension, h);
    }
    half_space_fraction(b.lattice.kind, b.lattice.spacing, dimension, gap, h)
}

/// `∫ W dV` over a half-space whose face lies `away` (m): by spheres about the particle, of which a
/// cap of the area `2π r (r − z)` lies beyond a face at a distance z, in two dimensions an arc of the
/// length `2 r acos(z/r)`.
fn even_fraction(away: f64, dimension: usize, h: f64) -> f64 {
    const SPHERES: u32 = 4000;
    let kernel = Kernel::new(dimension).of_length(h);
    let step = (SUPPORT * h - away) / f64::from(SPHERES);
    let spheres = (0..SPHERES).map(|n| {
        let r = away + (f64::from(n) + 0.5) * step;
        let beyond = match dimension {
            3 => std::f64::consts::TAU * r * (r - away),
            2 => 2.0 * r * libm::acos(away / r),
            _ => 1.0,
        };
        beyond * step * kernel.value(r)
    });
    spheres.fold(0.0, |sum, sphere| sum + sphere)
}

/// `Σ V_j W_ij` over a half-space of a lattice whose first layer lies `gap` away.
fn half_space_fraction(kind: LatticeKind, spacing: f64, dimension: usize, gap: f64, h: f64) -> f64 {
    let pitch = pitches(kind, dimension).map(|p| p * spacing);
    // The last axis of the dimension is the normal of the face.
    let normal = dimension - 1;
    let reach = |a: usize| {
        #[allow(clippy::cast_possible_truncation)] // a few layers
        let layers = (SUPPORT * h / pitch[a]).ceil() as i64 + 2;
        layers
    };
    let range = |a: usize| match a.cmp(&normal) {
        std::cmp::Ordering::Less => -reach(a)..=reach(a),
        std::cmp::Ordering::Equal => 0..=reach(a),
        std::cmp::Ordering::Greater => 0..=0,
    };
    let first = shifts(kind, dimension, 0, 0);
    let kernel = Kernel::new(dimension).of_length(h);
    let mut sum = 0.0;
    for k in range(2) {
        for j in range(1) {
            let shift = shifts(kind, dimension, j.unsigned_abs(), k.unsigned_abs());
            for i in range(0) {
                #[allow(clippy::cast_precision_loss)] // a few layers
                let mut r = [
                    i as f64 * pitch[0],
                    j as f64 * pitch[1],
                    k as f64 * pitch[2],
                ];
                r[0] += (shift[0] - first[0]) * spacing;
                r[1] += (shift[1] - first[1]) * spacing;
                r[normal] += gap;
                sum += kernel.value((r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt());
            }
        }
    }
    sum * (0..dimension).fold(1.0, |v, _| v * spacing)
}
