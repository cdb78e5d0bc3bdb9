//! The total form of corrected SPH: sums over the neighbours of the initial configuration (theory page "Total form").
//!
//! With `∇W` at the initial positions `X`, initial volumes `V⁰` and the moments `M = Σ V⁰_j (X_j − X_i) ⊗ ∇W_ij` of the
//! initial neighbours, whose inverse fades to `B` as in [`super::corrected`], the plain deformation gradient and its rate are
//!
//! `F₀ = Σ V⁰_j (x_j − x_i) ⊗ ∇W_ij`, `Ḟ₀ = Σ V⁰_j (v_j − v_i) ⊗ ∇W_ij`.
//!
//! Of the deformation gradient `F` come `N = B F⁻¹` and `T = F₀ N`, which is the identity where neighbours are complete. Then
//!
//! `D = sym(Tᵀ Ḟ₀ N)`, `Q = J T σ Nᵀ`, `f_i = Σ V⁰_i V⁰_j (Q_i + Q_j) ∇W_ij`
//!
//! belong together: `Σ V_i σ_i : D_i = −Σ f_i · v_i` with `V = J V⁰` for any velocities and any `F`, a rotation gives the
//! antisymmetric `Tᵀ Ω T`, which is no strain, and the torque of all forces is the antisymmetric part of
//! `Σ V_i T_i σ_i T_iᵀ`, which is none. A body that has not deformed has `T = M B` and `N = B` of the corrected form.

mod forces;
mod pairs;

pub use forces::TotalRecord;
pub use pairs::Close;

use super::corrected::{LATE_FADE, add_moment, spin};
use super::limiter::Limiter;
use super::neighbourhood::{Neighbourhood, gather, gather_all, records};
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{
    Symmetric, along, cross, dot, faded, full, product, store_all, times, transposed,
};
use numerics::lanes::{F64x8, LANES, Lanes};
use pairs::{Pairs, at};

/// Share ε of the moments of a complete neighbourhood that every particle has in every direction.
const THICKNESS: f64 = 1e-6;

/// Least determinant of a deformation gradient that is inverted: whoever has less leaves the form.
pub const LEAST_DETERMINANT: f64 = 1e-3;

/// Sums over the initial pairs of a particle that stay what they are.
#[derive(Debug, Clone, Copy, Default, bytemuck::Zeroable)]
pub struct InitialSums {
    /// `M`, components xx, yy, zz, xy, xz, yz.
    pub moment: [f64; 6],
    /// `Σ w_ij R²` with `w_ij = −V⁰_j R |∇W_ij|` (m²).
    pub square: f64,
}

/// Makes the [`InitialSums`] of eight receivers.
#[derive(Debug, Clone, Copy)]
pub struct InitialPairs<'a, S> {
    /// The receivers and their neighbours at their initial positions, with initial volumes.
    pub around: Neighbourhood<'a, S>,
}

impl<S: PairScale> Vectorised for InitialPairs<'_, S> {
    type Output = [InitialSums; LANES];

    #[inline(always)]
    fn run<V: Lanes>(self) -> [InitialSums; LANES] {
        let (initial, _) = self.around.motion::<V>();
        let (mut moment, mut square) = ([V::splat(0.0); 6], V::splat(0.0));
        for pair in self.around.pairs(&initial) {
            let volume = V::splat(pair.source.volume);
            let factor = pair.separation.inverse.mul(volume).mul(pair.kernel.slope);
            add_moment(&mut moment, &pair.separation.r, factor);
            let weight = factor.mul(pair.separation.square);
            square = pair.separation.square.mul_add(weight, square);
        }
        let (moment, square) = (store_all(&moment), square.store());
        let mut sums = [InitialSums::default(); LANES];
        for (k, own) in sums.iter_mut().enumerate() {
            for c in 0..6 {
                own.moment[c] = moment[c].0[k];
            }
            own.square = square.0[k];
        }
        sums
    }
}

/// The first sweep over the initial pairs of eight receivers.
#[derive(Debug, Clone, Copy)]
pub struct TotalGradient<'a, S> {
    /// The receivers and their neighbours at their initial positions, with initial volumes.
    pub around: Neighbourhood<'a, S>,
    /// What the initial pairs of particles have told, by place.
    pub initial: &'a [InitialSums],
    /// Positions of all particles and images (m), and whatever.
    pub positions: &'a [[f64; 4]],
    /// Number of dimensions.
    pub dimension: usize,
}

