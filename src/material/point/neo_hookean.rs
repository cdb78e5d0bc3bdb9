//! Neo-Hookean rubber: `S = (G/J) dev b̄`, where `b̄ = J^(−2/3) F Fᵀ` is the isochoric left
//! Cauchy–Green tensor and `J = ρ₀/ρ`. Source: Simo & Hughes (1998), *Computational Inelasticity*,
//! equation 9.2.6; the pressure is that of the equation of state.
//!
//! Since b̄ has determinant one, S holds all of it, and no other field is needed: with
//! `A = S J/G`, `b̄ = A + β I` where `det(A + β I) = β³ − ½ (A:A) β + det A = 1`. For positive
//! eigenvalues of b̄ this cubic rises at its root and is convex above it, and its root is the
//! largest one, so that Newton's rule from above always finds it. A step pushes b̄ forward by
//!
//! ```text
//! F_Δ = (I − ½Δt L)⁻¹ (I + ½Δt L),    b̄ ← F_Δ b̄ F_Δᵀ / det^(1/3)
//! ```
//!
//! with the mid-step velocity gradient L (second order; exact in simple shear, and a rotation of
//! any size turns b̄ by a rotation), then reads S off again. A closed cycle of strain returns to no
//! stress: the law has a potential, which the Jaumann rate has not.

use super::{Conditions, LANES, Lanes, Law, PointBatch};
use numerics::vector::dot;

/// Newton iterations for β, the same for all states; ten suffice for a stretch of six.
const ITERATIONS: usize = 16;

law! {
    /// Isochoric neo-Hookean elasticity, without bound of strain.
    NeoHookean {
        /// Shear modulus G of small strains (Pa).
        shear_modulus: "Pa",
    }
}

impl Law for NeoHookean {
    const STATE: &'static [&'static str] = &["deviatoric_stress"];
    const FOLLOWS_STATE: bool = true;

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    /// Advances the stress, and sets moduli whose 4/3 (Pa) is the shear part of the fastest wave's.
    ///
    /// The part of a wave along the principal direction of eigenvalue λ of b̄ is
    /// `(G/J) (5 tr b̄ − 3 λ)/9`; 1 in the place of λ bounds it within G/(3 J).
    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        let (g, dt) = (self.shear_modulus, now.dt);
        for k in 0..LANES {
            let l: [f64; 9] = lane(&point.velocity_gradient, k);
            let s: [f64; 6] = lane(&point.deviatoric_stress, k);
            let volume = now.reference_density / point.density[k];
            let strain = 0.5 * dt * (l[0] + l[4] + l[8]);
            let before = volume * (1.0 - strain) / (1.0 + strain);
            let mut b = unimodular(&s, before / g);
            if dt != 0.0 {
                b = push(&increment(&l, 0.5 * dt), &b);
                let pressure = (b[0] + b[1] + b[2]) * (1.0 / 3.0);
                for c in 0..6 {
                    let isotropic = if c < 3 { pressure } else { 0.0 };
                    point.deviatoric_stress[c][k] = (b[c] - isotropic) * (g / volume);
                }
            }
            now.shear_modulus[k] = (5.0 * (b[0] + b[1] + b[2]) - 3.0) * (g / volume) * (1.0 / 12.0);
        }
    }
}

/// One lane of several components.
#[inline(always)]
fn lane<const N: usize>(components: &[Lanes; N], k: usize) -> [f64; N] {
    let mut at = [0.0; N];
    for c in 0..N {
        at[c] = components[c][k];
    }
    at
}

/// `A + β I` of determinant one for the traceless `A = scale S`, as `xx yy zz xy xz yz`.
#[inline(always)]
fn unimodular(s: &[f64; 6], scale: f64) -> [f64; 6] {
    let mut a = [0.0; 6];
    for c in 0..6 {
        a[c] = s[c] * scale;
    }
    let half_square =
        0.5 * (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) + (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]);
    let rest = determinant(&a) - 1.0;
    // Not below the root: |det A| is at most 2 (half_square/3)^(3/2).
    let mut beta = 1.0 + 1.16 * half_square.sqrt();
    for _ in 0..ITERATIONS {
        let value = (beta * beta - half_square) * beta + rest;
        beta -= value / (3.0 * beta * beta - half_square);
    }
    [a[0] + beta, a[1] + beta, a[2] + beta, a[3], a[4], a[5]]
}

/// Determinant of a symmetric tensor.
#[inline(always)]
fn determinant(a: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = *a;
    xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
}

/// `(I − c L)⁻¹ (I + c L) = 2 (I − c L)⁻¹ − I`, row-major.
#[inline(always)]
pub(super) fn increment(l: &[f64; 9], c: f64) -> [f64; 9] {
    let m = |i: usize| f64::from(u8::from(i.is_multiple_of(4))) - c * l[i];
    let [xx, xy, xz, yx, yy, yz, zx, zy, zz] =
        [m(0), m(1), m(2), m(3), m(4), m(5), m(6), m(7), m(8)];
    let (fx, fy, fz) = (yy * zz - yz * zy, yz * zx - yx * zz, yx * zy - yy * zx);
    let twice = 2.0 / (xx * fx + xy * fy + xz * fz);
    [
        twice * fx - 1.0,
        twice * (xz * zy - xy * zz),
        twice * (xy * yz - xz * yy),
        twice * fy,
        twice * (xx * zz - xz * zx) - 1.0,
        twice * (xz * yx - xx * yz),
        twice * fz,
        twice * (xy * zx - xx * zy),
        twice * (xx * yy - xy * yx) - 1.0,
    ]
}

/// `F b Fᵀ` of determinant one.
#[inline(always)]
fn push(f: &[f64; 9], b: &[f64; 6]) -> [f64; 6] {
    let [xx, yy, zz, xy, xz, yz] = *b;
    let columns = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let row = |i: usize| [f[3 * i], f[3 * i + 1], f[3 * i + 2]];
    let product = |i: usize| {
        let r = row(i);
        [
            dot(&r, &columns[0]),
            dot(&r, &columns[1]),
            dot(&r, &columns[2]),
        ]
    };
    let (px, py, pz) = (product(0), product(1), product(2));
    let mut pushed = [
        dot(&px, &row(0)),
        dot(&py, &row(1)),
        dot(&pz, &row(2)),
        dot(&px, &row(1)),
        dot(&px, &row(2)),
        dot(&py, &row(2)),
    ];
    let scale = 1.0 / libm::cbrt(determinant(&pushed));
    for component in &mut pushed {
        *component *= scale;
    }
    pushed
}
