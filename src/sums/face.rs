//! Free faces of matter, on which a pressure acts.
//!
//! Under a stress `σ` the corrected form exerts `f_i = Σ V_i V_j (A_i σ_i B_i + A_j σ_j B_j) ∇W_ij`. A pressure of one on all
//! that surrounds the matter is a stress of one more in it, `σ = I`, so that with `G = A B`
//!
//! `a_i = 1/ρ_i Σ V_j (G_i + G_j) ∇W_ij`
//!
//! is the acceleration by it: nothing inside, and on a flat face of the area S altogether S, towards the inside. A body under a
//! pressure on all sides that has the same pressure inside is at rest to rounding.

use super::corrected::Moments;
use super::neighbourhood::{Neighbourhood, gather, gather_at, records};
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{along, full, load_all, product, store_all};
use numerics::lanes::{F64x8, Lanes};

/// The sums of `G` over pairs.
pub struct FaceCorrection<'a, S> {
    /// The receivers and their neighbours.
    pub around: Neighbourhood<'a, S>,
    /// Number of dimensions.
    pub dimension: usize,
    /// Bit k: receiver k takes no correction.
    pub plain: u8,
}

impl<S: PairScale> Vectorised for FaceCorrection<'_, S> {
    /// `xx yy zz xy xz yz`.
    type Output = [F64x8; 6];

    #[inline(always)]
    fn run<V: Lanes>(self) -> [F64x8; 6] {
        let (position, _) = self.around.motion::<V>();
        let mut moments = Moments::none();
        for pair in self.around.pairs(&position) {
            let (separation, volume) = (&pair.separation, pair.volume());
            let factor = separation.inverse.mul(volume).mul(pair.kernel.slope);
            moments.add(&separation.r, separation.square, factor);
        }
        moments.complete::<S>(self.dimension);
        let correction = moments.correction::<S>(self.plain);
        let (outer, inner) = (load_all(&correction.outer), load_all(&correction.inner));
        store_all(&product::<V>(&outer, &inner))
    }
}

/// The sums of accelerations by a unit of pressure.
pub struct Face<'a, S> {
    /// The receivers and their neighbours.
    pub around: Neighbourhood<'a, S>,
    /// `G` of all particles and images.
    pub corrections: &'a [[f64; 6]],
}

impl<S: PairScale> Vectorised for Face<'_, S> {
    /// Components (m²/kg).
    type Output = [F64x8; 3];

    #[inline(always)]
    fn run<V: Lanes>(self) -> [F64x8; 3] {
        let zero = V::splat(0.0);
        let (position, _) = self.around.motion::<V>();
        let (mut slope, mut sum) = ([zero; 3], [zero; 3]);
        for pair in self.around.pairs(&position) {
            let volume = pair.volume();
            let factor = pair.separation.inverse.mul(volume).mul(pair.kernel.slope);
            let (r, mut other) = (pair.separation.r, [zero; 6]);
            for c in 0..6 {
                other[c] = V::splat(self.corrections[pair.index][c]);
            }
            let steep = [r[0].mul(factor), r[1].mul(factor), r[2].mul(factor)];
            let more = along(&full(&other), &steep);
            for a in 0..3 {
                slope[a] = slope[a].add(steep[a]);
                sum[a] = sum[a].add(more[a]);
            }
        }
        let (receivers, mut own) = (&self.around.receivers, [zero; 6]);
        for c in 0..6 {
            own[c] = gather_at(receivers, |place| self.corrections[place][c]);
        }
        let of_own = along(&full(&own), &slope);
        let motion = records(self.around.sources.records, receivers);
        let specific_volume = gather::<V, _>(&motion, |record| record.volume / record.mass);
        for a in 0..3 {
            sum[a] = sum[a].add(of_own[a]).mul(specific_volume);
        }
        store_all(&sum)
    }
}
