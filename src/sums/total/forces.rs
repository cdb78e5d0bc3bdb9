//! The second sweep of the total form.

use super::pairs::{Pairs, columns};
use crate::momentum::{Forces, Momentum, PairStress, Viscosity, soft};
use crate::neighbourhood::{Neighbourhood, SMALLEST_SQUARE, gather, gather_all, records};
use numerics::kernel::PairScale;
use numerics::lane_matrix::{along, dot, store_all};
use numerics::lanes::{F64x8, LANES, Lanes};
use numerics::matrix;

/// Strain of a pair against deformation gradients up to which there is none: what rounding leaves of it.
const LEAST_STRAIN: f64 = 1e-12;

/// Record of the stress of a particle that its neighbours read.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
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
    /// Half the deformation gradient, row-major.
    pub half_deformation: [f64; 9],
}

impl TotalRecord {
    /// Stress of the hourglass control (Pa) along the line to another particle, tension positive, where the two were
    /// `apart` (m) and are now `r` (m).
    #[must_use]
    pub fn pull(&self, other: &Self, apart: &[f64; 3], r: &[f64; 3]) -> f64 {
        let mean = |c: usize| self.half_deformation[c] + other.half_deformation[c];
        let expected = |a: usize| (0..3).map(|b| mean(3 * a + b) * apart[b]).sum::<f64>();
        let square: f64 = r.iter().map(|x| x * x).sum();
        let beyond: f64 = (0..3).map(|a| r[a] * (r[a] - expected(a))).sum();
        let strain = beyond / square;
        (self.hourglass + other.hourglass) * (strain - strain.clamp(-LEAST_STRAIN, LEAST_STRAIN))
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

    /// `dv/dt = V⁰_i/m_i Σ V⁰_j ((Q_i + Q_j) ∇W_ij − ρ_i ρ_j Π_ij |∇W_ij| x_ij/|x_ij|)`; no pair term acts.
    #[inline(always)]
    fn sum<V: Lanes, S: PairScale, const TERMS: bool>(sums: &Momentum<S, Self, TERMS>) -> Forces {
        let around = &sums.around;
        // A particle whose position is NaN.
        if around.neighbours.is_empty() {
            return Forces::NONE;
        }
        let (zero, one, least) = (V::splat(0.0), V::splat(1.0), V::splat(LEAST_STRAIN));
        let (initial, velocity) = around.motion::<V>();
        let own = records(sums.stresses, &around.receivers);
        let position: [V; 3] = gather_all(&own, |record, a| record.position[a]);
        let hourglass: V = gather(&own, |record| record.hourglass);
        let density: V = gather(&own, |record| record.density);
        let speed: V = gather(&own, |record| record.viscous_speed);
        let deformation: [V; 9] = gather_all(&own, |record, c| record.half_deformation[c]);
        let motion = records(around.sources.records, &around.receivers);
        let specific_volume = gather::<V, _>(&motion, |record| record.volume / record.mass);
        let Viscosity {
            alpha,
            beta,
            negligible,
        } = sums.viscosity;
        let (alpha, twice_beta) = (V::splat(alpha), V::splat(2.0 * beta));
        let rows: &[[[f64; 4]; 6]] = bytemuck::cast_slice(sums.stresses);
        let (mut force, mut slope) = ([zero; 3], [zero; 3]);
        let (mut power, mut fastest) = (zero, zero);
        for pair in Pairs::new(*around, &initial, []) {
            let theirs = records(rows, &pair.places);
            let [x, y, z, f0] = columns(theirs, 3);
            let r = [position[0].sub(x), position[1].sub(y), position[2].sub(z)];
            let mut v = velocity;
            for a in 0..3 {
                v[a] = v[a].sub(pair.velocity[a]);
            }
            let [q8, modulus, their_density, their_speed] = columns(theirs, 2);
            // 1/R, 1/r and 1/((r² + 0.01 h²) (ρ_i + ρ_j)) by one division.
            let (start, kernel) = (pair.distance, &pair.kernel);
            let square = dot(&r, &r).max(V::splat(SMALLEST_SQUARE));
            let distance = square.sqrt();
            let soft = soft(square, pair.h);
            let densities = density.add(their_density);
            let both = soft.mul(densities);
            let start_both = start.mul(both);
            let all = one.div(start_both.mul(distance));
            let of_start = all.mul(distance);
            let (inverse, beside) = (all.mul(start_both), of_start.mul(start));
            // Viscosity, as of all forms: ρ_i ρ_j Π_ij.
            let closing = dot(&r, &v);
            let mu = pair.h.mul(closing);
            let mu = mu
                .mul_add(beside.mul(densities), V::splat(negligible))
                .min(zero);
            fastest = fastest.min_where_positive(mu, kernel.inside);
            let speeds = speed.add(their_speed);
            let signal = speeds.neg_mul_add(alpha, mu.mul(twice_beta));
            let signal = zero.min_where_positive(signal, speeds);
            let share = beside.mul(soft).mul(density.mul(their_density));
            let viscous = mu.mul(share).mul(signal);
            // What the pair is longer than the mean of both deformation gradients makes it, as a strain.
            let ([f1, f2, f3, f4], [f5, f6, f7, f8]) = (columns(theirs, 4), columns(theirs, 5));
            let mut mean = [f0, f1, f2, f3, f4, f5, f6, f7, f8];
            for c in 0..9 {
                mean[c] = mean[c].add(deformation[c]);
            }
            let expected = dot(&r, &along(&mean, &pair.r));
            let strain = expected.neg_mul_add(inverse.mul(inverse), one);
            let strain = strain.sub(strain.min(least).max(zero.sub(least)));
            let central = hourglass.add(modulus).mul_add(strain, zero.sub(viscous));
            let weight = pair.volume.mul(kernel.slope);
            let along_pair = central.mul(weight.mul(inverse));
            power = closing.mul_add(along_pair, power);
            let weight = weight.mul(of_start.mul(both));
            let ([q0, q1, q2, q3], [q4, q5, q6, q7]) = (columns(theirs, 0), columns(theirs, 1));
            let pull = along(&[q0, q1, q2, q3, q4, q5, q6, q7, q8], &pair.r);
            for a in 0..3 {
                slope[a] = pair.r[a].mul_add(weight, slope[a]);
                force[a] = pull[a].mul_add(weight, r[a].mul_add(along_pair, force[a]));
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
            correction: [F64x8([0.0; LANES]); 3],
        }
    }
}
