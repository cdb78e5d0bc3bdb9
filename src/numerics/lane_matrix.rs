//! Matrices of three rows in the lanes of vectors, row-major where nothing else is said.

use super::lanes::Lanes;

/// A symmetric matrix in each lane; components xx, yy, zz, xy, xz, yz.
pub type Symmetric<V> = [V; 6];

/// Where the nine components of a symmetric matrix stand among its six.
pub const FULL: [usize; 9] = [0, 3, 4, 3, 1, 5, 4, 5, 2];

/// All components of a symmetric matrix, row-major.
#[inline(always)]
#[must_use]
pub fn full<V: Lanes>(a: &Symmetric<V>) -> [V; 9] {
    let [xx, yy, zz, xy, xz, yz] = *a;
    [xx, xy, xz, xy, yy, yz, xz, yz, zz]
}

/// A matrix times a vector.
#[inline(always)]
#[must_use]
pub fn along<V: Lanes>(t: &[V; 9], r: &[V; 3]) -> [V; 3] {
    let row = |a: usize| t[3 * a + 2].mul_add(r[2], t[3 * a + 1].mul_add(r[1], t[3 * a].mul(r[0])));
    [row(0), row(1), row(2)]
}

/// Product of symmetric matrices that commute, which is symmetric.
#[inline(always)]
#[must_use]
pub fn product<V: Lanes>(a: &Symmetric<V>, b: &Symmetric<V>) -> Symmetric<V> {
    let [xx, yy, zz, xy, xz, yz] = *a;
    let dot = |u: [V; 3], v: [V; 3]| u[2].mul_add(v[2], u[1].mul_add(v[1], u[0].mul(v[0])));
    let (bx, by, bz) = ([b[0], b[3], b[4]], [b[3], b[1], b[5]], [b[4], b[5], b[2]]);
    [
        dot([xx, xy, xz], bx),
        dot([xy, yy, yz], by),
        dot([xz, yz, zz], bz),
        dot([xx, xy, xz], by),
        dot([xx, xy, xz], bz),
        dot([xy, yy, yz], bz),
    ]
}

/// Product of matrices, row-major.
#[inline(always)]
#[must_use]
pub fn times<V: Lanes>(a: &[V; 9], b: &[V; 9]) -> [V; 9] {
    let mut all = *a;
    for i in 0..3 {
        for j in 0..3 {
            let of = |k: usize, sum: V| a[3 * i + k].mul_add(b[3 * k + j], sum);
            all[3 * i + j] = of(2, of(1, a[3 * i].mul(b[j])));
        }
    }
    all
}

/// `A T B` of a matrix T, row-major.
#[inline(always)]
#[must_use]
pub fn between<V: Lanes>(a: &Symmetric<V>, t: &[V; 9], b: &Symmetric<V>) -> [V; 9] {
    let [xx, yy, zz, xy, xz, yz] = *a;
    let left = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let [xx, yy, zz, xy, xz, yz] = *b;
    let right = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut half = [V::splat(0.0); 9];
    for i in 0..3 {
        for j in 0..3 {
            let row = &left[i];
            half[3 * i + j] = row[2].mul_add(t[6 + j], row[1].mul_add(t[3 + j], row[0].mul(t[j])));
        }
    }
    let mut all = half;
    for i in 0..3 {
        for j in 0..3 {
            let row = [half[3 * i], half[3 * i + 1], half[3 * i + 2]];
            all[3 * i + j] = row[2].mul_add(
                right[2][j],
                row[1].mul_add(right[1][j], row[0].mul(right[0][j])),
            );
        }
    }
    all
}

/// The inverse of a symmetric matrix, and what the matrix times it gives, both of which fade out where
/// its eigenvalues are small.
#[derive(Debug, Clone, Copy)]
pub struct Faded<V> {
    /// The inverse of the matrix.
    pub inverse: Symmetric<V>,
    /// The matrix times its inverse.
    pub one: Symmetric<V>,
}

/// `(1 + e⁴) (M⁴ + e⁴ I)⁻¹ M³` and its product with M, of `fade = e⁴`.
#[inline(always)]
#[must_use]
pub fn faded<V: Lanes>(m: &Symmetric<V>, fade: f64) -> Faded<V> {
    let square = product(m, m);
    let (third, fourth) = (product(&square, m), product(&square, &square));
    let least = V::splat(fade);
    let [mut xx, mut yy, mut zz, xy, xz, yz] = fourth;
    (xx, yy, zz) = (xx.add(least), yy.add(least), zz.add(least));
    let minor = |a: V, b: V, c: V, d: V| a.mul(b).sub(c.mul(d));
    let adjugate = [
        minor(yy, zz, yz, yz),
        minor(xx, zz, xz, xz),
        minor(xx, yy, xy, xy),
        minor(xz, yz, xy, zz),
        minor(xy, yz, xz, yy),
        minor(xy, xz, xx, yz),
    ];
    let determinant = xz.mul_add(adjugate[4], xy.mul_add(adjugate[3], xx.mul(adjugate[0])));
    let scale = V::splat(1.0 + fade).div(determinant);
    let inverse = adjugate.map(|c| c.mul(scale));
    Faded {
        inverse: product(&inverse, &third),
        one: product(&inverse, &fourth),
    }
}
