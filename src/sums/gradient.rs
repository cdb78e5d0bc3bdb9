//! Velocity gradient `L_i = −Σ_j V_j v_ij ⊗ ∇W_ij` (physics page, section 2).

use super::neighbourhood::Neighbourhood;
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::store_all;
use numerics::lanes::{F64x8, Lanes};

/// The sum over pairs.
pub struct VelocityGradient<'a, S> {
    /// The receivers and their neighbours.
    pub around: Neighbourhood<'a, S>,
}

impl<S: PairScale> Vectorised for VelocityGradient<'_, S> {
    /// Row-major `L` (1/s).
    type Output = [F64x8; 9];

    #[inline(always)]
    fn run<V: Lanes>(self) -> [F64x8; 9] {
        let (position, velocity) = self.around.motion::<V>();
        let mut gradient = [V::splat(0.0); 9];
        for pair in self.around.pairs(&position) {
            let (here, separation) = (pair.source, &pair.separation);
            let factor = separation
                .inverse
                .mul(V::splat(here.volume))
                .mul(pair.kernel.slope);
            for a in 0..3 {
                let v_a = V::splat(here.velocity[a]).sub(velocity[a]).mul(factor);
                for b in 0..3 {
                    gradient[3 * a + b] = v_a.mul_add(separation.r[b], gradient[3 * a + b]);
                }
            }
        }
        store_all(&gradient)
    }
}