/// Result of [`TotalGradient`].
#[derive(Debug, Clone, Copy)]
pub struct Total {
    /// Row-major velocity gradient (1/s).
    pub gradient: [F64x8; 9],
    /// Mean velocity of the neighbours against the particle that no linear field explains (m/s).
    pub rest: [F64x8; 3],
    /// Limiters of the viscosity.
    pub limiter: Limiter,
    /// `T`, row-major.
    pub outer: [F64x8; 9],
    /// `N`, row-major.
    pub inner: [F64x8; 9],
    /// The deformation gradient, row-major.
    pub deformation: [F64x8; 9],
    /// Determinant of the deformation gradient.
    pub determinant: F64x8,
    /// A bound of the inverse of its smallest stretch, at least 1.
    pub squeeze: F64x8,
    /// Largest square of the distance of a neighbour over that of the initial smoothing length.
    pub farthest: F64x8,
}

impl Total {
    /// `T σ Nᵀ` of a stress in each lane, row-major.
    #[inline(always)]
    #[must_use]
    pub fn apply<V: Lanes>(&self, stress: &[V; 9]) -> [V; 9] {
        let outer = numerics::lane_matrix::load_all(&self.outer);
        let inner = numerics::lane_matrix::load_all(&self.inner);
        times(&times(&outer, stress), &transposed(&inner))
    }
}

/// Sums over pairs.
struct Sums<V> {
    /// `Ḟ₀` (1/s).
    rate: [V; 9],
    /// `F₀`.
    deformation: [V; 9],
    /// `Σ w_ij (v_j − v_i)` with `w_ij = −V⁰_j R |∇W_ij|`.
    velocity: [V; 3],
    /// `Σ w_ij (x_i − x_j)`.
    place: [V; 3],
    farthest: V,
}

impl<S: PairScale> TotalGradient<'_, S> {
    #[inline(always)]
    fn sums<V: Lanes>(&self) -> Sums<V> {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let (initial, velocity) = self.around.motion::<V>();
        let position = self.positions_of::<V>();
        let mut sums = Sums {
            rate: [zero; 9],
            deformation: [zero; 9],
            velocity: [zero; 3],
            place: [zero; 3],
            farthest: zero,
        };
        for pair in Pairs::new(self.around, &initial, [self.positions.len()]) {
            // SAFETY: lists name places of images, each of which has its position.
            let [x, y, z, _] = V::columns(unsafe { at(self.positions, &pair.places) });
            let there = [x, y, z];
            let inverse = one.div(pair.distance);
            let factor = inverse.mul(pair.volume).mul(pair.kernel.slope);
            let mut steep = pair.r;
            for part in &mut steep {
                *part = part.mul(factor);
            }
            let weight = factor.mul(pair.square);
            let mut apart = zero;
            for a in 0..3 {
                let v = pair.velocity[a].sub(velocity[a]);
                let x = there[a].sub(position[a]);
                apart = x.mul_add(x, apart);
                sums.velocity[a] = v.mul_add(weight, sums.velocity[a]);
                sums.place[a] = x.neg_mul_add(weight, sums.place[a]);
                for b in 0..3 {
                    let c = 3 * a + b;
                    sums.rate[c] = v.mul_add(steep[b], sums.rate[c]);
                    sums.deformation[c] = x.mul_add(steep[b], sums.deformation[c]);
                }
            }
            let per_length = if S::VARIABLE {
                pair.kernel.inverse_h
            } else {
                one.div(pair.h)
            };
            let ratio = apart.mul(per_length.mul(per_length));
            sums.farthest = sums
                .farthest
                .min_where_positive(zero.sub(ratio), pair.kernel.inside);
        }
        sums
    }

    #[inline(always)]
    fn positions_of<V: Lanes>(&self) -> [V; 3] {
        let mut all = [V::splat(0.0); 3];
        for (a, x) in all.iter_mut().enumerate() {
            let at = |k: usize| self.positions[self.around.receivers[k] as usize][a];
            *x = V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]);
        }
        all
    }
}

/// The inverse of a matrix whose determinant is not below a least one, and its determinant.
#[inline(always)]
fn inverse<V: Lanes>(f: &[V; 9], least: f64) -> ([V; 9], V) {
    let row = |a: usize| [f[3 * a], f[3 * a + 1], f[3 * a + 2]];
    let [x, y, z] = [row(0), row(1), row(2)];
    let (yz, zx, xy) = (cross(&y, &z), cross(&z, &x), cross(&x, &y));
    let determinant = dot(&x, &yz);
    let scale = V::splat(1.0).div(determinant.max(V::splat(least)));
    let column = |a: usize| [yz[a].mul(scale), zx[a].mul(scale), xy[a].mul(scale)];
    let ([a, b, c], [d, e, f], [g, h, i]) = (column(0), column(1), column(2));
    ([a, b, c, d, e, f, g, h, i], determinant)
}

