//! Conservative momentum equation with its compatible energy equation and Monaghan–Gingold
//! viscosity (physics page, section 2).

use super::dispatch::Vectorised;
use super::gradient::SMALLEST_SQUARE;
use super::kernel::{PairScale, slope_over_distance};
use super::lanes::{F64x8, LANES, Lanes};

/// What a particle shows to its neighbours for the forces: two cache lines.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(128))]
pub struct ForceRecord {
    /// Position (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Mass (kg).
    pub mass: f64,
    /// Smoothing length (m).
    pub smoothing_length: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Sound speed (m/s).
    pub sound_speed: f64,
    /// `σ/ρ²`, components xx, yy, zz, xy, xz, yz (Pa m⁶/kg²).
    pub stress_over_density2: [f64; 6],
}

/// Coefficients of the Monaghan–Gingold viscosity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// Linear coefficient α.
    pub alpha: f64,
    /// Quadratic coefficient β.
    pub beta: f64,
}

/// The receivers of one cluster with their neighbours; sums in the order of `neighbours`.
///
/// `MIRRORED` clusters have images behind symmetry planes among their neighbours and also sum
/// what those alone exert.
pub struct Momentum<'a, S, const MIRRORED: bool> {
    /// All particles and images.
    pub sources: &'a [ForceRecord],
    /// 1 for images behind symmetry planes, 0 for particles.
    pub mirrored: &'a [f64],
    /// Receivers; unused lanes repeat a valid one.
    pub receivers: [u32; LANES],
    /// Neighbours, in canonical order, those of all receivers together.
    pub neighbours: &'a [u32],
    /// Smoothing length of pairs.
    pub scale: S,
    /// Artificial viscosity.
    pub viscosity: Viscosity,
}

/// The sums of [`Momentum`].
#[derive(Debug, Clone, Copy)]
pub struct Forces {
    /// `dv/dt = Σ m_j (σ_i/ρ_i² + σ_j/ρ_j² − Π_ij I) ∇W_ij` (m/s²).
    pub acceleration: [F64x8; 3],
    /// `de/dt = −½ Σ m_j v_ij · (pair stress) · ∇W_ij` (W/kg).
    pub power: F64x8,
    /// Largest approach speed `|μ_ij|` (m/s).
    pub approach: F64x8,
    /// The part of `acceleration` that images behind symmetry planes exert (m/s²); zero unless
    /// `MIRRORED`.
    pub from_mirrors: [F64x8; 3],
}

impl<S: PairScale, const MIRRORED: bool> Vectorised for Momentum<'_, S, MIRRORED> {
    type Output = Forces;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Forces {
        let receiver = |k: usize| &self.sources[self.receivers[k] as usize];
        let position: [V; 3] = std::array::from_fn(|a| V::gather(|k| receiver(k).position[a]));
        let velocity: [V; 3] = std::array::from_fn(|a| V::gather(|k| receiver(k).velocity[a]));
        let stress: [V; 6] =
            std::array::from_fn(|c| V::gather(|k| receiver(k).stress_over_density2[c]));
        let h_i = V::gather(|k| receiver(k).smoothing_length);
        let rho_i = V::gather(|k| receiver(k).density);
        let c_i = V::gather(|k| receiver(k).sound_speed);
        let zero = V::splat(0.0);
        let (alpha, beta) = (
            V::splat(0.5 * self.viscosity.alpha),
            V::splat(self.viscosity.beta),
        );
        let mut acceleration = [zero; 3];
        let mut from_mirrors = [zero; 3];
        let mut power = zero;
        let mut fastest = zero;
        for &j in self.neighbours {
            let source = &self.sources[j as usize];
            let r: [V; 3] = std::array::from_fn(|a| position[a].sub(V::splat(source.position[a])));
            let v: [V; 3] = std::array::from_fn(|a| velocity[a].sub(V::splat(source.velocity[a])));
            let square = r[2].mul_add(r[2], r[1].mul_add(r[1], r[0].mul(r[0])));
            let square = square.max(V::splat(SMALLEST_SQUARE));
            let distance = square.sqrt();
            let (inverse_h, h, factor) = self.scale.scale(h_i, source.smoothing_length);
            let soft = h.mul(h).mul_add(V::splat(0.01), square);
            let rho_sum = rho_i.add(V::splat(source.density));
            // One division serves 1/r, 1/(r² + 0.01 h²) and 1/(ρ_i + ρ_j).
            let soft_rho = soft.mul(rho_sum);
            let inverse = V::splat(1.0).div(distance.mul(soft_rho));
            let inverse_r = inverse.mul(soft_rho);
            let over_distance = inverse.mul(distance);
            let slope = slope_over_distance(distance, inverse_r, inverse_h, factor);
            // μ = h v·r/(r² + 0.01 h²) for approaching pairs.
            let approach = r[2]
                .mul_add(v[2], r[1].mul_add(v[1], r[0].mul(v[0])))
                .min(zero);
            let mu = h.mul(approach).mul(over_distance.mul(rho_sum));
            // Π = μ (β μ − α c̄)/ρ̄ with c̄ = ½ c_sum and ρ̄ = ½ rho_sum.
            let linear = c_i.add(V::splat(source.sound_speed)).mul(alpha);
            let inverse_rho_sum = over_distance.mul(soft);
            let pi = mu
                .mul(mu.mul(beta).sub(linear))
                .mul(inverse_rho_sum.add(inverse_rho_sum));
            let inside = V::splat(2.0).sub(distance.mul(inverse_h));
            fastest = fastest.max(zero.sub(mu).where_positive(inside));
            let s: [V; 6] =
                std::array::from_fn(|c| stress[c].add(V::splat(source.stress_over_density2[c])));
            let (xx, yy, zz) = (s[0].sub(pi), s[1].sub(pi), s[2].sub(pi));
            let weight = slope.mul(V::splat(source.mass));
            let force = [
                xx.mul_add(r[0], s[3].mul_add(r[1], s[4].mul(r[2])))
                    .mul(weight),
                s[3].mul_add(r[0], yy.mul_add(r[1], s[5].mul(r[2])))
                    .mul(weight),
                s[4].mul_add(r[0], s[5].mul_add(r[1], zz.mul(r[2])))
                    .mul(weight),
            ];
            let work = force[2].mul_add(v[2], force[1].mul_add(v[1], force[0].mul(v[0])));
            power = work.mul_add(V::splat(-0.5), power);
            for a in 0..3 {
                acceleration[a] = acceleration[a].add(force[a]);
            }
            if MIRRORED {
                let mirrored = V::splat(self.mirrored[j as usize]);
                for a in 0..3 {
                    from_mirrors[a] = force[a].mul_add(mirrored, from_mirrors[a]);
                }
            }
        }
        Forces {
            acceleration: acceleration.map(V::store),
            power: power.store(),
            approach: fastest.store(),
            from_mirrors: from_mirrors.map(V::store),
        }
    }
}
