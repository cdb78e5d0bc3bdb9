//! Small linear algebra: products of vectors of three components, in a fixed order of operations.
//!
//! `nalgebra` sums in an order of its own; these are for what must keep its bits.

/// `a·b`.
#[inline(always)]
#[must_use]
pub fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `v·v`.
#[inline(always)]
#[must_use]
pub fn square(v: &[f64; 3]) -> f64 {
    dot(v, v)
}

/// `|v|`.
#[inline(always)]
#[must_use]
pub fn norm(v: &[f64; 3]) -> f64 {
    square(v).sqrt()
}

/// `a × b`.
#[inline(always)]
#[must_use]
pub fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `a − b`.
#[inline(always)]
#[must_use]
pub fn minus(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
