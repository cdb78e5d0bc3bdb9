//! Corrected SPH: gradients multiplied by a smooth function of the moments of the neighbours, and
//! forces that are their adjoint for any such function (theory page "Corrected SPH").
//!
//! With `M = Σ V_j (x_j − x_i) ⊗ ∇W_ij`, which is symmetric, the plain gradient of a linear field
//! `v = G x` is `L₀ = Σ V_j (v_j − v_i) ⊗ ∇W_ij = G M`. Of M come the commuting symmetric matrices
//!
//! `B = (1 + e⁴) (M⁴ + e⁴ I)⁻¹ M³`, `A = M B`,
//!
//! of which B is `M⁻¹` where neighbours are complete and fades out where they are few, or stand in
//! a plane or a row: no entry of its frame exceeds .57/e. At faces e is larger than inside. Then
//!
//! `D = sym(A L₀ B)`, `P = A σ B`, `f_i = Σ V_i V_j (P_i + P_j) ∇W_ij`
//!
//! belong together: `Σ V_i σ_i : D_i = −Σ f_i · v_i` for any velocities, a rotation gives the
//! antisymmetric `A Ω A`, which is no strain, and the torque of all forces is the antisymmetric part
//! of `Σ V_i A_i σ_i A_i`, which is none. The spin, which does no work, is that of the neighbourhood.

mod forces;
mod moments;
mod motion;

pub use forces::CorrectedRecord;

use super::limiter::Limiter;
use super::neighbourhood::Neighbourhood;
pub(crate) use moments::{Moments, add_moment};
pub(crate) use motion::spin;
use motion::{PlainSums, motion};
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{between, load_all, store_all};
use numerics::lanes::{F64x8, Lanes};

/// e⁴ of the fade inside a body, where neighbours are on all sides, and everywhere in the total form, which does not tear:
/// e = .15. A layer at a face is strained by 1 % less than a linear field says, at e = .28 by 16 %.
pub(crate) const LATE_FADE: f64 = 0.15 * 0.15 * 0.15 * 0.15;

/// The corrections of eight particles; components xx, yy, zz, xy, xz, yz.
#[derive(Debug, Clone, Copy)]
pub struct Correction {
    /// `A`.
    pub outer: [F64x8; 6],
    /// `B`.
    pub inner: [F64x8; 6],
}

impl Correction {
    /// Of a lane that takes none.
    #[inline(always)]
    fn clear(&mut self, lane: usize) {
        for (c, value) in [1.0, 1.0, 1.0, 0.0, 0.0, 0.0].into_iter().enumerate() {
            self.outer[c].0[lane] = value;
            self.inner[c].0[lane] = value;
        }
    }

    /// `A T B` of a matrix in each lane, row-major.
    #[inline(always)]
    #[must_use]
    pub fn apply<V: Lanes>(&self, t: &[V; 9]) -> [V; 9] {
        between(&load_all(&self.outer), t, &load_all(&self.inner))
    }
}

/// The first sweep over the pairs of eight receivers.
#[derive(Debug, Clone, Copy)]
pub struct CorrectedGradient<'a, S> {
    /// The receivers and their neighbours.
    pub around: Neighbourhood<'a, S>,
    /// Number of dimensions.
    pub dimension: usize,
    /// Bit k: receiver k takes no correction.
    pub plain: u8,
}

/// Result of [`CorrectedGradient`].
#[derive(Debug, Clone, Copy)]
pub struct Corrected {
    /// Row-major `L` (1/s).
    pub gradient: [F64x8; 9],
    /// Mean velocity of the neighbours against the particle that no linear field explains (m/s).
    pub rest: [F64x8; 3],
    /// Limiters of the viscosity.
    pub limiter: Limiter,
    /// The corrections.
    pub correction: Correction,
}

