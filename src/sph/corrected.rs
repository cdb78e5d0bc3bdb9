//! Corrected SPH: gradients multiplied by a smooth function of the moments of the neighbours, and
//! forces that are their adjoint for any such function (theory page "Corrected SPH").
//!
//! With `M = Σ V_j (x_j − x_i) ⊗ ∇W_ij`, which is symmetric, the plain gradient of a linear field
//! `v = G x` is `L₀ = Σ V_j (v_j − v_i) ⊗ ∇W_ij = G M`. Of M come the commuting symmetric matrices
//!
//! `B = (1 + e⁴) (M⁴ + e⁴ I)⁻¹ M³`, `A = M B`,
//!
//! of which B is `M⁻¹` where neighbours are complete and fades out where they are few, or stand in
//! a plane or a row: no entry of its frame exceeds .57/e. Then
//!
//! `L = A L₀ B`, `P = A σ B`, `f_i = Σ V_i V_j (P_i + P_j) ∇W_ij`
//!
//! belong together: `Σ V_i σ_i : L_i = −Σ f_i · v_i` for any velocities, a rotation gives the
//! antisymmetric `L = A Ω A`, and the torque of all forces is the antisymmetric part of
//! `Σ V_i A_i σ_i A_i`, which is none.

use super::momentum::{Forces, Momentum, PairStress, Viscous};
use super::neighbourhood::{Neighbourhood, gather, gather3, records};
use super::terms::{ARTIFICIAL_STRESS, SHAPED, TermSums};
use crate::numerics::dispatch::Vectorised;
use crate::numerics::kernel::PairScale;
use crate::numerics::lanes::{F64x8, LANES, Lanes};
use crate::numerics::matrix;

/// e⁴ of the fade: at e = .28. Less gives isolated peaks of strain about edges, more leaves
/// surfaces uncorrected.
const FADE: f64 = 0.28 * 0.28 * 0.28 * 0.28;

/// e⁴ of the spin, at e = .05: a lone pair does not tell how it turns about its own axis.
const SPIN_FADE: f64 = 0.05 * 0.05 * 0.05 * 0.05;

/// A symmetric matrix in each lane; components xx, yy, zz, xy, xz, yz.
type Symmetric<V> = [V; 6];

/// Where the nine components of a symmetric matrix stand among its six.
const FULL: [usize; 9] = [0, 3, 4, 3, 1, 5, 4, 5, 2];

/// All components of a symmetric matrix, row-major.
#[inline(always)]
fn full<V: Lanes>(a: &Symmetric<V>) -> [V; 9] {
    let [xx, yy, zz, xy, xz, yz] = *a;
    [xx, xy, xz, xy, yy, yz, xz, yz, zz]
}

/// A matrix times a vector.
#[inline(always)]
fn along<V: Lanes>(t: &[V; 9], r: &[V; 3]) -> [V; 3] {
    let row = |a: usize| t[3 * a + 2].mul_add(r[2], t[3 * a + 1].mul_add(r[1], t[3 * a].mul(r[0])));
    [row(0), row(1), row(2)]
}

