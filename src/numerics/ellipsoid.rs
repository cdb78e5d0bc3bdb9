//! Ellipsoids: what a deformation makes of balls.

use crate::matrix::symmetric_adjugate;
use crate::principal::principal;

/// Largest stretch of an image.
pub const MOST: f64 = 8.0;

/// Least stretch of an image. Gradients differ by as much between neighbours where matter is squeezed most.
const LEAST: f64 = 1.0 / 6.0;

/// An ellipsoid about a middle, as `r² F Fᵀ` of the deformation gradient F that makes it of a ball of radius r: components xx,
/// yy, zz, xy, xz, yz (m²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid([f64; 6]);

impl Ellipsoid {
    /// A ball of a radius (m).
    #[must_use]
    pub fn ball(radius: f64) -> Self {
        let square = radius * radius;
        Self([square, square, square, 0.0, 0.0, 0.0])
    }

    /// Image of a ball of a radius (m) under a deformation gradient, by rows, stretched by no less than a
    /// sixth and no more than eight along any direction; none if that is zero or not finite.
    #[must_use]
    pub fn image(radius: f64, gradient: &[f64; 9]) -> Option<Self> {
        let all: f64 = gradient.iter().map(|f| f * f).sum();
        if !(all > 0.0 && all.is_finite()) {
            return None;
        }
        let (squares, axes) = principal(&components(|a, b| {
            (0..3).fold(0.0, |sum, c| {
                sum + gradient[3 * a + c] * gradient[3 * b + c]
            })
        }));
        if squares.iter().any(|s| s.is_nan()) {
            return None;
        }
        let squares = squares.map(|s| radius * radius * s.clamp(LEAST * LEAST, MOST * MOST));
        Some(Self(components(|a, b| {
            (0..3).fold(0.0, |sum, c| sum + axes[a][c] * squares[c] * axes[b][c])
        })))
    }

    /// One so many times as large.
    #[must_use]
    pub fn scaled(&self, times: f64) -> Self {
        Self(self.0.map(|part| part * (times * times)))
    }

    /// How far it reaches from its middle along a coordinate axis (m).
    #[must_use]
    pub fn reach(&self, axis: usize) -> f64 {
        self.0[axis].sqrt()
    }

    /// How far it reaches in any direction (m).
    #[must_use]
    pub fn farthest(&self) -> f64 {
        let (squares, _) = principal(&self.0);
        squares.into_iter().fold(0.0, f64::max).sqrt()
    }

    /// Its component of two axes (m²).
    #[must_use]
    pub fn component(&self, a: usize, b: usize) -> f64 {
        self.0[if a == b { a } else { a + b + 2 }]
    }

    /// The same in coordinates along three unit vectors.
    #[must_use]
    pub fn along(&self, axes: &[[f64; 3]; 3]) -> Self {
        let part = |a: usize, b: usize| {
            let row = |c: usize| (0..3).fold(0.0, |sum, d| sum + self.component(c, d) * axes[b][d]);
            (0..3).fold(0.0, |sum, c| sum + axes[a][c] * row(c))
        };
        Self(components(part))
    }

    /// Its image in a mirror normal to an axis.
    #[must_use]
    pub fn mirrored(&self, axis: usize) -> Self {
        let part = |a: usize, b: usize| {
            let turns = (a == axis) != (b == axis);
            let own = self.component(a, b);
            if turns { -own } else { own }
        };
        Self(components(part))
    }

    /// The form that gives the square of a distance from its middle, in units of its own reach there: components xx,
    /// yy, zz, xy, xz, yz (1/m²).
    #[must_use]
    pub fn metric(&self) -> [f64; 6] {
        let scale = self.0[0] + self.0[1] + self.0[2];
        let (cofactors, determinant) = symmetric_adjugate(&self.0.map(|part| part / scale));
        cofactors.map(|cofactor| cofactor / (determinant * scale))
    }
}

/// The square of a vector by a [metric](Ellipsoid::metric).
#[inline]
#[must_use]
pub fn square(metric: &[f64; 6], [x, y, z]: &[f64; 3]) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = metric;
    xx * x * x + yy * y * y + zz * z * z + 2.0 * (xy * x * y + xz * x * z + yz * y * z)
}

fn components(part: impl Fn(usize, usize) -> f64) -> [f64; 6] {
    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(a, b)| part(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stretch, a shear and a turn about z.
    const GRADIENT: [f64; 9] = [1.2, -0.9, 0.1, 0.7, 0.8, 0.0, 0.0, 0.3, 0.5];

    fn image_of([x, y, z]: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|a| GRADIENT[3 * a] * x + GRADIENT[3 * a + 1] * y + GRADIENT[3 * a + 2] * z)
    }

    #[test]
    fn distances_are_those_before_the_deformation() {
        let metric = Ellipsoid::image(2.0, &GRADIENT).unwrap().metric();
        for at in [[1.0, 0.0, 0.0], [0.3, -2.0, 1.0], [0.0, 0.5, 7.0]] {
            let before = at.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0;
            let after = square(&metric, &image_of(at)).sqrt();
            assert!((after / before - 1.0).abs() < 1e-12, "{after} {before}");
        }
        let ball = Ellipsoid::ball(0.5);
        assert!((square(&ball.metric(), &[0.3, 0.0, 0.4]) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn reaches_are_those_of_the_surface_in_any_axes() {
        let axes = [[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]];
        let ellipsoid = Ellipsoid::image(1.0, &GRADIENT).unwrap();
        let turned = ellipsoid.along(&axes);
        let mirrored = ellipsoid.mirrored(0);
        let mut reach = [[0.0_f64; 3]; 2];
        for k in 0..200 {
            for l in 0..400 {
                let (height, angle) = (f64::from(k) * 0.01 - 1.0, f64::from(l) * 0.01571);
                let ring = (1.0 - height * height).sqrt();
                let at = image_of([ring * angle.cos(), ring * angle.sin(), height]);
                let seen = axes.map(|axis| (0..3).map(|a| axis[a] * at[a]).sum());
                assert!((square(&turned.metric(), &seen) - 1.0).abs() < 1e-2);
                let behind = [-at[0], at[1], at[2]];
                assert!((square(&mirrored.metric(), &behind) - 1.0).abs() < 1e-2);
                for a in 0..3 {
                    reach[0][a] = reach[0][a].max(at[a]);
                    reach[1][a] = reach[1][a].max(seen[a]);
                }
            }
        }
        for a in 0..3 {
            assert!((ellipsoid.reach(a) / reach[0][a] - 1.0).abs() < 1e-3);
            assert!((turned.reach(a) / reach[1][a] - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn nothing_is_flat_or_endless() {
        let no = |gradient: [f64; 9]| Ellipsoid::image(1.0, &gradient).is_none();
        assert!(no([0.0; 9]) && no([f64::NAN; 9]) && no([1e300; 9]));
        for gradient in [
            [1e9; 9],
            [1e-9; 9],
            [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        ] {
            let ellipsoid = Ellipsoid::image(1.0, &gradient).unwrap();
            assert!(ellipsoid.farthest() <= MOST + 1e-9);
            assert!((0..3).all(|a| (LEAST - 1e-9..=MOST + 1e-9).contains(&ellipsoid.reach(a))));
            assert!(ellipsoid.metric().iter().all(|m| m.is_finite()));
        }
    }
}
