//! Motion by the plain sums of the first sweep: strain, spin, and the rest that no linear field
//! explains.

use super::moments::Moments;
use numerics::lane_matrix::{Symmetric, along, faded, full, times};
use numerics::lanes::Lanes;

/// e⁴ of the spin, at e = .05: a lone pair does not tell how it turns about its own axis.
const SPIN_FADE: f64 = 0.05 * 0.05 * 0.05 * 0.05;

/// Times that the spin takes up what the fade has left of it: the error of the share that it sees
/// is raised to the third power.
const SPIN_PASSES: usize = 2;

/// Sums of the first sweep over pairs.
pub(super) struct PlainSums<V> {
    /// `L₀` (1/s).
    pub(super) gradient: [V; 9],
    /// Those of the places of the neighbours.
    pub(super) moments: Moments<V>,
    /// `Σ w_ij (v_j − v_i)`.
    pub(super) velocity: [V; 3],
}

/// Parts of a motion.
pub(super) struct Motion<V> {
    /// The velocity gradient (1/s): `D + W`.
    pub(super) gradient: [V; 9],
    /// Mean velocity of the neighbours that no linear field explains (m/s).
    pub(super) rest: [V; 3],
}

/// The spin W of a neighbourhood (1/s) whose strain rate is D and whose plain gradient is `L₀`: `W M + M W` is twice the
/// antisymmetric part of `L₀ − D M`, so that the angular velocity is `(tr M I − M)⁻¹` times its axial vector, as an
/// inertia to an angular momentum.
#[inline(always)]
pub(crate) fn spin<V: Lanes>(strain: &[V; 9], plain: &[V; 9], moment: &Symmetric<V>) -> [V; 9] {
    let explained = times(strain, &full(moment));
    let mut left = *plain;
    for c in 0..9 {
        left[c] = left[c].sub(explained[c]);
    }
    let axial = [
        left[7].sub(left[5]),
        left[2].sub(left[6]),
        left[3].sub(left[1]),
    ];
    let [xx, yy, zz, xy, xz, yz] = *moment;
    let zero = V::splat(0.0);
    let inertia = [
        yy.add(zz),
        xx.add(zz),
        xx.add(yy),
        zero.sub(xy),
        zero.sub(xz),
        zero.sub(yz),
    ];
    let inverse = full(&faded(&inertia, V::splat(SPIN_FADE)).inverse);
    let inertia = full(&inertia);
    let mut turn = along(&inverse, &axial);
    for _ in 0..SPIN_PASSES {
        let seen = along(&inertia, &turn);
        let more = along(
            &inverse,
            &[
                axial[0].sub(seen[0]),
                axial[1].sub(seen[1]),
                axial[2].sub(seen[2]),
            ],
        );
        for a in 0..3 {
            turn[a] = turn[a].add(more[a]);
        }
    }
    let [x, y, z] = turn;
    let [back_x, back_y, back_z] = [zero.sub(x), zero.sub(y), zero.sub(z)];
    [zero, back_z, y, z, zero, back_x, back_y, x, zero]
}

/// The motion whose strain rate D is that of the `corrected` gradient and whose [`spin`] W is that of
/// the neighbourhood. Neighbours are expected to move by `W + (L₀ − W M) B`.
#[inline(always)]
pub(super) fn motion<V: Lanes>(
    corrected: &[V; 9],
    plain: &PlainSums<V>,
    inner: &Symmetric<V>,
) -> Motion<V> {
    let half = V::splat(0.5);
    let mut strain = *corrected;
    for (a, b) in [(1, 3), (2, 6), (5, 7)] {
        strain[a] = corrected[a].add(corrected[b]).mul(half);
        strain[b] = strain[a];
    }
    let spin = spin(&strain, &plain.gradient, &plain.moments.second);
    let turned = times(&spin, &full(&plain.moments.second));
    let mut stretch = plain.gradient;
    for c in 0..9 {
        stretch[c] = stretch[c].sub(turned[c]);
    }
    let mut expected = times(&stretch, &full(inner));
    let mut gradient = strain;
    for c in 0..9 {
        expected[c] = expected[c].add(spin[c]);
        gradient[c] = gradient[c].add(spin[c]);
    }
    let linear = along(&expected, &plain.moments.place);
    let weight = plain.moments.weight();
    let mut rest = plain.velocity;
    for a in 0..3 {
        rest[a] = rest[a].add(linear[a]).div(weight);
    }
    Motion { gradient, rest }
}
