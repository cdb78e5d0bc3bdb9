//! The Jaumann rate of the deviatoric stress, `dS/dt = 2G dev(D) + Ω S − S Ω`, with
//! `D = sym L` and `Ω = skew L`.
//!
//! One step from the mid-step velocity gradient:
//!
//! ```text
//! S ← Q (S + G Δt dev D) Qᵀ + G Δt dev D,    Q = (I − ½ Δt Ω)⁻¹ (I + ½ Δt Ω)
//! ```
//!
//! Q is the rotation of Hughes & Winget (1980), *Finite rotation effects in numerical
//! integration of rate constitutive equations*, Int. J. Numer. Methods Eng. 15, 1862: orthogonal
//! for any Δt, so that a rotation of any size keeps the invariants of S. Half of the strain goes
//! before the rotation and half after it, which makes the step second order where strain and
//! rotation come together.

use super::{Conditions, LANES, PointBatch};
use numerics::vector::dot;

/// Hypoelasticity: advances the deviatoric stress of a batch by the step with its shear moduli.
#[inline(always)]
pub(super) fn deform(point: &mut PointBatch, now: &Conditions) {
    let (g, dt) = (&now.shear_modulus, now.dt);
    if dt == 0.0 {
        return;
    }
    let l = &point.velocity_gradient;
    let s = &point.deviatoric_stress;
    let mut new = [[0.0; LANES]; 6];
    for k in 0..LANES {
        let l_k = [
            l[0][k], l[1][k], l[2][k], l[3][k], l[4][k], l[5][k], l[6][k], l[7][k], l[8][k],
        ];
        let s_k = [s[0][k], s[1][k], s[2][k], s[3][k], s[4][k], s[5][k]];
        let [xx, yy, zz, xy, xz, yz] = advance_point(&l_k, &s_k, g[k] * dt, dt);
        new[0][k] = xx;
        new[1][k] = yy;
        new[2][k] = zz;
        new[3][k] = xy;
        new[4][k] = xz;
        new[5][k] = yz;
    }
    point.deviatoric_stress = new;
}

/// One point of [`deform`]: `l` row-major (1/s), `s` as `xx yy zz xy xz yz` (Pa).
#[inline(always)]
fn advance_point(l: &[f64; 9], s: &[f64; 6], g_dt: f64, dt: f64) -> [f64; 6] {
    let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = *l;
    let third = (xx + yy + zz) * (1.0 / 3.0);
    let half_strain_stress = [
        g_dt * (xx - third),
        g_dt * (yy - third),
        g_dt * (zz - third),
        g_dt * (0.5 * (xy + yx)),
        g_dt * (0.5 * (xz + zx)),
        g_dt * (0.5 * (yz + zy)),
    ];
    let quarter = 0.25 * dt;
    let q = rotation(
        quarter * (xy - yx),
        quarter * (xz - zx),
        quarter * (yz - zy),
    );

    let mut loaded = *s;
    for (stress, half) in loaded.iter_mut().zip(half_strain_stress) {
        *stress += half;
    }
    let mut rotated = conjugate(&q, &loaded);
    for (stress, half) in rotated.iter_mut().zip(half_strain_stress) {
        *stress += half;
    }
    rotated
}

/// `(I − A)⁻¹ (I + A) = I + 2 (A + A²)/(1 + |a|²)` for the skew matrix A of upper components
/// `xy xz yz` and their square sum `|a|²`, row-major.
#[inline(always)]
fn rotation(xy: f64, xz: f64, yz: f64) -> [f64; 9] {
    let (xy2, xz2, yz2) = (xy * xy, xz * xz, yz * yz);
    let f = 2.0 / (1.0 + (xy2 + xz2 + yz2));
    [
        1.0 - f * (xy2 + xz2),
        f * (xy - xz * yz),
        f * (xz + xy * yz),
        -f * (xy + xz * yz),
        1.0 - f * (xy2 + yz2),
        f * (yz - xy * xz),
        f * (xy * yz - xz),
        -f * (yz + xy * xz),
        1.0 - f * (xz2 + yz2),
    ]
}

/// `Q S Qᵀ` for symmetric S as `xx yy zz xy xz yz`.
#[inline(always)]
pub(super) fn conjugate(q: &[f64; 9], s: &[f64; 6]) -> [f64; 6] {
    let [xx, yy, zz, xy, xz, yz] = *s;
    let columns = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let q_row = |i: usize| [q[3 * i], q[3 * i + 1], q[3 * i + 2]];
    let product_row = |i: usize| columns.map(|column| dot(&q_row(i), &column));
    let (qs_x, qs_y, qs_z) = (product_row(0), product_row(1), product_row(2));
    [
        dot(&qs_x, &q_row(0)),
        dot(&qs_y, &q_row(1)),
        dot(&qs_z, &q_row(2)),
        dot(&qs_x, &q_row(1)),
        dot(&qs_x, &q_row(2)),
        dot(&qs_y, &q_row(2)),
    ]
}
