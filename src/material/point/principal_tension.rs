//! The largest principal stress of a point.

use super::failure::Effect;
use super::radial_return::equivalent_stress;
use super::{Conditions, PointBatch};
use numerics::principal::principal;

/// True if the largest principal stress of lane `k` can exceed a limit (Pa): it lies at most two
/// thirds of the equivalent stress above the mean.
#[inline(always)]
pub(super) fn may_exceed(point: &PointBatch, k: usize, limit: f64) -> bool {
    equivalent_stress(point, k) * (2.0 / 3.0) - point.pressure[k] > limit
}

/// Largest principal stress (Pa) of lane `k`, tension positive.
#[inline(always)]
pub(super) fn largest(point: &PointBatch, k: usize) -> f64 {
    let s = point
        .deviatoric_stress
        .each_ref()
        .map(|component| component[k]);
    let ([a, b, c], _) = principal(&s);
    let ab = if b > a { b } else { a };
    (if c > ab { c } else { ab }) - point.pressure[k]
}

/// Largest principal stress (Pa) of the material between the cracks of lane `k`, times the share of tension that damage
/// leaves: where shear fades with tension, that of the point.
#[inline(always)]
pub(super) fn pull(point: &PointBatch, k: usize, now: &Conditions) -> f64 {
    let stress = largest(point, k);
    if now.options.effect == Effect::FrictionKept {
        let kept = now.kept[k];
        let pressure = point.pressure[k];
        let of_pressure = if pressure < 0.0 { 1.0 } else { kept };
        kept * (stress + pressure) - of_pressure * pressure
    } else {
        stress
    }
}
