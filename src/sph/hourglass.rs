//! Hourglass control of the corrected form (theory page "Corrected SPH").
//!
//! The hourglass displacement `w` of a particle is the elastic part of its displacement against its
//! neighbours that no linear field explains. Gradients do not see it, so that stress does nothing
//! against it, and tension even drives it. It pulls pairs along the line between them.

use crate::numerics::lane_matrix::{cross, dot};
use crate::numerics::lanes::Lanes;

/// Keeps a quotient of zeros from being none (Pa).
const TINY: f64 = 1e-290;

/// `w` (m) after a step `dt` (s) in which the neighbours moved by `rest` (m/s) beyond a linear
/// field and all turned with the spin of `gradient` (1/s, row-major): turned as stress is
/// (Hughes & Winget 1980), then moved.
#[inline(always)]
#[must_use]
pub fn advance<V: Lanes>(w: &[V; 3], rest: &[V; 3], gradient: &[V; 9], dt: V) -> [V; 3] {
    let [_, xy, xz, yx, _, yz, zx, zy, _] = *gradient;
    let quarter = dt.mul(V::splat(0.25));
    let half_turn = [
        zy.sub(yz).mul(quarter),
        xz.sub(zx).mul(quarter),
        yx.sub(xy).mul(quarter),
    ];
    let one = V::splat(1.0);
    let scale = V::splat(2.0).div(one.add(dot(&half_turn, &half_turn)));
    let first = cross(&half_turn, w);
    let second = cross(&half_turn, &first);
    let mut moved = *w;
    for a in 0..3 {
        let turned = first[a].add(second[a]).mul_add(scale, moved[a]);
        moved[a] = rest[a].neg_mul_add(dt, turned);
    }
    moved
}

/// The share of `w` that plastic flow leaves, as of the deviatoric stress (Pa, after its return):
/// `q/(q + 3G Δε)` of the equivalent stress q, with `flow = 3G Δε` (Pa).
#[inline(always)]
#[must_use]
pub fn kept<V: Lanes>(deviator: &[V; 6], flow: V) -> V {
    let [xx, yy, zz, xy, xz, yz] = *deviator;
    let (normal, shear) = ([xx, yy, zz], [xy, xz, yz]);
    let square = dot(&shear, &shear).mul_add(V::splat(2.0), dot(&normal, &normal));
    let q = square.mul(V::splat(1.5)).sqrt().add(V::splat(TINY));
    q.div(q.add(flow))
}
