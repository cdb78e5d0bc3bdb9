//! Moments of the neighbours, and the corrections that they tell.

use super::{Correction, LATE_FADE};
use crate::neighbourhood::Neighbourhood;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{Symmetric, faded, store_all};
use numerics::lanes::{LANES, Lanes};

/// e⁴ of the fade at a face, at e = .28. Less gives isolated peaks of strain about edges, more leaves
/// surfaces uncorrected. Bodies of rings, which have no total form, take the late one.
const FACE_FADE: f64 = 0.28 * 0.28 * 0.28 * 0.28;

/// One-sidedness of the neighbours at a flat face, from which on the fade is that of a face.
const FACE: f64 = 0.1;

/// Moments of the neighbours of eight receivers, with `w_ij = −V_j r |∇W_ij|`.
pub(crate) struct Moments<V> {
    /// `M = Σ V_j (x_j − x_i) ⊗ ∇W_ij`, whose trace is `−Σ w_ij`.
    pub(crate) second: Symmetric<V>,
    /// `Σ w_ij (x_i − x_j)`.
    pub(crate) place: [V; 3],
    /// `Σ w_ij (x_i − x_j)²`.
    square: V,
    /// `Σ w_ij`, or next to nothing for a particle alone.
    weight: V,
}

impl<V: Lanes> Moments<V> {
    /// Those of no neighbours.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        let zero = V::splat(0.0);
        Self {
            second: [zero; 6],
            place: [zero; 3],
            square: zero,
            weight: zero,
        }
    }

    /// Adds pairs at `r = x_i − x_j` of the given square with `V ∇W = factor r`; gives V ∇W and w.
    #[inline(always)]
    pub(crate) fn add(&mut self, r: &[V; 3], square: V, factor: V) -> ([V; 3], V) {
        let steep = add_moment(&mut self.second, r, factor);
        let weight = factor.mul(square);
        self.square = square.mul_add(weight, self.square);
        for a in 0..3 {
            self.place[a] = r[a].mul_add(weight, self.place[a]);
        }
        (steep, weight)
    }

    /// Ends the sums: those of rings take what their images behind the plane add, and directions that are not there
    /// count as complete.
    #[inline(always)]
    pub(crate) fn complete<S: PairScale>(&mut self, dimension: usize) {
        Neighbourhood::<S>::mirror_symmetric(&mut self.second);
        Neighbourhood::<S>::mirror(&mut self.place);
        let [xx, yy, zz, ..] = self.second;
        let weight = V::splat(0.0).sub(xx.add(yy).add(zz));
        self.weight = weight.min(V::splat(-f64::MIN_POSITIVE));
        for axis in dimension..3 {
            self.second[axis] = V::splat(1.0);
        }
    }

    /// `Σ w_ij`, below zero.
    #[inline(always)]
    pub(crate) fn weight(&self) -> V {
        self.weight
    }

    /// Mean square of the distances of neighbours (m²).
    #[inline(always)]
    pub(crate) fn square_length(&self) -> V {
        self.square.div(self.weight)
    }

    /// The square of the mean separation over the mean square: nothing inside a body, .11 at a flat face, one of a pair.
    #[inline(always)]
    fn one_sided(&self) -> V {
        let [x, y, z] = self.place;
        let mean = x.mul_add(x, y.mul_add(y, z.mul(z)));
        let all = self.square.mul(self.weight);
        mean.div(all.max(V::splat(f64::MIN_POSITIVE)))
    }

    /// e⁴: late inside and of rings, early at faces.
    #[inline(always)]
    fn fade<S: PairScale>(&self) -> V {
        let late = V::splat(LATE_FADE);
        if S::RING {
            return late;
        }
        let share = self.one_sided().mul(V::splat(1.0 / FACE));
        (share.min(V::splat(1.0))).mul_add(V::splat(FACE_FADE - LATE_FADE), late)
    }

    /// The corrections, without any of receivers whose bit in `plain` is set.
    #[inline(always)]
    pub(crate) fn correction<S: PairScale>(&self, plain: u8) -> Correction {
        let corrected = faded(&self.second, self.fade::<S>());
        let mut correction = Correction {
            outer: store_all(&corrected.one),
            inner: store_all(&corrected.inverse),
        };
        if plain != 0 {
            for k in (0..LANES).filter(|k| plain >> k & 1 == 1) {
                correction.clear(k);
            }
        }
        correction
    }
}

/// Adds the moments of pairs at `r = x_i − x_j` with `∇W = factor r`; gives V ∇W.
#[inline(always)]
pub(crate) fn add_moment<V: Lanes>(moment: &mut [V; 6], r: &[V; 3], factor: V) -> [V; 3] {
    let steep = [r[0].mul(factor), r[1].mul(factor), r[2].mul(factor)];
    for a in 0..3 {
        moment[a] = r[a].neg_mul_add(steep[a], moment[a]);
    }
    moment[3] = r[0].neg_mul_add(steep[1], moment[3]);
    moment[4] = r[0].neg_mul_add(steep[2], moment[4]);
    moment[5] = r[1].neg_mul_add(steep[2], moment[5]);
    steep
}
