//! Conservative momentum equation with its compatible energy equation and Monaghan–Gingold
//! viscosity (physics page, section 2).

use super::neighbourhood::{Divisor, Neighbourhood, Separation, gather, gather_all, records};
use super::terms::{PairTerms, TermRecord, TermSums};
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::store_all;
use numerics::lanes::{F64x8, LANES, Lanes};

/// Record of the stress of a particle that its neighbours read: one cache line.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub struct StressRecord {
    /// `σ/ρ²`, components xx, yy, zz, xy, xz, yz (Pa m⁶/kg²).
    pub stress_over_density2: [f64; 6],
    /// Density (kg/m³).
    pub density: f64,
    /// Speed of the artificial viscosity (m/s).
    pub viscous_speed: f64,
}

impl StressRecord {
    /// From pressure (Pa), deviatoric stress (Pa), density (kg/m³) and the speed of the artificial viscosity (m/s).
    #[inline(always)]
    #[must_use]
    pub fn new(pressure: f64, deviatoric: &[f64; 6], density: f64, viscous_speed: f64) -> Self {
        let scale = 1.0 / (density * density);
        let [xx, yy, zz, xy, xz, yz] = *deviatoric;
        Self {
            stress_over_density2: [
                (xx - pressure) * scale,
                (yy - pressure) * scale,
                (zz - pressure) * scale,
                xy * scale,
                xz * scale,
                yz * scale,
            ],
            density,
            viscous_speed,
        }
    }
}

/// Coefficients of the Monaghan–Gingold viscosity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// Linear coefficient α.
    pub alpha: f64,
    /// Quadratic coefficient β.
    pub beta: f64,
    /// Approach μ (m/s) up to which a pair has none.
    pub negligible: f64,
}

/// Stress that particles show to neighbours, and its sums over pairs.
pub trait PairStress: bytemuck::Pod + Send + Sync {
    /// True if the power of stresses on their own particles is no sum over pairs.
    const CORRECTED: bool;

    /// True if there is no stress at all.
    fn is_free(&self) -> bool;

    /// Density (kg/m³).
    fn density(&self) -> f64;

    /// Speed (m/s) of the linear viscosity: that of sound, by the limiter of the form. A pair without any has no
    /// quadratic viscosity either.
    fn viscous_speed(&self) -> f64;

    /// The torque (N m) that pairs of eight receivers exert on each other without these neighbours, where
    /// none is left with them; none where angular momentum is not kept anyway.
    #[must_use]
    fn couple<V: Lanes, S: PairScale>(_: &Neighbourhood<S>, _: &[Self]) -> [F64x8; 3] {
        [F64x8([0.0; LANES]); 3]
    }

    /// The sums of eight receivers.
    fn sum<V: Lanes, S: PairScale, const TERMS: bool>(sums: &Momentum<S, Self, TERMS>) -> Forces;
}

/// Artificial viscosity of eight receivers.
pub(crate) struct Viscous<V> {
    /// Density of the receivers (kg/m³).
    pub rho: V,
    /// `c_i` (m/s).
    speed: V,
    alpha: V,
    twice_beta: V,
    negligible: V,
}

/// Artificial viscosity of pairs.
pub(crate) struct ViscousPair<V> {
    /// `v·r` (m²/s).
    pub closing: V,
    /// `μ` (m/s).
    pub mu: V,
    /// `Π` (m⁵/(kg s²)).
    pub pi: V,
    /// `1/(ρ_i + ρ_j)`.
    pub inverse_density: V,
    /// `2 β μ − α (c_i + c_j)`, limited (m/s).
    signal: V,
}

/// `r² + 0.01 h²` (m²) of pairs.
#[inline(always)]
pub(crate) fn soft<V: Lanes>(square: V, h: V) -> V {
    h.mul(h).mul(V::splat(0.01)).add(square)
}

/// `(r² + 0.01 h²) (ρ_i + ρ_j)`, whose inverse serves those of both.
#[derive(Clone, Copy)]
pub(crate) struct SoftSquare<'a, V, R> {
    /// Density of the receivers (kg/m³).
    pub rho: V,
    /// Stresses of all particles and images.
    pub stresses: &'a [R],
}

impl<V: Lanes, R: PairStress> Divisor<V> for SoftSquare<'_, V, R> {
    #[inline(always)]
    fn of(&self, index: usize, square: V, h: V) -> Option<V> {
        let density = V::splat(self.stresses[index].density());
        Some(soft(square, h).mul(self.rho.add(density)))
    }
}

impl<V: Lanes> Viscous<V> {
    /// Of receivers of these densities (kg/m³) and viscous speeds (m/s).
    #[inline(always)]
    pub fn begin(viscosity: Viscosity, rho: V, speed: V) -> Self {
        Self {
            rho,
            speed,
            alpha: V::splat(viscosity.alpha),
            twice_beta: V::splat(2.0 * viscosity.beta),
            negligible: V::splat(viscosity.negligible),
        }
    }

