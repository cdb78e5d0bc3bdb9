//! Mean of a scalar over the neighbours without the linear part of the field, so that it is the particle's own where the
//! field is linear, inside a body as at its surface:
//!
//! `s̄_i = s_i + Σ w_ij [s_j − s_i − g_i · (x_j − x_i)]/Σ w_ij`, `w_ij = −V_j r |∇W_ij|`,
//!
//! with the gradient `g_i = B_i Σ V_j (s_j − s_i) ∇W_ij` of the corrected form. The particle itself has no weight.

use super::corrected::Moments;
use super::neighbourhood::{Neighbourhood, gather_at};
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{along, full, load_all};
use numerics::lanes::{F64x8, Lanes};

/// The sums over pairs.
pub struct NeighbourMean<'a, S> {
    /// The receivers and their neighbours.
    pub around: Neighbourhood<'a, S>,
    /// The scalar of all particles and images; infinite for those that do not count.
    pub values: &'a [f64],
    /// Number of dimensions.
    pub dimension: usize,
}

impl<S: PairScale> Vectorised for NeighbourMean<'_, S> {
    /// The particle's own without neighbours. That of a particle that does not count is taken for zero.
    type Output = F64x8;

    #[inline(always)]
    fn run<V: Lanes>(self) -> F64x8 {
        let zero = V::splat(0.0);
        let (position, _) = self.around.motion::<V>();
        let finite = |value: f64| if value == f64::INFINITY { 0.0 } else { value };
        let own: V = gather_at(&self.around.receivers, |place| finite(self.values[place]));
        let (mut gradient, mut sum) = ([zero; 3], zero);
        let mut moments = Moments::none();
        for pair in self.around.pairs(&position) {
            if self.values[pair.index] == f64::INFINITY {
                continue;
            }
            let (separation, volume) = (&pair.separation, pair.volume());
            let factor = separation.inverse.mul(volume).mul(pair.kernel.slope);
            let (steep, weight) = moments.add(&separation.r, separation.square, factor);
            let beyond = V::splat(self.values[pair.index]).sub(own);
            sum = weight.mul_add(beyond, sum);
            for a in 0..3 {
                gradient[a] = steep[a].mul_add(beyond, gradient[a]);
            }
        }
        Neighbourhood::<S>::mirror(&mut gradient);
        moments.complete::<S>(self.dimension);
        let inner = moments.correction::<S>(0).inner;
        let gradient = along(&full(&load_all(&inner)), &gradient);
        for a in 0..3 {
            sum = gradient[a].mul_add(moments.place[a], sum);
        }
        let rest = sum.div(moments.weight());
        own.add(rest).store()
    }
}

#[cfg(test)]
mod tests {
    use super::NeighbourMean;
    use crate::neighbourhood::Sources;
    use numerics::dispatch::Vectorised;
    use numerics::kernel::Kernel;
    use numerics::lanes::F64x8;
    use particles::neighbours::MotionRecord;

    /// Means about the middle and about a corner of a lattice of 7³.
    fn means(value: impl Fn([f64; 3]) -> f64) -> [[f64; 2]; 2] {
        let place = |n: u32| [n % 7, n / 7 % 7, n / 49].map(|k| f64::from(k) - 3.0);
        let record = |n: u32| MotionRecord {
            position: place(n),
            velocity: [0.0; 3],
            volume: 1.0,
            mass: 1.0,
        };
        let records: Vec<_> = (0..343).map(record).collect();
        let values: Vec<f64> = (0..343).map(|n| value(place(n))).collect();
        let all: Vec<u32> = (0..343).collect();
        let scale = crate::scale::Scale::new(&Kernel::new(3), Some(1.3));
        let (middle, corner) = (171, 0);
        let found = crate::with_scale!(scale, scale => {
            let sources = Sources { records: &records, lengths: &[], scale };
            let around = sources.around([middle, corner, 0, 0, 0, 0, 0, 0], &all);
            NeighbourMean { around, values: &values, dimension: 3 }.run::<F64x8>()
        });
        [middle, corner].map(|n| [values[n as usize], found.0[usize::from(n == corner)]])
    }

    #[test]
    fn a_slope_has_its_own_value_everywhere() {
        for [own, mean] in means(|[x, y, z]| 5.0 + 0.3 * x - 0.2 * y + 0.1 * z) {
            assert!((own / mean - 1.0).abs() < 0.01, "{own} {mean}");
        }
    }

    #[test]
    fn a_ridge_stands_out() {
        let [[own, mean], _] = means(|[x, _, _]| if x == 0.0 { 1.0 } else { 0.5 });
        assert!(own > 1.2 * mean, "{own} {mean}");
    }
}