/// Product of symmetric matrices that commute, which is symmetric.
#[inline(always)]
fn product<V: Lanes>(a: &Symmetric<V>, b: &Symmetric<V>) -> Symmetric<V> {
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
fn times<V: Lanes>(a: &[V; 9], b: &[V; 9]) -> [V; 9] {
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
fn between<V: Lanes>(a: &Symmetric<V>, t: &[V; 9], b: &Symmetric<V>) -> [V; 9] {
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

/// The inverse of a matrix, and what the matrix times it gives, both of which fade out where its
/// eigenvalues are small.
struct Faded<V> {
    inverse: Symmetric<V>,
    one: Symmetric<V>,
}

/// `(1 + e⁴) (M⁴ + e⁴ I)⁻¹ M³` and its product with M, of `fade = e⁴`.
#[inline(always)]
fn faded<V: Lanes>(m: &Symmetric<V>, fade: f64) -> Faded<V> {
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

/// What the first sweep sums over pairs.
struct PlainSums<V> {
    /// `L₀` (1/s).
    gradient: [V; 9],
    /// `M`.
    moment: Symmetric<V>,
    /// `Σ w_ij (v_j − v_i)` with `w_ij = −V_j r |∇W_ij|`.
    velocity: [V; 3],
    /// `Σ w_ij (x_i − x_j)`.
    place: [V; 3],
    /// `Σ w_ij`.
    weight: V,
}

/// Parts of a motion.
struct Motion<V> {
    /// The velocity gradient (1/s): `D + W`.
    gradient: [V; 9],
    /// Mean velocity of the neighbours that no linear field explains (m/s).
    rest: [V; 3],
}

/// The motion whose strain rate D is that of the `corrected` gradient and whose spin W is that of
/// the neighbourhood: `W M + M W` is twice the antisymmetric part of `L₀ − D M`, so that the angular
/// velocity is `(tr M I − M)⁻¹` times its axial vector, as an inertia to an angular momentum.
/// Neighbours are expected to move by `W + (L₀ − W M) B`.
#[inline(always)]
fn motion<V: Lanes>(corrected: &[V; 9], plain: &PlainSums<V>, inner: &Symmetric<V>) -> Motion<V> {
    let half = V::splat(0.5);
    let mean = |a: usize, b: usize| corrected[a].add(corrected[b]).mul(half);
    let strain = [
        corrected[0],
        corrected[4],
        corrected[8],
        mean(1, 3),
        mean(2, 6),
        mean(5, 7),
    ];
    let moment = full(&plain.moment);
    let explained = times(&full(&strain), &moment);
    let left = |a: usize| plain.gradient[a].sub(explained[a]);
    let axial = [
        left(7).sub(left(5)),
        left(2).sub(left(6)),
        left(3).sub(left(1)),
    ];
    let [xx, yy, zz, xy, xz, yz] = plain.moment;
    let zero = V::splat(0.0);
    let inertia = [
        yy.add(zz),
        xx.add(zz),
        xx.add(yy),
        zero.sub(xy),
        zero.sub(xz),
        zero.sub(yz),
    ];
    let [x, y, z] = along(&full(&faded(&inertia, SPIN_FADE).inverse), &axial);
    let spin = [
        zero,
        zero.sub(z),
        y,
        z,
        zero,
        zero.sub(x),
        zero.sub(y),
        x,
        zero,
    ];
    let turned = times(&spin, &moment);
    let mut stretch = plain.gradient;
    for c in 0..9 {
        stretch[c] = stretch[c].sub(turned[c]);
    }
    let mut expected = times(&stretch, &full(inner));
    let mut gradient = full(&strain);
    for c in 0..9 {
        expected[c] = expected[c].add(spin[c]);
        gradient[c] = gradient[c].add(spin[c]);
    }
    let linear = along(&expected, &plain.place);
    // A particle alone has no weight.
    let weight = plain.weight.min(V::splat(-f64::MIN_POSITIVE));
    let rest = |a: usize| plain.velocity[a].add(linear[a]).div(weight);
    Motion {
        gradient,
        rest: [rest(0), rest(1), rest(2)],
    }
}

/// The corrections of eight particles; components xx, yy, zz, xy, xz, yz.
#[derive(Debug, Clone, Copy)]
pub struct Correction {
    /// `A`.
    pub outer: [F64x8; 6],
    /// `B`.
    pub inner: [F64x8; 6],
}

impl Correction {
    /// From moments `M`.
    #[inline(always)]
    #[must_use]
    pub fn new<V: Lanes>(m: &[F64x8; 6]) -> Self {
        let m = [0, 1, 2, 3, 4, 5].map(|c: usize| V::load(&m[c]));
        let Faded { inverse, one } = faded(&m, FADE);
        Self {
            outer: one.map(V::store),
            inner: inverse.map(V::store),
        }
    }

    /// `A T B` of a matrix in each lane, row-major.
    #[inline(always)]
    #[must_use]
    pub fn apply<V: Lanes>(&self, t: &[V; 9]) -> [V; 9] {
        let load = |all: &[F64x8; 6]| [0, 1, 2, 3, 4, 5].map(|c: usize| V::load(&all[c]));
        between(&load(&self.outer), t, &load(&self.inner))
    }

    /// `P = A σ B` of lane `k` (Pa, row-major), from pressure and deviatoric stress (Pa; components
    /// xx, yy, zz, xy, xz, yz).
    #[inline(always)]
    #[must_use]
    pub fn stress(&self, k: usize, pressure: f64, deviatoric: &[f64; 6]) -> [f64; 9] {
        let [xx, yy, zz, xy, xz, yz] = *deviatoric;
        let sigma = [
            xx - pressure,
            xy,
            xz,
            xy,
            yy - pressure,
            yz,
            xz,
            yz,
            zz - pressure,
        ];
        let lane = |m: &[F64x8; 6]| FULL.map(|c: usize| m[c].0[k]);
        matrix::product(
            &matrix::product(&lane(&self.outer), &sigma),
            &lane(&self.inner),
        )
    }
}

/// Adds the moments of pairs at `r = x_i − x_j` with `∇W = factor r`; gives V ∇W.
#[inline(always)]
fn add_moment<V: Lanes>(moment: &mut [V; 6], r: &[V; 3], factor: V) -> [V; 3] {
    let steep = [r[0].mul(factor), r[1].mul(factor), r[2].mul(factor)];
    for a in 0..3 {
        moment[a] = r[a].neg_mul_add(steep[a], moment[a]);
    }
    moment[3] = r[0].neg_mul_add(steep[1], moment[3]);
    moment[4] = r[0].neg_mul_add(steep[2], moment[4]);
    moment[5] = r[1].neg_mul_add(steep[2], moment[5]);
    steep
}

/// The first sweep over the pairs of eight receivers.
pub struct CorrectedGradient<'a, S> {
    /// The receivers and their neighbours.
    pub around: Neighbourhood<'a, S>,
    /// Number of dimensions.
    pub dimension: usize,
    /// Bit k: receiver k takes no correction.
    pub plain: u8,
}

/// What [`CorrectedGradient`] gives.
#[derive(Debug, Clone, Copy)]
pub struct Corrected {
    /// Row-major `L` (1/s).
    pub gradient: [F64x8; 9],
    /// Mean velocity of the neighbours against the particle that no linear field explains (m/s).
    pub rest: [F64x8; 3],
    /// The corrections.
    pub correction: Correction,
}

impl<S: PairScale> Vectorised for CorrectedGradient<'_, S> {
    type Output = Corrected;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Corrected {
        let mut plain = self.sums::<V>();
        for axis in self.dimension..3 {
            plain.moment[axis] = V::splat(1.0);
        }
        let mut m = plain.moment.map(V::store);
        if self.plain != 0 {
            for k in (0..LANES).filter(|k| self.plain >> k & 1 == 1) {
                for (c, value) in [1.0, 1.0, 1.0, 0.0, 0.0, 0.0].into_iter().enumerate() {
                    m[c].0[k] = value;
                }
            }
        }
        let correction = Correction::new::<V>(&m);
        let corrected = correction.apply(&plain.gradient);
        let inner = [0, 1, 2, 3, 4, 5].map(|c: usize| V::load(&correction.inner[c]));
        let motion = motion(&corrected, &plain, &inner);
        Corrected {
            gradient: motion.gradient.map(V::store),
            rest: motion.rest.map(V::store),
            correction,
        }
    }
}

impl<S: PairScale> CorrectedGradient<'_, S> {
    #[inline(always)]
    fn sums<V: Lanes>(&self) -> PlainSums<V> {
        let zero = V::splat(0.0);
        let (position, velocity) = self.around.motion::<V>();
        let mut sums = PlainSums {
            gradient: [zero; 9],
            moment: [zero; 6],
            velocity: [zero; 3],
            place: [zero; 3],
            weight: zero,
        };
        for pair in self.around.pairs(&position) {
            let (here, r) = (pair.source, pair.separation.r);
            let volume = V::splat(here.volume);
            let factor = pair.separation.inverse.mul(volume).mul(pair.kernel.slope);
            let steep = add_moment(&mut sums.moment, &r, factor);
            let weight = factor.mul(pair.separation.square);
            sums.weight = sums.weight.add(weight);
            for a in 0..3 {
                let v_a = V::splat(here.velocity[a]).sub(velocity[a]);
                sums.velocity[a] = v_a.mul_add(weight, sums.velocity[a]);
                sums.place[a] = r[a].mul_add(weight, sums.place[a]);
                for b in 0..3 {
                    let sum = &mut sums.gradient[3 * a + b];
                    *sum = v_a.mul_add(steep[b], *sum);
                }
            }
        }
        sums
    }
}

/// What a particle shows to its neighbours of its stress.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct CorrectedRecord {
    /// `P`, row-major (Pa).
    pub stress: [f64; 9],
    /// `ξ ρ c²` times the hourglass displacement (Pa m).
    pub hourglass: [f64; 3],
    /// Density (kg/m³).
    pub density: f64,
    /// Sound speed (m/s).
    pub sound_speed: f64,
}