    /// Of the receivers with a neighbour of this density and viscous speed at the relative velocity
    /// `v`, with the inverse of their [`SoftSquare`]. Their smoothing length comes twice (m): as it is, and by the share of
    /// the viscosity that the pair takes.
    #[inline(always)]
    pub fn pair<const TERMS: bool>(
        &self,
        terms: &TermSums<V, TERMS>,
        (separation, [h, taken], inverse): (&Separation<V>, [V; 2], V),
        v: &[V; 3],
        (density, speed): (f64, f64),
        shown: &TermRecord,
    ) -> ViscousPair<V> {
        let r = &separation.r;
        let soft = soft(separation.square, h);
        let rho_sum = self.rho.add(V::splat(density));
        // μ = h v·r/(r² + 0.01 h²) for approaching pairs.
        let closing = r[2].mul_add(v[2], r[1].mul_add(v[1], r[0].mul(v[0])));
        let mu = taken
            .mul(closing)
            .mul_add(inverse.mul(rho_sum), self.negligible)
            .min(V::splat(0.0));
        // Π = μ (β μ − α c̄)/ρ̄ with c̄ = ½ c_sum and ρ̄ = ½ rho_sum.
        let speeds = self.speed.add(V::splat(speed));
        let signal = speeds.neg_mul_add(self.alpha, mu.mul(self.twice_beta));
        let signal = V::splat(0.0).min_where_positive(signal, speeds);
        let signal = terms.limit(signal, shown);
        let inverse_density = inverse.mul(soft);
        ViscousPair {
            closing,
            mu,
            pi: mu.mul(inverse_density).mul(signal),
            inverse_density,
            signal,
        }
    }
}

impl<V: Lanes> ViscousPair<V> {
    /// Factor of conduction for the difference of energies.
    #[inline(always)]
    pub fn heat_speed(&self, separation: &Separation<V>) -> V {
        let zero = V::splat(0.0);
        let signal = zero.min_where_positive(self.signal, zero.sub(self.mu));
        signal.mul(separation.distance).mul(self.inverse_density)
    }
}

/// The sums over pairs; `TERMS` tells whether there are pair terms.
pub struct Momentum<'a, S, R, const TERMS: bool> {
    /// The receivers and their neighbours.
    pub around: Neighbourhood<'a, S>,
    /// Stresses of all particles and images.
    pub stresses: &'a [R],
    /// Artificial viscosity.
    pub viscosity: Viscosity,
    /// The pair terms in use, and what they need.
    pub terms: PairTerms<'a>,
}

/// The sums of [`Momentum`].
#[derive(Debug, Clone, Copy)]
pub struct Forces {
    /// `dv/dt = Σ m_j (σ_i/ρ_i² + σ_j/ρ_j² − Π_ij I + R_ij f⁴) ∇W_ij` (m/s²); in the normalised
    /// form the stresses stand in [`super::normalised`] instead.
    pub acceleration: [F64x8; 3],
    /// `de/dt = −½ Σ m_j v_ij · (pair stress) · ∇W_ij` and conduction (W/kg); in the normalised
    /// form without the power of `σ`.
    pub power: F64x8,
    /// Largest approach speed `|μ_ij|` (m/s).
    pub approach: F64x8,
    /// `ε Σ (m_j/ρ̄) (v_j − v_i) W_ij` (m/s); zero without XSPH.
    pub correction: [F64x8; 3],
}

impl Forces {
    /// Forces of particles without relative velocity and stress on each other, to the bit.
    pub const NONE: Self = Self {
        acceleration: [F64x8([0.0; LANES]); 3],
        power: F64x8([0.0; LANES]),
        approach: F64x8([0.0; LANES]),
        correction: [F64x8([0.0; LANES]); 3],
    };
}

impl<S: PairScale, R: PairStress, const TERMS: bool> Vectorised for Momentum<'_, S, R, TERMS> {
    type Output = Forces;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Forces {
        R::sum::<V, S, TERMS>(&self)
    }
}

/// The stress of eight receivers, with that of one neighbour after the other.
pub(crate) trait OwnStress<V: Lanes>: Sized {
    /// Record that particles show.
    type Record: PairStress;
    /// True if it needs the kernel's value.
    const SHAPED: bool;

    /// Of receivers that show this.
    fn begin<S: PairScale>(around: &Neighbourhood<S>, own: &[&Self::Record; LANES]) -> Self;

    /// Part of it that acts, with the viscosity `Π`, over density squared along plain gradients:
    /// components xx, yy, zz, xy, xz, yz (Pa m⁶/kg²).
    fn plain(&self, other: &Self::Record, pi: V) -> [V; 6];

    /// Sums what else there is, of pairs with a neighbour of this volume (m^d) at a separation, with the kernel's slope
    /// and, if that is needed, its value.
    fn pull(&mut self, other: &Self::Record, now: (&Separation<V>, f64), kernel: (V, V));

    /// Adds that to the acceleration.
    fn add_to(&self, acceleration: [V; 3]) -> [V; 3];
}

