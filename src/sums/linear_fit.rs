//! Velocities about a stress point fitted by a linear field, by weighted least squares (Lancaster &
//! Salkauskas 1981). With `w = (W h^d/σ_d)⁴`, means `x̄ = Σ w x_a/Σ w`, `v̄` likewise, and
//! `M = Σ w (x_a − x̄) ⊗ (x_a − x̄)`,
//!
//! `L_s = Σ w (v_a − v̄) ⊗ (x_a − x̄) M⁻¹`, `v_s = v̄ + L_s (x_s − x̄)`.

use super::neighbourhood::Neighbourhood;
use numerics::dispatch::Vectorised;
use numerics::kernel::{PairKernel, PairScale};
use numerics::lane_matrix::store_all;
use numerics::lanes::{F64x8, LANES, Lanes};
use numerics::matrix::{product, symmetric_adjugate};

/// Particles that give `M` less than this along a direction, over h², are at the edge of the
/// kernel: two at 1.5 h do. Gradients along it fade out, as they would else end at once with the
/// kernel.
const FAINT: f64 = 1e-6;
/// Fits of a larger [`Fit::norm`] are those of particles nearly in a row, in a plane or at one
/// place.
const STEEP: f64 = 12.0;
/// The steeper they are the more `M` gets along its diagonal, up to so much of `h² Σ w`, about a
/// third of what it has in a lattice: gradients along the row or the plane become less, those
/// across it vanish.
const REGULAR: f64 = 0.05;
/// The norm over `h √(Σ |G|²)`.
pub(crate) const NORM: f64 = 0.8;

/// The weight `(W h^d/σ_d)⁴`: sharp, so that the next particles decide and alternating velocities
/// are seen, yet as far as the kernel, so that no stretch of the body leaves a point without them.
#[inline(always)]
pub(crate) fn weight<V: Lanes, S: PairScale>(scale: &S, kernel: &PairKernel<V>) -> V {
    let shape = scale.shape(kernel);
    let square = shape.mul(shape);
    square.mul(square)
}

/// The geometry of one stress point's fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// `M⁻¹` (1/m²), row-major.
    pub inverse: [f64; 9],
    /// `x̄ − x_s` (m).
    pub offset: [f64; 3],
    /// `Σ w`.
    pub weight: f64,
    /// `.8 h √(Σ |G_a|²)` with `L = Σ v_a ⊗ G_a`: 1.4 in a cubic lattice at h = 1.3 Δp. Frequencies
    /// rise with it.
    pub norm: f64,
    /// True if the particles span the space.
    pub complete: bool,
}

impl Fit {
    /// Without particles.
    pub const NONE: Self = Self {
        inverse: [0.0; 9],
        offset: [0.0; 3],
        weight: 0.0,
        norm: 0.0,
        complete: false,
    };

    /// From `M` and `Σ w² (x_a − x̄) ⊗ (x_a − x̄)` (m²), components xx, yy, zz, xy, xz, yz, `x̄ −
    /// x_s` (m), `Σ w` and the smoothing length (m).
    #[inline(always)]
    fn new(
        mut m: [f64; 6],
        squares: &[f64; 6],
        offset: [f64; 3],
        weight: f64,
        h: f64,
        dimension: usize,
    ) -> Self {
        let faint = (FAINT * h * h - least(&m, dimension)).max(0.0);
        add_diagonal(&mut m, faint);
        let (mut inverse, mut norm) = invert(&m, squares, h, dimension);
        let steep = norm > STEEP;
        if steep {
            add_diagonal(&mut m, REGULAR * (h * h * weight) * (1.0 - STEEP / norm));
            (inverse, norm) = invert(&m, squares, h, dimension);
        }
        if !norm.is_finite() {
            return Self::NONE;
        }
        let complete = faint == 0.0 && !steep;
        Self {
            inverse,
            offset,
            weight,
            norm,
            complete,
        }
    }
}

#[inline(always)]
fn add_diagonal(m: &mut [f64; 6], value: f64) {
    for a in 0..3 {
        m[a] += value;
    }
}

/// The same along all directions that the model has not.
#[inline(always)]
fn filled(m: &[f64; 6], dimension: usize) -> [f64; 6] {
    let mut m = *m;
    for a in dimension..3 {
        m[a] = m[0];
    }
    m
}

/// `1/tr M⁻¹` (m²), from a third of the least eigenvalue of `M` to all of it.
#[inline(always)]
fn least(m: &[f64; 6], dimension: usize) -> f64 {
    let (adjugate, determinant) = symmetric_adjugate(&filled(m, dimension));
    let trace = adjugate[0] + adjugate[1] + adjugate[2];
    if determinant > 0.0 && trace > 0.0 {
        determinant / trace
    } else {
        0.0
    }
}

/// `M⁻¹` (1/m², row-major) and the norm of its fit.
#[inline(always)]
fn invert(m: &[f64; 6], squares: &[f64; 6], h: f64, dimension: usize) -> ([f64; 9], f64) {
    let (adjugate, determinant) = symmetric_adjugate(&filled(m, dimension));
    let scale = 1.0 / determinant;
    let [xx, yy, zz, xy, xz, yz] = adjugate;
    let mut inverse = [xx, xy, xz, xy, yy, yz, xz, yz, zz];
    for value in &mut inverse {
        *value *= scale;
    }
    for a in dimension..3 {
        inverse[4 * a] = 0.0;
    }
    let [xx, yy, zz, xy, xz, yz] = *squares;
    let squares = [xx, xy, xz, xy, yy, yz, xz, yz, zz];
    let all = product(&product(&inverse, &squares), &inverse);
    let square = all[0] + all[4] + all[8];
    if determinant > 0.0 {
        (inverse, NORM * h * square.max(0.0).sqrt())
    } else {
        (inverse, f64::INFINITY)
    }
}

