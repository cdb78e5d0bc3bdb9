//! Velocity gradient `L_i = −Σ_j V_j v_ij ⊗ ∇W_ij` (physics page, section 2).

use super::dispatch::Vectorised;
use super::kernel::{PairScale, slope_over_distance};
use super::lanes::{F64x8, LANES, Lanes};

/// What a particle shows to its neighbours before the forces: one cache line.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct MotionRecord {
    /// Position (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Volume m/ρ (m^d).
    pub volume: f64,
    /// Smoothing length (m).
    pub smoothing_length: f64,
}

/// Squares of distances are never smaller than this (m²), so that a particle meeting itself
/// divides by something: it then adds an exact zero since its `r_ij` is zero.
pub const SMALLEST_SQUARE: f64 = 1e-60;

/// The receivers of one cluster with their neighbours; sums in the order of `neighbours`.
pub struct VelocityGradient<'a, S> {
    /// All particles and images.
    pub sources: &'a [MotionRecord],
    /// Receivers; unused lanes repeat a valid one.
    pub receivers: [u32; LANES],
    /// Neighbours, in canonical order, those of all receivers together.
    pub neighbours: &'a [u32],
    /// Smoothing length of pairs.
    pub scale: S,
}

impl<S: PairScale> Vectorised for VelocityGradient<'_, S> {
    /// Row-major `L` (1/s).
    type Output = [F64x8; 9];

    #[inline(always)]
    fn run<V: Lanes>(self) -> [F64x8; 9] {
        let receiver = |k: usize| &self.sources[self.receivers[k] as usize];
        let position: [V; 3] = std::array::from_fn(|a| V::gather(|k| receiver(k).position[a]));
        let velocity: [V; 3] = std::array::from_fn(|a| V::gather(|k| receiver(k).velocity[a]));
        let h_i = V::gather(|k| receiver(k).smoothing_length);
        let mut gradient = [V::splat(0.0); 9];
        for &j in self.neighbours {
            let source = &self.sources[j as usize];
            let r: [V; 3] = std::array::from_fn(|a| position[a].sub(V::splat(source.position[a])));
            let square = r[2].mul_add(r[2], r[1].mul_add(r[1], r[0].mul(r[0])));
            let square = square.max(V::splat(SMALLEST_SQUARE));
            let distance = square.sqrt();
            let inverse_r = V::splat(1.0).div(distance);
            let (inverse_h, _, factor) = self.scale.scale(h_i, source.smoothing_length);
            let slope = slope_over_distance(distance, inverse_r, inverse_h, factor);
            let weight = slope.mul(V::splat(-source.volume));
            for a in 0..3 {
                let v_a = velocity[a].sub(V::splat(source.velocity[a])).mul(weight);
                for b in 0..3 {
                    gradient[3 * a + b] = v_a.mul_add(r[b], gradient[3 * a + b]);
                }
            }
        }
        gradient.map(V::store)
    }
}
