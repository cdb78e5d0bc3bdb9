//! Matrices of three rows, row-major.

/// Product of two matrices.
#[inline(always)]
#[must_use]
pub fn product(a: &[f64; 9], b: &[f64; 9]) -> [f64; 9] {
    let mut all = [0.0; 9];
    for i in 0..3 {
        for j in 0..3 {
            all[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
        }
    }
    all
}

/// Adjugate of a matrix and its determinant.
#[inline(always)]
#[must_use]
pub fn adjugate(m: &[f64; 9]) -> ([f64; 9], f64) {
    let minor = |a: usize, b: usize, c: usize, d: usize| m[a] * m[d] - m[b] * m[c];
    let all = [
        minor(4, 5, 7, 8),
        minor(2, 1, 8, 7),
        minor(1, 2, 4, 5),
        minor(5, 3, 8, 6),
        minor(0, 2, 6, 8),
        minor(2, 0, 5, 3),
        minor(3, 4, 6, 7),
        minor(1, 0, 7, 6),
        minor(0, 1, 3, 4),
    ];
    let determinant = m[0] * all[0] + m[1] * all[3] + m[2] * all[6];
    (all, determinant)
}

/// Adjugate and determinant of a symmetric matrix; components xx, yy, zz, xy, xz, yz.
#[inline(always)]
#[must_use]
pub fn symmetric_adjugate(m: &[f64; 6]) -> ([f64; 6], f64) {
    let [xx, yy, zz, xy, xz, yz] = *m;
    let a = [
        yy * zz - yz * yz,
        xx * zz - xz * xz,
        xx * yy - xy * xy,
        xz * yz - xy * zz,
        xy * yz - xz * yy,
        xy * xz - xx * yz,
    ];
    let determinant = xx * a[0] + xy * a[3] + xz * a[4];
    (a, determinant)
}

/// Inverse of a matrix.
#[inline(always)]
#[must_use]
pub fn inverse(m: &[f64; 9]) -> [f64; 9] {
    let (mut all, determinant) = adjugate(m);
    let scale = 1.0 / determinant;
    for value in &mut all {
        *value *= scale;
    }
    all
}