/// The sums over pairs of such receivers.
#[inline(always)]
pub(crate) fn sum<V: Lanes, S: PairScale, O: OwnStress<V>, const TERMS: bool>(
    sums: &Momentum<S, O::Record, TERMS>,
) -> Forces {
    let around = &sums.around;
    // A particle whose position is NaN.
    if around.neighbours.is_empty() {
        return Forces::NONE;
    }
    let (position, velocity) = around.motion::<V>();
    let stresses = records(sums.stresses, &around.receivers);
    let mut own = O::begin(around, &stresses);
    let rho_i = gather::<V, _>(&stresses, PairStress::density);
    let c_i = gather::<V, _>(&stresses, PairStress::viscous_speed);
    let zero = V::splat(0.0);
    let viscous = Viscous::begin(sums.viscosity, rho_i, c_i);
    let mut terms = TermSums::<V, TERMS>::begin(&sums.terms, &around.receivers);
    let mut acceleration = [zero; 3];
    let mut power = zero;
    let mut fastest = zero;
    let divisor = SoftSquare {
        rho: rho_i,
        stresses: sums.stresses,
    };
    for pair in around.pairs_beside(&position, divisor) {
        let (index, source, now, kernel) =
            (pair.index, pair.source, &pair.separation, &pair.kernel);
        let state = &sums.stresses[index];
        let shown = sums.terms.record::<TERMS>(index);
        let r = now.r;
        let along = |a: usize| velocity[a].sub(V::splat(source.velocity[a]));
        let v = [along(0), along(1), along(2)];
        let state_of = (state.density(), state.viscous_speed());
        let viscous = viscous.pair(&terms, (now, [pair.h; 2], pair.beside), &v, state_of, shown);
        fastest = fastest.min_where_positive(viscous.mu, kernel.inside);
        let mut stress = own.plain(state, viscous.pi);
        if O::SHAPED || terms.need_shape() {
            let scale = &around.sources.scale;
            let shape = scale.shape(kernel);
            terms.repel(&mut stress, shown, shape);
            if O::SHAPED {
                let values = (kernel.slope, scale.value(kernel, shape));
                own.pull(state, (now, source.volume), values);
            }
            let shares = (source.mass, viscous.inverse_density);
            terms.follow(&v, (scale, kernel, shape), shares);
        }
        let [xx, yy, zz, xy, xz, yz] = stress;
        let weight = now.inverse.mul(V::splat(source.mass)).mul(kernel.slope);
        let traction = [
            xx.mul_add(r[0], xy.mul_add(r[1], xz.mul(r[2]))),
            xy.mul_add(r[0], yy.mul_add(r[1], yz.mul(r[2]))),
            xz.mul_add(r[0], yz.mul_add(r[1], zz.mul(r[2]))),
        ];
        let work = traction[2].mul_add(v[2], traction[1].mul_add(v[1], traction[0].mul(v[0])));
        let work = terms.conduct(work, shown, || viscous.heat_speed(now));
        power = work.mul_add(weight, power);
        for a in 0..3 {
            acceleration[a] = traction[a].mul_add(weight, acceleration[a]);
        }
    }
    Forces {
        acceleration: store_all(&own.add_to(acceleration)),
        power: zero.sub(power.mul(V::splat(0.5))).store(),
        approach: zero.sub(fastest).store(),
        correction: store_all(&terms.correction()),
    }
}

/// Stresses that add up.
struct Added<V> {
    normal: [V; 3],
    shear: [V; 3],
}

impl<V: Lanes> OwnStress<V> for Added<V> {
    type Record = StressRecord;
    const SHAPED: bool = false;

    #[inline(always)]
    fn begin<S: PairScale>(_: &Neighbourhood<S>, own: &[&StressRecord; LANES]) -> Self {
        Self {
            normal: gather_all(own, |record, a| record.stress_over_density2[a]),
            shear: gather_all(own, |record, a| record.stress_over_density2[3 + a]),
        }
    }

    #[inline(always)]
    fn plain(&self, other: &StressRecord, pi: V) -> [V; 6] {
        let s = |c: usize| V::splat(other.stress_over_density2[c]);
        let pull = |a: usize| self.normal[a].add(s(a)).sub(pi);
        let slide = |a: usize| self.shear[a].add(s(3 + a));
        [pull(0), pull(1), pull(2), slide(0), slide(1), slide(2)]
    }

    #[inline(always)]
    fn pull(&mut self, _: &StressRecord, _: (&Separation<V>, f64), _: (V, V)) {}

    #[inline(always)]
    fn add_to(&self, acceleration: [V; 3]) -> [V; 3] {
        acceleration
    }
}

impl PairStress for StressRecord {
    const CORRECTED: bool = false;

    #[inline(always)]
    fn is_free(&self) -> bool {
        self.stress_over_density2 == [0.0; 6]
    }

    #[inline(always)]
    fn density(&self) -> f64 {
        self.density
    }

    #[inline(always)]
    fn viscous_speed(&self) -> f64 {
        self.viscous_speed
    }

    #[inline(always)]
    fn sum<V: Lanes, S: PairScale, const TERMS: bool>(sums: &Momentum<S, Self, TERMS>) -> Forces {
        sum::<V, S, Added<V>, TERMS>(sums)
    }
}