/// `A Aᵀ`.
#[inline(always)]
fn outer_square<V: Lanes>(a: &[V; 9]) -> Symmetric<V> {
    let row = |i: usize| [a[3 * i], a[3 * i + 1], a[3 * i + 2]];
    let (x, y, z) = (row(0), row(1), row(2));
    [
        dot(&x, &x),
        dot(&y, &y),
        dot(&z, &z),
        dot(&x, &y),
        dot(&x, &z),
        dot(&y, &z),
    ]
}

/// A bound of the largest eigenvalue of a matrix without negative ones, at most 1.15 times as large: the fourth root of the
/// largest sum of sizes in a row of its fourth power.
#[inline(always)]
fn largest<V: Lanes>(a: &Symmetric<V>) -> V {
    let zero = V::splat(0.0);
    let size = |c: V| c.max(zero.sub(c));
    let trace = a[0].add(a[1]).add(a[2]).max(V::splat(f64::MIN_POSITIVE));
    // Over the trace, so that no power runs over.
    let mut b = *a;
    for c in 0..6 {
        b[c] = b[c].div(trace);
    }
    let square = product(&b, &b);
    let [xx, yy, zz, xy, xz, yz] = product(&square, &square);
    let (xy, xz, yz) = (size(xy), size(xz), size(yz));
    let rows = [xx.add(xy).add(xz), yy.add(xy).add(yz), zz.add(xz).add(yz)];
    let most = rows[0].max(rows[1]).max(rows[2]);
    most.sqrt().sqrt().mul(trace)
}

/// `(F₀ + ε I) (M + ε I)⁻¹`: the deformation gradient, exact for linear fields but for `ε/M`, and to rounding at the start. A
/// sheet of one layer does not tell how thick it is: there the thickness stays.
#[inline(always)]
fn deformation<V: Lanes>(plain: &[V; 9], moment: &Symmetric<V>) -> [V; 9] {
    let (mut plain, mut moment) = (*plain, *moment);
    for a in 0..3 {
        plain[4 * a] = plain[4 * a].add(V::splat(THICKNESS));
        moment[a] = moment[a].add(V::splat(THICKNESS));
    }
    let (inverse, _) = inverse(&full(&moment), f64::MIN_POSITIVE);
    times(&plain, &inverse)
}

impl<S: PairScale> Vectorised for TotalGradient<'_, S> {
    type Output = Total;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Total {
        let Sums {
            rate,
            deformation: mut plain,
            velocity,
            place,
            farthest,
        } = self.sums::<V>();
        let zero = V::splat(0.0);
        let initial = records(self.initial, &self.around.receivers);
        let mut moment: Symmetric<V> = gather_all(&initial, |sums, c| sums.moment[c]);
        let square: V = gather(&initial, |sums| sums.square);
        let weight = zero.sub(moment[0].add(moment[1]).add(moment[2]));
        let weight = weight.min(V::splat(-f64::MIN_POSITIVE));
        for axis in self.dimension..3 {
            moment[axis] = V::splat(1.0);
            plain[4 * axis] = V::splat(1.0);
        }
        let deformation = deformation(&plain, &moment);
        let (shrink, determinant) = inverse(&deformation, LEAST_DETERMINANT);
        let faded = faded(&moment, V::splat(LATE_FADE));
        let inner = times(&full(&faded.inverse), &shrink);
        let outer = times(&plain, &inner);
        let stretch = times(&rate, &inner);
        let strain = times(&transposed(&outer), &stretch);
        let mean = |a: usize, b: usize| strain[a].add(strain[b]).mul(V::splat(0.5));
        let strain = full(&[
            strain[0],
            strain[4],
            strain[8],
            mean(1, 3),
            mean(2, 6),
            mean(5, 7),
        ]);
        let spin = spin(
            &strain,
            &times(&stretch, &transposed(&outer)),
            &outer_square(&outer),
        );
        let turned = times(&spin, &outer);
        let (mut gradient, mut expected) = (strain, stretch);
        for c in 0..9 {
            gradient[c] = gradient[c].add(spin[c]);
            expected[c] = expected[c].sub(turned[c]).add(spin[c]);
        }
        let linear = along(&expected, &place);
        let rest = |a: usize| velocity[a].add(linear[a]).div(weight);
        let rest = [rest(0), rest(1), rest(2)];
        Total {
            gradient: store_all(&gradient),
            limiter: Limiter::new(&gradient, &rest, square.div(weight)),
            rest: store_all(&rest),
            outer: store_all(&outer),
            inner: store_all(&inner),
            deformation: store_all(&deformation),
            determinant: determinant.store(),
            squeeze: largest(&outer_square(&shrink))
                .sqrt()
                .max(V::splat(1.0))
                .store(),
            farthest: zero.sub(farthest).store(),
        }
    }
}