/// Eight stress points with the velocity particles about them.
pub struct LinearFit<'a, S> {
    /// The points and the particles.
    pub around: Neighbourhood<'a, S>,
    /// Number of dimensions.
    pub dimension: usize,
}

/// Result of [`LinearFit`].
#[derive(Debug, Clone, Copy)]
pub struct Fitted {
    /// Row-major `L_s` (1/s).
    pub gradient: [F64x8; 9],
    /// `v_s` (m/s).
    pub velocity: [F64x8; 3],
    /// The geometry.
    pub fits: [Fit; LANES],
}

impl<S: PairScale> Vectorised for LinearFit<'_, S> {
    type Output = Fitted;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Fitted {
        let around = &self.around;
        let (position, velocity) = around.motion::<V>();
        let zero = V::splat(0.0);
        // Σ w, Σ w y, Σ w y ⊗ y, Σ w u, Σ w u ⊗ y with y = x_a − x_s, u = v_a less the last v_s.
        // Of the first three also with w² in place of w.
        let (mut all, mut first, mut second) = (zero, [zero; 3], [zero; 6]);
        let (mut all2, mut first2, mut second2) = (zero, [zero; 3], [zero; 6]);
        let (mut drift, mut product) = ([zero; 3], [zero; 9]);
        for pair in around.pairs(&position) {
            let here = pair.source;
            let w = weight(&around.sources.scale, &pair.kernel);
            let r = pair.separation.r;
            let wy = [
                zero.sub(r[0].mul(w)),
                zero.sub(r[1].mul(w)),
                zero.sub(r[2].mul(w)),
            ];
            all = all.add(w);
            all2 = w.mul_add(w, all2);
            let wwy = [wy[0].mul(w), wy[1].mul(w), wy[2].mul(w)];
            for a in 0..3 {
                first2[a] = first2[a].add(wwy[a]);
                second2[a] = r[a].neg_mul_add(wwy[a], second2[a]);
                first[a] = first[a].add(wy[a]);
                second[a] = r[a].neg_mul_add(wy[a], second[a]);
                let u = V::splat(here.velocity[a]).sub(velocity[a]);
                drift[a] = u.mul_add(w, drift[a]);
                for b in 0..3 {
                    product[3 * a + b] = u.mul_add(wy[b], product[3 * a + b]);
                }
            }
            second[3] = r[0].neg_mul_add(wy[1], second[3]);
            second[4] = r[0].neg_mul_add(wy[2], second[4]);
            second[5] = r[1].neg_mul_add(wy[2], second[5]);
            second2[3] = r[0].neg_mul_add(wwy[1], second2[3]);
            second2[4] = r[0].neg_mul_add(wwy[2], second2[4]);
            second2[5] = r[1].neg_mul_add(wwy[2], second2[5]);
        }
        let sums = Sums {
            once: Moments {
                all: all.store(),
                first: store_all(&first),
                second: store_all(&second),
            },
            twice: Moments {
                all: all2.store(),
                first: store_all(&first2),
                second: store_all(&second2),
            },
            drift: store_all(&drift),
            product: store_all(&product),
        };
        let h = if S::VARIABLE {
            around.h::<V>().store()
        } else {
            around.sources.scale.length(zero, zero).store()
        };
        sums.fit(&store_all(&velocity), &h, self.dimension)
    }
}

/// The sums of eight stress points.
struct Sums {
    once: Moments,
    twice: Moments,
    drift: [F64x8; 3],
    product: [F64x8; 9],
}

/// Sums of weights, and of these times y and y ⊗ y.
struct Moments {
    all: F64x8,
    first: [F64x8; 3],
    second: [F64x8; 6],
}

impl Moments {
    /// `Σ w (y − d) ⊗ (y − d)` of lane `k`.
    #[inline(always)]
    fn about(&self, k: usize, d: &[f64; 3]) -> [f64; 6] {
        let (all, f) = (self.all.0[k], |a: usize| self.first[a].0[k]);
        let part = |c: usize, a: usize, b: usize| {
            self.second[c].0[k] - f(a) * d[b] - d[a] * (f(b) - all * d[b])
        };
        [
            part(0, 0, 0),
            part(1, 1, 1),
            part(2, 2, 2),
            part(3, 0, 1),
            part(4, 0, 2),
            part(5, 1, 2),
        ]
    }
}

impl Sums {
    #[inline(always)]
    fn fit(&self, velocity: &[F64x8; 3], h: &F64x8, dimension: usize) -> Fitted {
        let mut fitted = Fitted {
            gradient: [F64x8([0.0; LANES]); 9],
            velocity: *velocity,
            fits: [Fit::NONE; LANES],
        };
        for k in 0..LANES {
            let all = self.once.all.0[k];
            if all <= 0.0 || all.is_nan() {
                continue;
            }
            let per = 1.0 / all;
            let first = |a: usize| self.once.first[a].0[k] * per;
            let d = [first(0), first(1), first(2)];
            let (m, squares) = (self.once.about(k, &d), self.twice.about(k, &d));
            let fit = Fit::new(m, &squares, d, all, h.0[k], dimension);
            let b = &fit.inverse;
            for a in 0..3 {
                let drift = self.drift[a].0[k];
                let row = |c: usize| self.product[3 * a + c].0[k] - drift * d[c];
                let row = [row(0), row(1), row(2)];
                let mut v = drift * per;
                for c in 0..3 {
                    let l = row[0] * b[c] + row[1] * b[3 + c] + row[2] * b[6 + c];
                    fitted.gradient[3 * a + c].0[k] = l;
                    v -= l * d[c];
                }
                fitted.velocity[a].0[k] += v;
            }
            fitted.fits[k] = fit;
        }
        fitted
    }
}
