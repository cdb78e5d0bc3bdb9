//! The second sweep of the total form.

use crate::momentum::{Forces, Momentum, PairStress, Viscous, soft};
use crate::neighbourhood::{
    Divisor, Neighbourhood, SMALLEST_SQUARE, Separation, gather, gather_all, records,
};
use crate::terms::TermSums;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{along, dot, store_all};
use numerics::lanes::{F64x8, LANES, Lanes};
use numerics::matrix;

/// Strain of a pair against deformation gradients up to which there is none: what rounding leaves of it.
const LEAST_STRAIN: f64 = 1e-12;

/// Record of the stress of a particle that its neighbours read.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct TotalRecord {
    /// `Q`, row-major (Pa).
    pub stress: [f64; 9],
    /// Modulus of the hourglass control (Pa).
    pub hourglass: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Sound speed by the limiter of the linear viscosity (m/s).
    pub viscous_speed: f64,
    /// Position (m).
    pub position: [f64; 3],
    /// Deformation gradient, row-major.
    pub deformation: [f64; 9],
}

impl TotalRecord {
    /// Stress of the hourglass control (Pa) along the line to another particle, tension positive, where the two were
    /// `apart` (m) and are now `r` (m).
    #[must_use]
    pub fn pull(&self, other: &Self, apart: &[f64; 3], r: &[f64; 3]) -> f64 {
        let mean = |c: usize| 0.5 * (self.deformation[c] + other.deformation[c]);
        let expected = |a: usize| (0..3).map(|b| mean(3 * a + b) * apart[b]).sum::<f64>();
        let square: f64 = r.iter().map(|x| x * x).sum();
        let beyond: f64 = (0..3).map(|a| r[a] * (r[a] - expected(a))).sum();
        let strain = beyond / square;
        (self.hourglass + other.hourglass) * (strain - strain.clamp(-LEAST_STRAIN, LEAST_STRAIN))
    }
}

/// Distances now times `(r² + 0.01 h²) (ρ_i + ρ_j)`, whose inverse serves both.
#[derive(Clone, Copy)]
struct Apart<'a, V> {
    /// Positions of the receivers (m).
    position: [V; 3],
    /// Their densities (kg/m³).
    rho: V,
    /// Stresses of all particles and images.
    stresses: &'a [TotalRecord],
}

/// How far eight receivers are from one neighbour now.
#[derive(Clone, Copy)]
struct ApartNow<V> {
    /// `r²` (m²), not below [`SMALLEST_SQUARE`].
    square: V,
    /// `r` (m).
    distance: V,
    /// `(r² + 0.01 h²) (ρ_i + ρ_j)` (kg/m).
    soft: V,
}

impl<V: Lanes> Divisor<V> for Apart<'_, V> {
    type Parts = ApartNow<V>;

    #[inline(always)]
    fn before(&self) -> ApartNow<V> {
        ApartNow {
            square: self.rho,
            distance: self.rho,
            soft: self.rho,
        }
    }

    #[inline(always)]
    fn of(&self, index: usize, _: V, h: V) -> (Option<V>, ApartNow<V>) {
        let state = &self.stresses[index];
        let mut r = self.position;
        for a in 0..3 {
            r[a] = r[a].sub(V::splat(state.position[a]));
        }
        let square = dot(&r, &r).max(V::splat(SMALLEST_SQUARE));
        let distance = square.sqrt();
        let soft = soft(square, h).mul(self.rho.add(V::splat(state.density)));
        let parts = ApartNow {
            square,
            distance,
            soft,
        };
        (Some(distance.mul(soft)), parts)
    }
}

impl PairStress for TotalRecord {
    const CORRECTED: bool = true;

    #[inline(always)]
    fn is_free(&self) -> bool {
        self.stress == [0.0; 9] && self.hourglass == 0.0
    }

    #[inline(always)]
    fn density(&self) -> f64 {
        self.density
    }

    #[inline(always)]
    fn viscous_speed(&self) -> f64 {
        self.viscous_speed
    }

    /// `V⁰_i ε : Q_i (Σ V⁰_j (x_j − x_i) ⊗ ∇W_ij)ᵀ`: with all neighbours Q F₀ᵀ is symmetric.
    #[inline(always)]
    fn couple<V: Lanes, S: PairScale>(around: &Neighbourhood<S>, stresses: &[Self]) -> [F64x8; 3] {
        let (initial, _) = around.motion::<V>();
        let own = records(stresses, &around.receivers);
        let position: [V; 3] = gather_all(&own, |record, a| record.position[a]);
        let mut moment = [V::splat(0.0); 9];
        for pair in around.pairs(&initial) {
            let volume = V::splat(pair.source.volume);
            let factor = pair.separation.inverse.mul(volume).mul(pair.kernel.slope);
            let there = &stresses[pair.index].position;
            for a in 0..3 {
                let steep = pair.separation.r[a].mul(factor);
                for b in 0..3 {
                    let x = V::splat(there[b]).sub(position[b]);
                    moment[3 * a + b] = x.mul_add(steep, moment[3 * a + b]);
                }
            }
        }
        let moment = store_all(&moment);
        let mut couple = [F64x8([0.0; LANES]); 3];
        for (k, &place) in around.receivers.iter().enumerate() {
            let volume = around.sources.records[place as usize].volume;
            let mut lane = [0.0; 9];
            for c in 0..9 {
                lane[c] = moment[c].0[k];
            }
            let pm = matrix::product(&stresses[place as usize].stress, &lane);
            for (a, [c, b]) in [[7, 5], [2, 6], [3, 1]].into_iter().enumerate() {
                couple[a].0[k] = volume * (pm[c] - pm[b]);
            }
        }
        couple
    }

