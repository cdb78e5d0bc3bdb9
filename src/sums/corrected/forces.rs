//! The second sweep: what particles show of their stress, and its forces.

use super::add_moment;
use crate::momentum::{Forces, Momentum, PairStress, SoftSquare, Viscous};
use crate::neighbourhood::{Neighbourhood, gather, gather_all, records};
use crate::terms::TermSums;
use numerics::kernel::PairScale;
use numerics::lane_matrix::{FULL, along, dot, full, store_all};
use numerics::lanes::{F64x8, LANES, Lanes};
use numerics::matrix;

/// Record of the stress of a particle that its neighbours read.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct CorrectedRecord {
    /// `P`, row-major (Pa).
    pub stress: [f64; 9],
    /// `ξ ρ c²` times the hourglass displacement (Pa m).
    pub hourglass: [f64; 3],
    /// Density (kg/m³).
    pub density: f64,
    /// Speed of the artificial viscosity (m/s).
    pub viscous_speed: f64,
    /// Share of the artificial viscosity.
    pub viscous_share: f64,
}

impl CorrectedRecord {
    /// From `P` (Pa), hourglass displacement (m) and its stiffness ξ, density (kg/m³), sound speed
    /// (m/s), and speed (m/s) and share of the artificial viscosity.
    #[inline(always)]
    #[must_use]
    pub fn new(
        stress: &[f64; 9],
        displacement: &[f64; 3],
        stiffness: f64,
        [density, sound_speed, viscous_speed, viscous_share]: [f64; 4],
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
            viscous_speed,
            viscous_share,
        }
    }
}

impl PairStress for CorrectedRecord {
    const CORRECTED: bool = true;

    #[inline(always)]
    fn is_free(&self) -> bool {
        self.stress == [0.0; 9] && self.hourglass == [0.0; 3]
    }

    #[inline(always)]
    fn density(&self) -> f64 {
        self.density
    }

    #[inline(always)]
    fn viscous_speed(&self) -> f64 {
        self.viscous_speed
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
        let moment = store_all(&moment);
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
    fn sum<V: Lanes, S: PairScale, const TERMS: bool>(sums: &Momentum<S, Self, TERMS>) -> Forces {
        let around = &sums.around;
        // A particle whose position is NaN.
        if around.neighbours.is_empty() {
            return Forces::NONE;
        }
        let zero = V::splat(0.0);
        let (position, velocity) = around.motion::<V>();
        let own = records(sums.stresses, &around.receivers);
        let hourglass: [V; 3] = gather_all(&own, |record, a| record.hourglass[a]);
        let share: V = gather(&own, |record| record.viscous_share);
        let motion = records(around.sources.records, &around.receivers);
        let specific_volume = gather::<V, _>(&motion, |record| record.volume / record.mass);
        let viscous = Viscous::<V>::begin(
            sums.viscosity,
            gather(&own, |record| record.density),
            gather(&own, |record| record.viscous_speed),
        );
        let mut terms = TermSums::<V, TERMS>::begin(&sums.terms, &around.receivers);
        // Σ V_j ∇W_ij, which takes the own stress at the end.
        let mut slope = [zero; 3];
        let (mut force, mut power, mut fastest) = ([zero; 3], zero, zero);
        let divisor = SoftSquare {
            rho: viscous.rho,
            stresses: sums.stresses,
        };
        for pair in around.pairs_beside(&position, divisor) {
            let (source, separation, kernel) = (pair.source, &pair.separation, &pair.kernel);
            let state = &sums.stresses[pair.index];
            let shown = sums.terms.record::<TERMS>(pair.index);
            let r = separation.r;
            let (there, bent) = (pair.velocity(), pair.vector(&state.hourglass));
            let mut v = velocity;
            let mut bend = hourglass;
            for a in 0..3 {
                v[a] = v[a].sub(there[a]);
                bend[a] = bend[a].sub(bent[a]);
            }
            let taken = share.max(V::splat(state.viscous_share)).mul(pair.h);
            let now = viscous.pair(
                &terms,
                (separation, [pair.h, taken], pair.beside),
                &v,
                (state.density, state.viscous_speed),
                shown,
            );
            fastest = fastest.min_where_positive(now.mu, kernel.inside);
            let both = viscous.rho.mul(V::splat(state.density));
            let pi = now.pi.mul(both);
            // Hourglass displacements against each other pull or push along the pair, as viscosity does.
            // Both strain by the plain relative velocity, stress does by L.
            let pull = dot(&r, &bend).mul(separation.inverse);
            let central = pull.mul_add(separation.inverse, zero.sub(pi));
            let mut lost = central.mul(now.closing);
            let weight = separation.inverse.mul(pair.volume()).mul(kernel.slope);
            let shows = pair.tensor(&state.stress);
            let steep = [r[0].mul(weight), r[1].mul(weight), r[2].mul(weight)];
            if terms.need_shape() {
                let scale = &around.sources.scale;
                let shape = scale.shape(kernel);
                if terms.repels() {
                    let mut extra = [zero; 6];
                    terms.repel(&mut extra, shown, shape);
                    for part in &mut extra {
                        *part = part.mul(both);
                    }
                    let t = along(&full(&extra), &r);
                    for a in 0..3 {
                        force[a] = t[a].mul_add(weight, force[a]);
                        lost = t[a].mul_add(v[a], lost);
                    }
                }
                let shares = (source.mass, now.inverse_density);
                terms.follow(&v, (scale, kernel, shape), shares);
            }
            lost = terms.conduct(lost, shown, || now.heat_speed(separation).mul(both));
            power = lost.mul_add(weight, power);
            for a in 0..3 {
                slope[a] = slope[a].add(steep[a]);
                for b in 0..3 {
                    let stress = shows[3 * a + b];
                    let stress = if a == b { stress.add(central) } else { stress };
                    force[a] = stress.mul_add(steep[b], force[a]);
                }
            }
        }
        Neighbourhood::<S>::mirror(&mut slope);
        Neighbourhood::<S>::mirror(&mut force);
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
