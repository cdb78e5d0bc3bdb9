//! Corrected SPH: gradients multiplied by a smooth function of the moments of the neighbours, and
//! forces that are their adjoint for any such function (theory page "Corrected SPH").
//!
//! With `M = Σ V_j (x_j − x_i) ⊗ ∇W_ij`, which is symmetric, the plain gradient of a linear field
//! `v = G x` is `L₀ = Σ V_j (v_j − v_i) ⊗ ∇W_ij = G M`. Of M come the commuting symmetric matrices
//!
//! `B = (1 + e⁴) (M⁴ + e⁴ I)⁻¹ M³`, `A = M B`,
//!
//! of which B is `M⁻¹` where neighbours are complete and fades out where they are few, or stand in
//! a plane or a row: no entry of its frame exceeds .57/e. Then
//!
//! `D = sym(A L₀ B)`, `P = A σ B`, `f_i = Σ V_i V_j (P_i + P_j) ∇W_ij`
//!
//! belong together: `Σ V_i σ_i : D_i = −Σ f_i · v_i` for any velocities, a rotation gives the
//! antisymmetric `A Ω A`, which is no strain, and the torque of all forces is the antisymmetric part
//! of `Σ V_i A_i σ_i A_i`, which is none. The spin, which does no work, is that of the neighbourhood.

mod forces;
mod motion;

pub use forces::CorrectedRecord;

use super::limiter::Limiter;
use super::neighbourhood::Neighbourhood;
pub(crate) use motion::spin;
use motion::{PlainSums, motion};
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{Faded, between, faded, load_all, store_all};
use numerics::lanes::{F64x8, LANES, Lanes};

/// e⁴ of the fade, at e = .28. Less gives isolated peaks of strain about edges, more leaves
/// surfaces uncorrected.
const FADE: f64 = 0.28 * 0.28 * 0.28 * 0.28;

/// The same of bodies that deform without tearing: in the total form, and of rings about an axis, which have no such form. At
/// e = .15 a layer at a face is strained by 1 % less than a linear field says, at e = .28 by 16 %.
pub(crate) const LATE_FADE: f64 = 0.15 * 0.15 * 0.15 * 0.15;

/// e⁴ of the fade between particles of a scale.
const fn fade<S: PairScale>() -> f64 {
    if S::RING { LATE_FADE } else { FADE }
}

/// The corrections of eight particles; components xx, yy, zz, xy, xz, yz.
#[derive(Debug, Clone, Copy)]
pub struct Correction {
    /// `A`.
    pub outer: [F64x8; 6],
    /// `B`.
    pub inner: [F64x8; 6],
}

impl Correction {
    /// From moments `M` between particles of a scale.
    #[inline(always)]
    #[must_use]
    pub fn new<V: Lanes, S: PairScale>(m: &[F64x8; 6]) -> Self {
        let Faded { inverse, one } = faded(&load_all::<V, 6>(m), fade::<S>());
        Self {
            outer: store_all(&one),
            inner: store_all(&inverse),
        }
    }

    /// `A T B` of a matrix in each lane, row-major.
    #[inline(always)]
    #[must_use]
    pub fn apply<V: Lanes>(&self, t: &[V; 9]) -> [V; 9] {
        between(&load_all(&self.outer), t, &load_all(&self.inner))
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
        let mut plain = self.sums::<V>();
        for axis in self.dimension..3 {
            plain.moment[axis] = V::splat(1.0);
        }
        let mut m = store_all(&plain.moment);
        if self.plain != 0 {
            for k in (0..LANES).filter(|k| self.plain >> k & 1 == 1) {
                for (c, value) in [1.0, 1.0, 1.0, 0.0, 0.0, 0.0].into_iter().enumerate() {
                    m[c].0[k] = value;
                }
            }
        }
        let correction = Correction::new::<V, S>(&m);
        let corrected = correction.apply(&plain.gradient);
        let motion = motion(&corrected, &plain, &load_all(&correction.inner));
        Corrected {
            gradient: store_all(&motion.gradient),
            rest: store_all(&motion.rest),
            limiter: Limiter::new(&motion.gradient, &motion.rest, plain.square_length()),
            correction,
        }
    }
}

impl<S: PairScale> CorrectedGradient<'_, S> {
    #[inline(always)]
    fn sums<V: Lanes>(&self) -> PlainSums<V> {
        let zero = V::splat(0.0);
        let (position, velocity) = self.around.motion::<V>();
        let (mut gradient, mut moment) = ([zero; 9], [zero; 6]);
        let (mut mean_velocity, mut place) = ([zero; 3], [zero; 3]);
        let mut square = zero;
        for pair in self.around.pairs(&position) {
            let (r, volume, there) = (pair.separation.r, pair.volume(), pair.velocity());
            let factor = pair.separation.inverse.mul(volume).mul(pair.kernel.slope);
            let steep = add_moment(&mut moment, &r, factor);
            let weight = factor.mul(pair.separation.square);
            square = pair.separation.square.mul_add(weight, square);
            for a in 0..3 {
                let v_a = there[a].sub(velocity[a]);
                mean_velocity[a] = v_a.mul_add(weight, mean_velocity[a]);
                place[a] = r[a].mul_add(weight, place[a]);
                for b in 0..3 {
                    let sum = &mut gradient[3 * a + b];
                    *sum = v_a.mul_add(steep[b], *sum);
                }
            }
        }
        Neighbourhood::<S>::mirror_tensor(&mut gradient);
        Neighbourhood::<S>::mirror_symmetric(&mut moment);
        Neighbourhood::<S>::mirror(&mut mean_velocity);
        Neighbourhood::<S>::mirror(&mut place);
        let [xx, yy, zz, ..] = moment;
        PlainSums {
            gradient,
            moment,
            velocity: mean_velocity,
            place,
            square,
            weight: zero.sub(xx.add(yy).add(zz)),
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
        let moments = sums.sums::<F64x8>().moment;
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
