//! Distance from an ellipse or an ellipsoid.

use crate::Vec3;

/// Halvings of the bracket of the root: all bits of a double.
const HALVINGS: usize = 80;

/// The point of the surface of an ellipsoid with `semi` axes (m) nearest to a point (m). Axes of
/// infinite length do not count.
///
/// The nearest point is `e² y / (t + e²)` by axes, with the root `t` of
/// `Σ (e y / (t + e²))² = 1` (Eberly 2013, "Distance from a point to an ellipse, an ellipsoid, or a
/// hyperellipsoid"), found by halving, since it is safe for every place.
pub(super) fn nearest(semi: &Vec3, point: &Vec3) -> Vec3 {
    let axes = || (0..3).filter(|&a| semi[a].is_finite());
    let least = axes().map(|a| semi[a]).fold(f64::INFINITY, f64::min);
    let shortest = axes().find(|&a| semi[a] == least).unwrap_or(0);
    let mut y = point.map(f64::abs);
    // On a plane of symmetry the root may hide at the pole of the shortest axis.
    y[shortest] = y[shortest].max(1e-12 * least);
    let scaled = |t: f64, a: usize| semi[a] * y[a] / (t + semi[a] * semi[a]);
    let value = |t: f64| axes().map(|a| scaled(t, a) * scaled(t, a)).sum::<f64>() - 1.0;
    let mut low = -least * least + least * y[shortest];
    let norm = axes().map(|a| semi[a] * semi[a] * y[a] * y[a]).sum::<f64>();
    let mut high = -least * least + norm.sqrt();
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if value(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let t = 0.5 * (low + high);
    Vec3::from_fn(|a, _| {
        if !semi[a].is_finite() {
            return point[a];
        }
        let at = semi[a] * semi[a] * y[a] / (t + semi[a] * semi[a]);
        at.copysign(point[a])
    })
}

/// Distance (m) of a point from the surface, negative inside.
pub(super) fn distance(semi: &Vec3, point: &Vec3) -> f64 {
    let level = (0..3)
        .filter(|&a| semi[a].is_finite())
        .map(|a| (point[a] / semi[a]) * (point[a] / semi[a]))
        .sum::<f64>();
    let distance = (nearest(semi, point) - point).norm();
    if level < 1.0 { -distance } else { distance }
}
