//! Velocity gradients of mid-step velocities, by which stress points strain.

use numerics::matrix::{inverse, product};

/// Velocity gradients of one mid-step velocity (1/s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MidStep {
    /// At the start of the step.
    pub start: [f64; 9],
    /// In its middle.
    pub mean: [f64; 9],
    /// At its end.
    pub end: [f64; 9],
}

/// The velocity gradients of a step of `dt` (s) that follows one of `last_dt`, from that at its end
/// by the predicted velocities and `last`, that of the mid-step velocities of the step before where
/// it ended: those of this step's mid-step velocities.
///
/// Mid-step velocities make the strain that of a leapfrog, which is stable without viscosity;
/// predicted ones lead by half a step. Since `v^p = v_{n+½} + κ (v_{n+½} − v_{n−½})` with
/// `κ = Δt/(Δt + Δt_{n−1})`, and places follow the mid-step velocities,
///
/// `[(1 + κ) I + κ Δt H_n] H_{n+1} = L^p + κ H_n`, `G_{n+½} = H_{n+1} (I − ½Δt H_{n+1})⁻¹`,
/// and likewise with Δt where the step begins.
#[inline(always)]
#[must_use]
pub fn mid_step(predicted: &[f64; 9], last: &[f64; 9], dt: f64, last_dt: f64) -> MidStep {
    if dt == 0.0 {
        let same = *predicted;
        return MidStep {
            start: same,
            mean: same,
            end: same,
        };
    }
    let kappa = dt / (dt + last_dt);
    let mut left = [0.0; 9];
    let mut right = [0.0; 9];
    for c in 0..9 {
        left[c] = kappa * dt * last[c];
        right[c] = predicted[c] + kappa * last[c];
    }
    for a in 0..3 {
        left[4 * a] += 1.0 + kappa;
    }
    let end = product(&inverse(&left), &right);
    MidStep {
        start: earlier(&end, dt),
        mean: earlier(&end, 0.5 * dt),
        end,
    }
}

/// The gradient (1/s) of velocities that were the same a `time` (s) ago.
#[inline(always)]
fn earlier(gradient: &[f64; 9], time: f64) -> [f64; 9] {
    let mut way = [0.0; 9];
    for c in 0..9 {
        way[c] = -time * gradient[c];
    }
    for a in 0..3 {
        way[4 * a] += 1.0;
    }
    product(gradient, &inverse(&way))
}