    /// `dv/dt = V⁰_i/m_i Σ V⁰_j ((Q_i + Q_j) ∇W_ij − ρ_i ρ_j Π_ij |∇W_ij| x_ij/|x_ij|)`.
    #[inline(always)]
    fn sum<V: Lanes, S: PairScale, const TERMS: bool>(sums: &Momentum<S, Self, TERMS>) -> Forces {
        let around = &sums.around;
        // A particle whose position is NaN.
        if around.neighbours.is_empty() {
            return Forces::NONE;
        }
        let (zero, least) = (V::splat(0.0), V::splat(LEAST_STRAIN));
        let (initial, velocity) = around.motion::<V>();
        let own = records(sums.stresses, &around.receivers);
        let position: [V; 3] = gather_all(&own, |record, a| record.position[a]);
        let hourglass: V = gather(&own, |record| record.hourglass);
        let deformation: [V; 9] = gather_all(&own, |record, c| record.deformation[c]);
        let motion = records(around.sources.records, &around.receivers);
        let specific_volume = gather::<V, _>(&motion, |record| record.volume / record.mass);
        let viscous = Viscous::<V>::begin(
            sums.viscosity,
            gather(&own, |record| record.density),
            gather(&own, |record| record.viscous_speed),
        );
        let terms = TermSums::<V, TERMS>::begin(&sums.terms, &around.receivers);
        let (mut force, mut slope) = ([zero; 3], [zero; 3]);
        let (mut power, mut fastest) = (zero, zero);
        let divisor = Apart {
            position,
            rho: viscous.rho,
            stresses: sums.stresses,
        };
        for pair in around.pairs_beside(&initial, divisor) {
            let (source, kernel) = (pair.source, &pair.kernel);
            let state = &sums.stresses[pair.index];
            let shown = sums.terms.record::<TERMS>(pair.index);
            let (mut r, mut v) = (position, velocity);
            for a in 0..3 {
                r[a] = r[a].sub(V::splat(state.position[a]));
                v[a] = v[a].sub(V::splat(source.velocity[a]));
            }
            let ApartNow {
                square,
                distance,
                soft,
            } = pair.parts;
            let density = V::splat(state.density);
            let (inverse, beside) = (pair.beside.mul(soft), pair.beside.mul(distance));
            let separation = Separation {
                r,
                square,
                distance,
                inverse,
            };
            let now = viscous.pair(
                &terms,
                (&separation, [pair.h; 2], beside),
                &v,
                (state.density, state.viscous_speed),
                shown,
            );
            fastest = fastest.min_where_positive(now.mu, kernel.inside);
            let pi = now.pi.mul(viscous.rho.mul(density));
            // What the pair is longer than the mean of both deformation gradients makes it, as a strain.
            let mut mean = deformation;
            for c in 0..9 {
                mean[c] = mean[c].add(V::splat(state.deformation[c]));
            }
            let expected = along(&mean, &pair.separation.r);
            let mut beyond = r;
            for a in 0..3 {
                beyond[a] = expected[a].neg_mul_add(V::splat(0.5), r[a]);
            }
            let strain = dot(&r, &beyond).mul(inverse).mul(inverse);
            let strain = strain.sub(strain.min(least).max(zero.sub(least)));
            let modulus = hourglass.add(V::splat(state.hourglass));
            let central = modulus.mul_add(strain, zero.sub(pi));
            let weight = V::splat(source.volume).mul(kernel.slope);
            let along_pair = central.mul(weight.mul(inverse));
            power = now.closing.mul_add(along_pair, power);
            let weight = weight.mul(pair.separation.inverse);
            for a in 0..3 {
                force[a] = r[a].mul_add(along_pair, force[a]);
            }
            for b in 0..3 {
                let steep = pair.separation.r[b].mul(weight);
                slope[b] = slope[b].add(steep);
                for a in 0..3 {
                    force[a] = V::splat(state.stress[3 * a + b]).mul_add(steep, force[a]);
                }
            }
        }
        let stress: [V; 9] = gather_all(&own, |record, c| record.stress[c]);
        let of_own = along(&stress, &slope);
        let mut acceleration = force;
        for a in 0..3 {
            acceleration[a] = force[a].add(of_own[a]).mul(specific_volume);
        }
        Forces {
            acceleration: store_all(&acceleration),
            power: zero
                .sub(power.mul(V::splat(0.5)).mul(specific_volume))
                .store(),
            approach: zero.sub(fastest).store(),
            correction: store_all(&terms.correction()),
        }
    }
}
