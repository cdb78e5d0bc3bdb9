//! Volumes by halving boxes: those inside count whole, the smallest ones at the surface by the
//! plane at the distance of the solid.

use crate::Vec3;

/// Halvings of the longest edge, in two and in three dimensions.
const HALVINGS: [u32; 2] = [10, 7];

/// Volume (m³; m² in two dimensions) of what lies within a box (m) where a distance that grows no
/// faster than its argument is negative.
pub(super) fn integrated(
    distance: &impl Fn(&Vec3) -> f64,
    (lower, upper): (Vec3, Vec3),
    dimension: usize,
) -> f64 {
    let mut half = (upper - lower) * 0.5;
    let middle = (upper + lower) * 0.5;
    if (0..dimension).any(|a| half[a] <= 0.0) {
        return 0.0;
    }
    for a in dimension..3 {
        half[a] = 0.0;
    }
    // The error of planes at curved faces is a quarter with each halving (Richardson 1911).
    let shortest = half.max() / f64::from(1 << HALVINGS[dimension - 2]);
    let coarse = part(distance, middle, half, shortest, dimension);
    let fine = part(distance, middle, half, 0.5 * shortest, dimension);
    (4.0 * fine - coarse) / 3.0
}

fn part(
    distance: &impl Fn(&Vec3) -> f64,
    middle: Vec3,
    half: Vec3,
    shortest: f64,
    dimension: usize,
) -> f64 {
    let whole: f64 = (0..dimension).map(|a| 2.0 * half[a]).product();
    let depth = -distance(&middle);
    let reach = half.norm();
    if depth >= reach {
        return whole;
    }
    if depth <= -reach {
        return 0.0;
    }
    let longest = half.imax();
    if half[longest] <= shortest {
        let step = 0.5 * half.max();
        let slope = Vec3::from_fn(|a, _| {
            if half[a] == 0.0 {
                return 0.0;
            }
            let mut aside = Vec3::zeros();
            aside[a] = step;
            (distance(&(middle + aside)) - distance(&(middle - aside))) / (2.0 * step)
        });
        return whole * below_plane(slope.component_mul(&half).abs(), depth, dimension);
    }
    let mut narrow = half;
    narrow[longest] *= 0.5;
    let mut aside = Vec3::zeros();
    aside[longest] = narrow[longest];
    part(distance, middle - aside, narrow, shortest, dimension)
        + part(distance, middle + aside, narrow, shortest, dimension)
}

/// Share of the cube `|u_a| ≤ 1` where `n·u ≤ depth`, for n ≥ 0.
fn below_plane(n: Vec3, depth: f64, dimension: usize) -> f64 {
    let sum: f64 = n.sum();
    if sum <= 0.0 || depth >= sum {
        return if depth > 0.0 { 1.0 } else { 0.0 };
    }
    if depth <= -sum {
        return 0.0;
    }
    // Σ (−1)^k (depth + Σ ± n)₊^d / (d! Π 2n), components that hardly count left out.
    let counted: Vec<f64> = n.iter().copied().filter(|c| *c > 1e-3 * sum).collect();
    let d = counted.len().min(dimension);
    let mut share = 0.0;
    for corner in 0..1_u32 << d {
        let is_low = |a: usize| corner >> a & 1 == 1;
        let at: f64 = depth
            + counted
                .iter()
                .enumerate()
                .map(|(a, c)| if is_low(a) { -c } else { *c })
                .sum::<f64>();
        let sign = if corner.count_ones() % 2 == 1 {
            -1.0
        } else {
            1.0
        };
        share += sign * (1..=d).fold(1.0, |product, _| product * at.max(0.0));
    }
    let scale: f64 = counted.iter().map(|c| 2.0 * c).product();
    let factorial: f64 = [1.0, 1.0, 2.0, 6.0][d];
    (share / (scale * factorial)).clamp(0.0, 1.0)
}
