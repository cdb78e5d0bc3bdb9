//! Points of a ring about an axis, as a particle sees them within a reach.
//!
//! A ring about the second axis, at the radius `r_j`, is seen from a place at `r_i` in the plane of the first two axes.
//! What lies at an angle θ of it has the distance `d² = d₀² + 4 r_i r_j sin²(θ/2)` with the distance `d₀` in the plane. The
//! points stand in the middles of equal parts of the arc within the reach, `0 < θ < θ_c`; each counts for its mirror image at
//! −θ too. Nothing here tells which of the two is the ring and which the place: pairs see each other at the same points. No operation is fused: contact
//! takes arcs outside of vector code, where the processor may have none that is.

use crate::lanes::Lanes;

/// Points of half an arc.
pub const POINTS: usize = 4;

/// One point of an arc after the other.
#[derive(Debug, Clone, Copy)]
pub struct Arc<V> {
    /// Sine and cosine of θ/2 at the point.
    half: [V; 2],
    /// The same of half the angle between points.
    step: [V; 2],
    /// Share of the ring that each point and its mirror image stand for.
    pub share: V,
}

/// Sine and cosine of half an angle of at most a right one.
#[inline(always)]
fn halved<V: Lanes>([sine, cosine]: [V; 2]) -> [V; 2] {
    let half = V::splat(0.5);
    let new = cosine.mul(half).add(half).sqrt();
    [sine.mul(half).div(new), new]
}

impl<V: Lanes> Arc<V> {
    /// No arc: all in the plane.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        Self {
            half: [zero, one],
            step: [zero, one],
            share: one,
        }
    }

    /// The first point, of radii (m), the square of the distance in the plane (m²) and the reach (m).
    #[inline(always)]
    #[must_use]
    pub fn new([r_i, r_j]: [V; 2], flat: V, reach: V) -> Self {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let four = four_radii(r_i, r_j);
        // sin²(θ_c/2), of the whole ring where all of it is in reach.
        let square = reach.mul(reach).sub(flat).max(zero).div(four).min(one);
        let end = [square.sqrt(), one.sub(square).sqrt()];
        // θ_c/8, and half of that.
        let step = halved(halved(end));
        let half = halved(step);
        // The angle of a sine up to .2, to 1e-13.
        let [sine, _] = half;
        let s2 = sine.mul(sine);
        let mut series = V::splat(0.0);
        for term in [
            231.0 / 13312.0,
            63.0 / 2816.0,
            35.0 / 1152.0,
            5.0 / 112.0,
            3.0 / 40.0,
            1.0 / 6.0,
            1.0,
        ] {
            series = series.mul(s2).add(V::splat(term));
        }
        // θ_c/(4 π) with θ_c = 16 of these.
        let share = sine.mul(series).mul(V::splat(4.0 / std::f64::consts::PI));
        Self { half, step, share }
    }

    /// To the next point.
    #[inline(always)]
    pub fn advance(&mut self) {
        let ([s, c], [ds, dc]) = (self.half, self.step);
        self.half = [c.mul(ds).add(s.mul(dc)), c.mul(dc).sub(s.mul(ds))];
    }

    /// Square of the distance (m²) of the point, of radii (m) and the square of the distance in the plane (m²).
    #[inline(always)]
    #[must_use]
    pub fn square(&self, [r_i, r_j]: [V; 2], flat: V) -> V {
        let [s, _] = self.half;
        four_radii(r_i, r_j).mul(s.mul(s)).add(flat)
    }

    /// Cosine and sine of the angle of the point.
    #[inline(always)]
    #[must_use]
    pub fn turn(&self) -> [V; 2] {
        let ([s, c], two) = (self.half, V::splat(2.0));
        let twice = s.mul(two);
        [V::splat(1.0).sub(twice.mul(s)), twice.mul(c)]
    }

    /// `r_i e − r_j e(θ)` along the first axis and along the third (m).
    #[inline(always)]
    #[must_use]
    pub fn apart(&self, r_i: V, r_j: V) -> [V; 2] {
        let ([s, c], two) = (self.half, V::splat(2.0));
        let chord = s.mul(two).mul(r_j);
        [
            chord.mul(s).add(r_i.sub(r_j)),
            V::splat(0.0).sub(chord.mul(c)),
        ]
    }
}

/// `4 r_i r_j` (m²), never zero.
#[inline(always)]
fn four_radii<V: Lanes>(r_i: V, r_j: V) -> V {
    r_i.mul(r_j)
        .mul(V::splat(4.0))
        .max(V::splat(f64::MIN_POSITIVE))
}

#[cfg(test)]
mod tests {
    use super::{Arc, POINTS};
    use crate::kernel::Kernel;
    use crate::lanes::{F64x8, Lanes};

    /// Mean of the kernel over a ring, and the ring's share in reach.
    fn mean(r_i: f64, r_j: f64, height: f64, h: f64) -> [f64; 2] {
        let radii = [F64x8::splat(r_i), F64x8::splat(r_j)];
        let flat = F64x8::splat((r_i - r_j).powi(2) + height * height);
        let mut arc = Arc::new(radii, flat, F64x8::splat(2.0 * h));
        let (mut sum, mut share) = (0.0, 0.0);
        for _ in 0..POINTS {
            let square = arc.square(radii, flat).0[0];
            let [x, z] = arc.apart(radii[0], radii[1]).map(|a| a.0[0]);
            let [cosine, sine] = arc.turn().map(|a| a.0[0]);
            assert!((x * x + z * z + height * height - square).abs() < 1e-13);
            assert!((x - (r_i - r_j * cosine)).abs() < 1e-14 && (z + r_j * sine).abs() < 1e-14);
            sum += arc.share.0[0] * Kernel::new(3).value(square.sqrt(), h);
            share += arc.share.0[0];
            arc.advance();
        }
        [sum, share]
    }

    #[test]
    fn sums_over_points_are_means_over_the_ring() {
        for (r_i, r_j, height) in [
            (10.0, 10.5, 0.3),
            (0.4, 0.5, 0.0),
            (0.5, 0.5, 0.0),
            (0.05, 1.0, 0.7),
            (3.0, 1.2, 0.4),
        ] {
            let h: f64 = 1.3;
            let exact: f64 = (0..200_000)
                .map(|n| std::f64::consts::PI * (f64::from(n) + 0.5) / 200_000.0)
                .map(|angle| {
                    let square =
                        r_i * r_i + r_j * r_j - 2.0 * r_i * r_j * angle.cos() + height * height;
                    Kernel::new(3).value(square.sqrt(), h) / 200_000.0
                })
                .sum();
            let [found, share] = mean(r_i, r_j, height, h);
            assert!(
                (found / exact - 1.0).abs() < 3e-4,
                "{r_i} {r_j}: {found} {exact}"
            );
            let cosine =
                (r_i * r_i + r_j * r_j + height * height - 4.0 * h * h) / (2.0 * r_i * r_j);
            let within = cosine.clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
            assert!((share / within - 1.0).abs() < 1e-9, "{share} {within}");
        }
    }

    #[test]
    fn pairs_see_each_other_at_the_same_points() {
        let flat = F64x8::splat(0.37);
        let (a, b) = (F64x8::splat(1.3), F64x8::splat(0.9));
        let [one, other] = [[a, b], [b, a]].map(|radii| {
            let mut arc = Arc::new(radii, flat, F64x8::splat(2.6));
            arc.advance();
            (
                arc.square(radii, flat).0[0].to_bits(),
                arc.share.0[0].to_bits(),
            )
        });
        assert_eq!(one, other);
    }
}
