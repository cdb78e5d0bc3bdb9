//! Radial return for a flow stress that depends on the plastic increment itself.
//!
//! A trial stress of equivalent q above the flow stress returns along its radius by the increment
//! Δ that solves `q − 3G Δ = Y(Δ)`; S then scales by `(q − 3G Δ)/q` (Wilkins 1964; Simo & Hughes
//! 1998, chapter 3). Y never falls with Δ, so that there is one root between zero and
//! `(q − Y(0))/3G`.

use super::{Conditions, LANES, PointBatch};
use numerics::dispatch::Vectorised;
use numerics::lanes::{F64x8, Lanes};

/// Most evaluations of the flow stress; Newton's rule takes two to five, and one more where
/// hardening begins with an infinite slope.
const MOST: usize = 60;
/// Residual at which the root is found, relative to the trial stress.
const RESIDUAL: f64 = 4e-15;

/// Equivalent stress `√(3/2 S:S)` (Pa) of one lane.
#[inline(always)]
pub(crate) fn equivalent_stress(batch: &PointBatch, k: usize) -> f64 {
    let s = &batch.deviatoric_stress;
    let diagonal = s[0][k] * s[0][k] + s[1][k] * s[1][k] + s[2][k] * s[2][k];
    let shear = s[3][k] * s[3][k] + s[4][k] * s[4][k] + s[5][k] * s[5][k];
    (1.5 * (diagonal + 2.0 * shear)).sqrt()
}

/// Returns eight points at constant pressure to flow stresses (Pa) that do not follow the strain of the step.
#[inline(always)]
pub(super) fn to_flow_stress(point: &mut PointBatch, now: &Conditions, flow_stress: &super::Lanes) {
    for k in 0..LANES {
        let q = equivalent_stress(point, k);
        let excess = q - flow_stress[k];
        let yields = excess > 0.0;
        let divisor = if yields { q } else { 1.0 };
        let scale = if yields {
            flow_stress[k] / divisor
        } else {
            1.0
        };
        let three_g = 3.0 * now.shear_modulus[k];
        let counts = yields && three_g > 0.0;
        let stiffness = if counts { three_g } else { 1.0 };
        for component in &mut point.deviatoric_stress {
            component[k] *= scale;
        }
        point.plastic_strain[k] += if counts { excess / stiffness } else { 0.0 };
    }
}

/// Flow stress of eight points.
pub(super) trait FlowStress {
    /// Y (Pa) and dY/dΔ (Pa) for increments Δ ≥ 0 of plastic strain. The slope counts for Δ > 0 alone.
    fn at<V: Lanes>(&self, increment: V) -> [V; 2];

    /// A stress (Pa) below which no point flows, whatever its strain.
    fn least(&self) -> super::Lanes;
}

/// Returns eight points to the yield surface.
pub(super) struct Return<'a, F> {
    pub(super) point: &'a mut PointBatch,
    /// Shear moduli (Pa).
    pub(super) shear_modulus: &'a super::Lanes,
    pub(super) flow: F,
}

impl<F: FlowStress> Vectorised for Return<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let Self {
            point,
            shear_modulus,
            flow,
        } = self;
        let mut q = F64x8([0.0; LANES]);
        for k in 0..LANES {
            q.0[k] = equivalent_stress(point, k);
        }
        let least = flow.least();
        // A loop without a way out, for vectors.
        let mut rest = true;
        for k in 0..LANES {
            rest &= q.0[k] <= least[k];
        }
        if rest {
            return;
        }
        let (zero, stress) = (V::splat(0.0), V::load(&q));
        let three_g = V::read(shear_modulus).mul(V::splat(3.0));
        let [y, _] = flow.at(zero);
        let excess = stress.sub(y);
        let flows = zero.less_than(excess);
        if flows == 0 {
            return;
        }
        let strain = increments(flows, stress, three_g, excess, &flow);
        let x = V::load(&strain);
        let scale = stress.sub(three_g.mul(x)).div(stress).store();
        for component in &mut point.deviatoric_stress {
            for k in 0..LANES {
                let returned = component[k] * scale.0[k];
                component[k] = if flows >> k & 1 == 1 {
                    returned
                } else {
                    component[k]
                };
            }
        }
        for k in 0..LANES {
            point.plastic_strain[k] += strain.0[k];
        }
    }
}

/// The roots of `q − 3G Δ − Y(Δ)` of the points that flow (bit k is point k), zero of others. By Newton's rule from the
/// upper bound, kept in its bracket: a function of each point alone, whatever its neighbours do.
#[inline(always)]
fn increments<V: Lanes, F: FlowStress>(flows: u8, q: V, three_g: V, excess: V, flow: &F) -> F64x8 {
    let mut high = excess.div(three_g).store();
    let mut low = F64x8([0.0; LANES]);
    for k in 0..LANES {
        high.0[k] = if flows >> k & 1 == 1 { high.0[k] } else { 0.0 };
    }
    let (mut x, mut open) = (high, flows);
    let close = q.mul(V::splat(RESIDUAL)).store();
    for _ in 0..MOST {
        let now = V::load(&x);
        let [y, slope] = flow.at(now);
        // Rounded as the stress is that returns.
        let residual = q.sub(three_g.mul(now)).sub(y);
        let next = now.add(residual.div(three_g.add(slope))).store();
        let residual = residual.store();
        for k in 0..LANES {
            let is_root = residual.0[k].abs() <= close.0[k];
            if is_root || open >> k & 1 == 0 {
                open &= !(1 << k);
                continue;
            }
            if residual.0[k] > 0.0 {
                low.0[k] = x.0[k];
            } else {
                high.0[k] = x.0[k];
            }
            let (low, high, next) = (low.0[k], high.0[k], next.0[k]);
            x.0[k] = if low < next && next < high {
                next
            } else if low > 0.0 {
                0.5 * (low + high)
            } else {
                // The root may be many orders of magnitude below.
                0.0625 * high
            };
        }
        if open == 0 {
            break;
        }
    }
    x
}

/// 1 where a number is positive, else 0.
#[inline(always)]
pub(super) fn positive<V: Lanes>(x: V) -> V {
    let zero = V::splat(0.0);
    zero.sub(zero.min_where_positive(V::splat(-1.0), x))
}
