//! Arrays and matrices of three rows in the lanes of vectors, row-major where nothing else is said.

use super::lanes::{F64x8, LANES, Lanes};

/// A symmetric matrix in each lane; components xx, yy, zz, xy, xz, yz.
pub type Symmetric<V> = [V; 6];

/// Indices of the nine components of a symmetric matrix among its six.
pub const FULL: [usize; 9] = [0, 3, 4, 3, 1, 5, 4, 5, 2];

/// All components of a symmetric matrix, row-major.
#[inline(always)]
#[must_use]
pub fn full<V: Lanes>(a: &Symmetric<V>) -> [V; 9] {
    let [xx, yy, zz, xy, xz, yz] = *a;
    [xx, xy, xz, xy, yy, yz, xz, yz, zz]
}

/// Dot product.
#[inline(always)]
#[must_use]
pub fn dot<V: Lanes>(u: &[V; 3], v: &[V; 3]) -> V {
    u[2].mul_add(v[2], u[1].mul_add(v[1], u[0].mul(v[0])))
}

/// `u × v`.
#[inline(always)]
#[must_use]
pub fn cross<V: Lanes>(u: &[V; 3], v: &[V; 3]) -> [V; 3] {
    [
        u[1].mul(v[2]).sub(u[2].mul(v[1])),
        u[2].mul(v[0]).sub(u[0].mul(v[2])),
        u[0].mul(v[1]).sub(u[1].mul(v[0])),
    ]
}

/// A matrix times a vector.
#[inline(always)]
#[must_use]
pub fn along<V: Lanes>(t: &[V; 9], r: &[V; 3]) -> [V; 3] {
    [
        dot(&[t[0], t[1], t[2]], r),
        dot(&[t[3], t[4], t[5]], r),
        dot(&[t[6], t[7], t[8]], r),
    ]
}

/// Product of symmetric matrices that commute, which is symmetric.
#[inline(always)]
#[must_use]
pub fn product<V: Lanes>(a: &Symmetric<V>, b: &Symmetric<V>) -> Symmetric<V> {
    let [xx, yy, zz, xy, xz, yz] = *a;
    let (x, y, z) = ([xx, xy, xz], [xy, yy, yz], [xz, yz, zz]);
    let (bx, by, bz) = ([b[0], b[3], b[4]], [b[3], b[1], b[5]], [b[4], b[5], b[2]]);
    [
        dot(&x, &bx),
        dot(&y, &by),
        dot(&z, &bz),
        dot(&x, &by),
        dot(&x, &bz),
        dot(&y, &bz),
    ]
}

/// Product of matrices, row-major.
#[inline(always)]
#[must_use]
pub fn times<V: Lanes>(a: &[V; 9], b: &[V; 9]) -> [V; 9] {
    let mut all = *a;
    for i in 0..3 {
        let row = [a[3 * i], a[3 * i + 1], a[3 * i + 2]];
        for j in 0..3 {
            all[3 * i + j] = dot(&row, &[b[j], b[3 + j], b[6 + j]]);
        }
    }
    all
}

/// The transposed matrix, row-major.
#[inline(always)]
#[must_use]
pub fn transposed<V: Lanes>(a: &[V; 9]) -> [V; 9] {
    [a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]]
}

/// `A T B` of a matrix T, row-major.
#[inline(always)]
#[must_use]
pub fn between<V: Lanes>(a: &Symmetric<V>, t: &[V; 9], b: &Symmetric<V>) -> [V; 9] {
    times(&times(&full(a), t), &full(b))
}

/// `a b − c d`.
#[inline(always)]
fn minor<V: Lanes>(a: V, b: V, c: V, d: V) -> V {
    a.mul(b).sub(c.mul(d))
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

/// `(1 + e⁴) (M⁴ + e⁴ I)⁻¹ M³` and its product with M, of `fade = e⁴` in each lane.
#[inline(always)]
#[must_use]
pub fn faded<V: Lanes>(m: &Symmetric<V>, fade: V) -> Faded<V> {
    let square = product(m, m);
    let (third, fourth) = (product(&square, m), product(&square, &square));
    let [mut xx, mut yy, mut zz, xy, xz, yz] = fourth;
    (xx, yy, zz) = (xx.add(fade), yy.add(fade), zz.add(fade));
    let adjugate = [
        minor(yy, zz, yz, yz),
        minor(xx, zz, xz, xz),
        minor(xx, yy, xy, xy),
        minor(xz, yz, xy, zz),
        minor(xy, yz, xz, yy),
        minor(xy, xz, xx, yz),
    ];
    let determinant = xz.mul_add(adjugate[4], xy.mul_add(adjugate[3], xx.mul(adjugate[0])));
    let scale = V::splat(1.0).add(fade).div(determinant);
    let mut inverse = adjugate;
    for c in 0..6 {
        inverse[c] = inverse[c].mul(scale);
    }
    Faded {
        inverse: product(&inverse, &third),
        one: product(&inverse, &fourth),
    }
}

/// Vectors from aligned memory. (A loop, since what array methods call may be compiled apart from
/// the vector code.)
#[inline(always)]
#[must_use]
pub fn load_all<V: Lanes, const N: usize>(values: &[F64x8; N]) -> [V; N] {
    let mut all = [V::splat(0.0); N];
    for c in 0..N {
        all[c] = V::load(&values[c]);
    }
    all
}

/// Vectors from memory anywhere.
#[inline(always)]
#[must_use]
pub fn read_all<V: Lanes, const N: usize>(values: &[[f64; LANES]; N]) -> [V; N] {
    let mut all = [V::splat(0.0); N];
    for c in 0..N {
        all[c] = V::read(&values[c]);
    }
    all
}

/// Vectors to memory.
#[inline(always)]
#[must_use]
pub fn store_all<V: Lanes, const N: usize>(values: &[V; N]) -> [F64x8; N] {
    let mut all = [F64x8([0.0; LANES]); N];
    for c in 0..N {
        all[c] = values[c].store();
    }
    all
}