impl CorrectedRecord {
    /// From `P` (Pa), hourglass displacement (m) and its stiffness ξ, density (kg/m³) and sound
    /// speed (m/s).
    #[inline(always)]
    #[must_use]
    pub fn new(
        stress: &[f64; 9],
        displacement: &[f64; 3],
        stiffness: f64,
        [density, sound_speed]: [f64; 2],
    ) -> Self {
        let modulus = stiffness * density * sound_speed * sound_speed;
        Self {
            stress: *stress,
            hourglass: [
                modulus * displacement[0],
                modulus * displacement[1],
                modulus * displacement[2],
            ],
            density,
            sound_speed,
        }
    }
}

impl PairStress for CorrectedRecord {
    const CORRECTED: bool = true;

    #[inline(always)]
    fn is_free(&self) -> bool {
        self.stress == [0.0; 9] && self.hourglass == [0.0; 3]
    }

    /// `V_i ε : P_i Σ V_j (x_j − x_i) ⊗ ∇W_ij`: with all neighbours P M is symmetric.
    #[inline(always)]
    fn couple<V: Lanes, S: PairScale>(around: &Neighbourhood<S>, stresses: &[Self]) -> [F64x8; 3] {
        let (position, _) = around.motion::<V>();
        let mut moment = [V::splat(0.0); 6];
        for pair in around.pairs(&position) {
            let volume = V::splat(pair.source.volume);
            let factor = pair.separation.inverse.mul(volume).mul(pair.kernel.slope);
            add_moment(&mut moment, &pair.separation.r, factor);
        }
        let moment = moment.map(V::store);
        let mut couple = [F64x8([0.0; LANES]); 3];
        for (k, &place) in around.receivers.iter().enumerate() {
            let volume = around.sources.records[place as usize].volume;
            let lane = FULL.map(|c: usize| moment[c].0[k]);
            let pm = matrix::product(&stresses[place as usize].stress, &lane);
            for (a, [c, b]) in [[7, 5], [2, 6], [3, 1]].into_iter().enumerate() {
                couple[a].0[k] = volume * (pm[c] - pm[b]);
            }
        }
        couple
    }

