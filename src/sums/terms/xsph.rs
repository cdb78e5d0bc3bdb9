//! XSPH (Monaghan 1989): particles drift with the mean velocity of their neighbours.

use numerics::lanes::Lanes;

/// The sums of eight receivers.
pub(super) struct Lane<V> {
    factor: V,
    sum: [V; 3],
}

impl<V: Lanes> Lane<V> {
    #[inline(always)]
    pub fn begin(epsilon: f64) -> Self {
        Self {
            factor: V::splat(-2.0 * epsilon),
            sum: [V::splat(0.0); 3],
        }
    }

    /// Sums `v_ij` times the `share` `m_j W/(ρ_i + ρ_j)`.
    #[inline(always)]
    pub fn follow(&mut self, v: &[V; 3], share: V) {
        for a in 0..3 {
            self.sum[a] = v[a].mul_add(share, self.sum[a]);
        }
    }

    /// `ε Σ (m_j/ρ̄) (v_j − v_i) W_ij` (m/s).
    #[inline(always)]
    pub fn correction(&self) -> [V; 3] {
        // Of what moves alike zero with a plus, as where no sum is made.
        let zero = V::splat(0.0);
        let [x, y, z] = self.sum;
        [
            x.mul_add(self.factor, zero),
            y.mul_add(self.factor, zero),
            z.mul_add(self.factor, zero),
        ]
    }
}
