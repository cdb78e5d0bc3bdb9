//! Radial return for a flow stress that depends on the plastic increment itself.
//!
//! A trial stress of equivalent q above the flow stress returns along its radius by the increment
//! Δ that solves `q − 3G Δ = Y(Δ)`; S then scales by `(q − 3G Δ)/q` (Wilkins 1964; Simo & Hughes
//! 1998, chapter 3). Y never falls with Δ, so that there is one root between zero and
//! `(q − Y(0))/3G`.

use super::PointBatch;

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

/// Returns one lane to the yield surface. `flow(Δ)` gives Y (Pa) and dY/dΔ (Pa) for an increment
/// of plastic strain Δ ≥ 0.
#[inline(always)]
pub(super) fn return_lane(
    batch: &mut PointBatch,
    k: usize,
    shear_modulus: f64,
    flow: impl Fn(f64) -> [f64; 2],
) {
    let q = equivalent_stress(batch, k);
    let excess = q - flow(0.0)[0];
    if excess > 0.0 {
        let strain = increment(q, 3.0 * shear_modulus, excess, flow);
        let scale = (q - 3.0 * shear_modulus * strain) / q;
        for component in &mut batch.deviatoric_stress {
            component[k] *= scale;
        }
        batch.plastic_strain[k] += strain;
    }
}

/// The root of `q − 3G Δ − Y(Δ)` by Newton's rule from the upper bound, kept in its bracket: a
/// function of this lane alone, whatever its neighbours do.
fn increment(q: f64, three_g: f64, excess: f64, flow: impl Fn(f64) -> [f64; 2]) -> f64 {
    let (mut low, mut high) = (0.0, excess / three_g);
    let mut x = high;
    for _ in 0..MOST {
        let [y, slope] = flow(x);
        let residual = q - three_g * x - y;
        if residual.abs() <= RESIDUAL * q {
            break;
        }
        if residual > 0.0 {
            low = x;
        } else {
            high = x;
        }
        let next = x + residual / (three_g + slope);
        x = if low < next && next < high {
            next
        } else if low > 0.0 {
            0.5 * (low + high)
        } else {
            // The root may be many orders of magnitude below.
            0.0625 * high
        };
    }
    x
}