    /// `dv/dt = 1/ρ_i Σ V_j (P_i + P_j − ρ_i ρ_j (Π_ij I + R_ij f⁴)) ∇W_ij`.
    #[inline(always)]
    fn sum<V: Lanes, S: PairScale, const TERMS: u8>(sums: &Momentum<S, Self, TERMS>) -> Forces {
        let around = &sums.around;
        // A particle whose position is NaN.
        if around.neighbours.is_empty() {
            return Forces::NONE;
        }
        let zero = V::splat(0.0);
        let (position, velocity) = around.motion::<V>();
        let own = records(sums.stresses, &around.receivers);
        let row = |a: usize| gather3::<V, _>(&own, |record, b| record.stress[3 * a + b]);
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = [row(0), row(1), row(2)];
        let stress = [xx, xy, xz, yx, yy, yz, zx, zy, zz];
        let hourglass = gather3::<V, _>(&own, |record, a| record.hourglass[a]);
        let motion = records(around.sources.records, &around.receivers);
        let specific_volume = gather::<V, _>(&motion, |record| record.volume / record.mass);
        let viscous = Viscous::<V>::begin(
            sums.viscosity,
            gather(&own, |record| record.density),
            gather(&own, |record| record.sound_speed),
        );
        let mut terms = TermSums::<V, TERMS>::begin(&sums.terms, &around.receivers);
        let (mut acceleration, mut power, mut fastest) = ([zero; 3], zero, zero);
        for pair in around.pairs(&position) {
            let (source, separation, kernel) = (pair.source, &pair.separation, &pair.kernel);
            let state = &sums.stresses[pair.index];
            let shown = sums.terms.record::<TERMS>(pair.index);
            let r = separation.r;
            let against = |a: usize| velocity[a].sub(V::splat(source.velocity[a]));
            let v = [against(0), against(1), against(2)];
            let now = viscous.pair(
                &terms,
                (separation, kernel.h),
                &v,
                (state.density, state.sound_speed),
                shown,
            );
            fastest = fastest.min_where_positive(now.mu, kernel.inside);
            let both = viscous.rho.mul(V::splat(state.density));
            let pi = now.pi.mul(both);
            // Viscosity strains by the plain relative velocity, stress does by L.
            let lost = zero.sub(pi.mul(now.approach));
            // Hourglass displacements against each other pull or push along the pair.
            let against = |a: usize| hourglass[a].sub(V::splat(state.hourglass[a]));
            let bent = r[2].mul_add(against(2), r[1].mul_add(against(1), r[0].mul(against(0))));
            let pull = bent.mul(separation.inverse).mul(separation.inverse);
            let closing = r[2].mul_add(v[2], r[1].mul_add(v[1], r[0].mul(v[0])));
            let mut lost = pull.mul_add(closing, lost);
            let central = pull.sub(pi);
            let mut push = [central, central, central, zero, zero, zero];
            if TERMS & SHAPED != 0 {
                let shape = around.sources.scale.shape(kernel);
                if TERMS & ARTIFICIAL_STRESS != 0 {
                    let mut extra = [zero; 6];
                    terms.repel(&mut extra, shown, shape);
                    for c in 0..6 {
                        extra[c] = extra[c].mul(both);
                        push[c] = push[c].add(extra[c]);
                    }
                    let t = along(&full(&extra), &r);
                    lost = t[2].mul_add(v[2], t[1].mul_add(v[1], t[0].mul_add(v[0], lost)));
                }
                let w = around.sources.scale.value(kernel, shape);
                let w = w.mul(V::splat(source.mass));
                terms.follow(&v, w.mul(now.inverse_density));
            }
            lost = terms.conduct(lost, shown, || now.heat_speed(separation).mul(both));
            let weight = separation
                .inverse
                .mul(V::splat(source.volume))
                .mul(kernel.slope);
            power = lost.mul_add(weight, power);
            let mut total = stress;
            for c in 0..9 {
                total[c] = total[c].add(V::splat(state.stress[c]));
                if c % 4 == 0 || TERMS & ARTIFICIAL_STRESS != 0 {
                    total[c] = total[c].add(push[FULL[c]]);
                }
            }
            let traction = along(&total, &r);
            for a in 0..3 {
                acceleration[a] = traction[a].mul_add(weight, acceleration[a]);
            }
        }
        Forces {
            acceleration: acceleration.map(|a| a.mul(specific_volume).store()),
            power: zero
                .sub(power.mul(V::splat(0.5)).mul(specific_volume))
                .store(),
            approach: zero.sub(fastest).store(),
            correction: terms.correction().map(V::store),
        }
    }
}
