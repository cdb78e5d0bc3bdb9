//! Hourglass control of the corrected form (theory page "Corrected SPH").
//!
//! The hourglass displacement `w` of a particle is the elastic part of its displacement against its
//! neighbours that no linear field explains. Gradients do not see it, so that stress does nothing
//! against it, and tension even drives it. It pulls pairs along the line between them.

use crate::numerics::vector::{cross, dot};

/// `w` (m) after a step `dt` (s) in which the neighbours moved by `rest` (m/s) beyond a linear
/// field and all turned with the spin of `gradient` (1/s, row-major): turned as stress is
/// (Hughes & Winget 1980), then moved.
#[inline(always)]
#[must_use]
pub fn advance(w: &[f64; 3], rest: &[f64; 3], gradient: &[f64; 9], dt: f64) -> [f64; 3] {
    let [_, xy, xz, yx, _, yz, zx, zy, _] = *gradient;
    let quarter = 0.25 * dt;
    let half_turn = [
        quarter * (zy - yz),
        quarter * (xz - zx),
        quarter * (yx - xy),
    ];
    let scale = 2.0 / (1.0 + dot(&half_turn, &half_turn));
    let first = cross(&half_turn, w);
    let second = cross(&half_turn, &first);
    let moved = |a: usize| w[a] + scale * (first[a] + second[a]) - rest[a] * dt;
    [moved(0), moved(1), moved(2)]
}

/// The share of `w` that plastic flow leaves, as of the deviatoric stress (Pa, after its return):
/// `q/(q + 3G Δε)` of the equivalent stress q, with `flow = 3G Δε` (Pa).
#[inline(always)]
#[must_use]
pub fn kept(deviator: &[f64; 6], flow: f64) -> f64 {
    if flow > 0.0 {
        let [xx, yy, zz, xy, xz, yz] = *deviator;
        let q = (1.5 * (xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz))).sqrt();
        q / (q + flow)
    } else {
        1.0
    }
}