impl<S: PairScale> Vectorised for CorrectedGradient<'_, S> {
    type Output = Corrected;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Corrected {
        let plain = self.sums::<V>();
        let correction = plain.moments.correction::<S>(self.plain);
        let corrected = correction.apply(&plain.gradient);
        let motion = motion(&corrected, &plain, &load_all(&correction.inner));
        Corrected {
            gradient: store_all(&motion.gradient),
            rest: store_all(&motion.rest),
            limiter: Limiter::new(
                &motion.gradient,
                &motion.rest,
                plain.moments.square_length(),
            ),
            correction,
        }
    }
}

impl<S: PairScale> CorrectedGradient<'_, S> {
    #[inline(always)]
    fn sums<V: Lanes>(&self) -> PlainSums<V> {
        let zero = V::splat(0.0);
        let (position, velocity) = self.around.motion::<V>();
        let (mut gradient, mut mean_velocity) = ([zero; 9], [zero; 3]);
        let mut moments = Moments::none();
        for pair in self.around.pairs(&position) {
            let (volume, there) = (pair.volume(), pair.velocity());
            let separation = &pair.separation;
            let factor = separation.inverse.mul(volume).mul(pair.kernel.slope);
            let (steep, weight) = moments.add(&separation.r, separation.square, factor);
            for a in 0..3 {
                let v_a = there[a].sub(velocity[a]);
                mean_velocity[a] = v_a.mul_add(weight, mean_velocity[a]);
                for b in 0..3 {
                    let sum = &mut gradient[3 * a + b];
                    *sum = v_a.mul_add(steep[b], *sum);
                }
            }
        }
        Neighbourhood::<S>::mirror_tensor(&mut gradient);
        Neighbourhood::<S>::mirror(&mut mean_velocity);
        moments.complete::<S>(self.dimension);
        PlainSums {
            gradient,
            moments,
            velocity: mean_velocity,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::CorrectedGradient;
    use crate::neighbourhood::Sources;
    use numerics::dispatch::Vectorised;
    use numerics::kernel::{Kernel, RingScale};
    use numerics::lanes::F64x8;
    use particles::neighbours::MotionRecord;

    /// Rings of unit spacing: their moments are one, and the gradient of a linear field is exact, with the stretch round
    /// the axis.
    #[test]
    fn rings_have_the_moments_of_matter_in_space() {
        let place = |n: u32| [f64::from(n % 9) + 0.5, f64::from(n / 9), 0.0];
        let record = |n: u32| {
            let [x, y, _] = place(n);
            MotionRecord {
                position: [x, y, 0.0],
                velocity: [0.3 * x, -0.2 * y, 0.0],
                volume: std::f64::consts::TAU * x,
                mass: 1.0,
            }
        };
        let records: Vec<_> = (0..81).map(record).collect();
        let all: Vec<u32> = (0..81).collect();
        let lengths = [1.3; 81];
        let sources = Sources {
            records: &records,
            lengths: &lengths,
            scale: RingScale::new(&Kernel::new(3)),
        };
        let receivers = [36, 37, 38, 39, 40, 36, 36, 36];
        let around = sources.around(receivers, &all);
        let sums = CorrectedGradient {
            around,
            dimension: 3,
            plain: 0,
        };
        let moments = sums.sums::<F64x8>().moments.second;
        for k in 0..5 {
            let m = moments.map(|m| m.0[k]);
            assert!(m[..3].iter().all(|m| (m - 1.0).abs() < 0.08), "{k}: {m:?}");
            assert!(m[3..].iter().all(|m| m.abs() < 1e-12), "{k}: {m:?}");
        }
        let found = sums.run::<F64x8>().gradient;
        let exact = [0.3, 0.0, 0.0, 0.0, -0.2, 0.0, 0.0, 0.0, 0.3];
        for k in 0..5 {
            for (sum, exact) in found.iter().zip(exact) {
                assert!((sum.0[k] - exact).abs() < 1e-3, "{k}: {} {exact}", sum.0[k]);
            }
        }
    }
}
