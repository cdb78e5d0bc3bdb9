//! The second sweep: what particles show of their stress, and its forces.

use crate::momentum::{Forces, Momentum, OwnStress, PairStress, sum};
use crate::neighbourhood::{Neighbourhood, Separation, gather, gather_all, records};
use numerics::kernel::PairScale;
use numerics::lanes::{LANES, Lanes};

/// Record of the stress and the correction of a particle that its neighbours read.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct NormalisedRecord {
    /// `P = σ Bᵀ`, row-major (Pa).
    pub stress: [f64; 9],
    /// `P γ` (Pa/m).
    pub shift: [f64; 3],
    /// Density (kg/m³).
    pub density: f64,
    /// Speed of the artificial viscosity (m/s).
    pub viscous_speed: f64,
}

impl NormalisedRecord {
    /// From pressure and deviatoric stress (Pa), `B` and `γ` (1/m), density (kg/m³) and the speed of the
    /// artificial viscosity (m/s).
    #[must_use]
    pub fn new(
        (pressure, deviatoric): (f64, &[f64; 6]),
        matrix: &[f64; 9],
        shift: &[f64; 3],
        [density, viscous_speed]: [f64; 2],
    ) -> Self {
        let [xx, yy, zz, xy, xz, yz] = *deviatoric;
        let sigma = [
            [xx - pressure, xy, xz],
            [xy, yy - pressure, yz],
            [xz, yz, zz - pressure],
        ];
        let mut record = Self {
            stress: [0.0; 9],
            shift: [0.0; 3],
            density,
            viscous_speed,
        };
        for a in 0..3 {
            for c in 0..3 {
                let along = |b: usize| sigma[a][b] * matrix[3 * c + b];
                let stress = along(0) + along(1) + along(2);
                record.stress[3 * a + c] = stress;
                record.shift[a] += stress * shift[c];
            }
        }
        record
    }
}

/// Stresses along corrected gradients:
/// `1/ρ_i Σ V_j [(P_i + P_j) ∇W_ij − W_ij (P_i γ_i − P_j γ_j)]`.
struct Corrected<V> {
    stress: [V; 9],
    shift: [V; 3],
    /// `1/ρ_i`.
    specific_volume: V,
    sum: [V; 3],
}

impl<V: Lanes> OwnStress<V> for Corrected<V> {
    type Record = NormalisedRecord;
    const SHAPED: bool = true;

    #[inline(always)]
    fn begin<S: PairScale>(around: &Neighbourhood<S>, own: &[&NormalisedRecord; LANES]) -> Self {
        let motion = records(around.sources.records, &around.receivers);
        Self {
            stress: gather_all(own, |record, c| record.stress[c]),
            shift: gather_all(own, |record, a| record.shift[a]),
            specific_volume: gather(&motion, |record| record.volume / record.mass),
            sum: [V::splat(0.0); 3],
        }
    }

    #[inline(always)]
    fn plain(&self, _: &NormalisedRecord, pi: V) -> [V; 6] {
        let zero = V::splat(0.0);
        let pull = zero.sub(pi);
        [pull, pull, pull, zero, zero, zero]
    }

    #[inline(always)]
    fn pull(
        &mut self,
        other: &NormalisedRecord,
        (now, volume): (&Separation<V>, f64),
        (slope, value): (V, V),
    ) {
        let volume = V::splat(volume);
        let weight = now.inverse.mul(volume).mul(slope);
        let share = value.mul(volume);
        let r = now.r;
        for a in 0..3 {
            let both = |b: usize| self.stress[3 * a + b].add(V::splat(other.stress[3 * a + b]));
            let traction = both(2).mul_add(r[2], both(1).mul_add(r[1], both(0).mul(r[0])));
            let step = self.shift[a].sub(V::splat(other.shift[a]));
            self.sum[a] = step.neg_mul_add(share, traction.mul_add(weight, self.sum[a]));
        }
    }

    #[inline(always)]
    fn add_to(&self, acceleration: [V; 3]) -> [V; 3] {
        let [x, y, z] = acceleration;
        [
            self.sum[0].mul_add(self.specific_volume, x),
            self.sum[1].mul_add(self.specific_volume, y),
            self.sum[2].mul_add(self.specific_volume, z),
        ]
    }
}

impl PairStress for NormalisedRecord {
    const CORRECTED: bool = true;

    #[inline(always)]
    fn is_free(&self) -> bool {
        self.stress == [0.0; 9] && self.shift == [0.0; 3]
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
        sum::<V, S, Corrected<V>, TERMS>(sums)
    }
}
