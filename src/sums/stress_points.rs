//! Stress points (Dyka & Ingel 1995; Randles & Libersky 2000; Vignjevic, Campbell & Libersky 2000):
//! velocities live on particles, stress on points between them.
//!
//! Forces are the adjoint of the gradients of [`super::linear_fit`]: `f_a = −Σ_s w Q_s (x_a −
//! x̄_s)`, `Q = V_s σ_s M_s⁻¹`.

use super::linear_fit::{NORM, weight};
use super::momentum::Viscosity;
use super::neighbourhood::Neighbourhood;
use super::principal::tensile_part;
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::store_all;
use numerics::lanes::{F64x8, Lanes};

/// Record of a stress point that velocity particles read.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct StressPointRecord {
    /// `Q = V σ M⁻¹`, row-major (N/m in three dimensions).
    pub moment: [f64; 9],
    /// `Q (x̄ − x_s)` (N).
    pub offset: [f64; 3],
    /// Density (kg/m³).
    pub density: f64,
    /// Energy that it takes over from velocity particles, over the sum of weights (J).
    pub heat: f64,
}

/// `Q` and `Q (x̄ − x_s)` from the stress `σ` (Pa; xx, yy, zz, xy, xz, yz), the volume (m^d) and
/// the fit's `M⁻¹` (1/m², row-major) and `x̄ − x_s` (m).
#[must_use]
pub fn moment(
    stress: &[f64; 6],
    volume: f64,
    inverse: &[f64; 9],
    offset: &[f64; 3],
) -> ([f64; 9], [f64; 3]) {
    let [xx, yy, zz, xy, xz, yz] = *stress;
    let sigma = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let (mut moment, mut shift) = ([0.0; 9], [0.0; 3]);
    for a in 0..3 {
        for c in 0..3 {
            let along = |b: usize| sigma[a][b] * inverse[3 * b + c];
            let value = volume * (along(0) + along(1) + along(2));
            moment[3 * a + c] = value;
            shift[a] += value * offset[c];
        }
    }
    (moment, shift)
}

/// Eight velocity particles with the stress points about them.
pub struct Pull<'a, S> {
    /// The particles and the points.
    pub around: Neighbourhood<'a, S>,
    /// Records of all particles and images that are stress points.
    pub points: &'a [StressPointRecord],
}

/// Result of [`Pull`].
#[derive(Debug, Clone, Copy)]
pub struct Pulled {
    /// `f_a = −Σ_s w Q_s (x_a − x̄_s)` (N).
    pub force: [F64x8; 3],
    /// `Σ w ρ_s/Σ w` (kg/m³); NaN without stress points.
    pub density: F64x8,
    /// Energy that stress points take over (J).
    pub heat: F64x8,
}

impl<S: PairScale> Vectorised for Pull<'_, S> {
    type Output = Pulled;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Pulled {
        let around = &self.around;
        let (position, _) = around.motion::<V>();
        let zero = V::splat(0.0);
        let (mut force, mut mass, mut heat, mut all) = ([zero; 3], zero, zero, zero);
        for pair in around.pairs(&position) {
            let point = &self.points[pair.index];
            let w = weight(&around.sources.scale, &pair.kernel);
            let r = pair.separation.r;
            for a in 0..3 {
                let q = |c: usize| V::splat(point.moment[3 * a + c]);
                let pull = r[0].mul_add(q(0), zero.sub(V::splat(point.offset[a])));
                let pull = r[2].mul_add(q(2), r[1].mul_add(q(1), pull));
                force[a] = pull.neg_mul_add(w, force[a]);
            }
            mass = V::splat(point.density).mul_add(w, mass);
            heat = V::splat(point.heat).mul_add(w, heat);
            all = all.add(w);
        }
        Pulled {
            force: store_all(&force),
            density: mass.div(all).store(),
            heat: heat.store(),
        }
    }
}

/// Artificial viscosity from the velocity gradient (1/s): the stress (Pa; xx, yy, zz, xy, xz, yz)
///
/// `−½ ρ h (α c E + β h E²)`, `E = Σ_a ⟨−D_a⟩₊ n_a ⊗ n_a`
///
/// over the principal rates of strain `D_a`, which resists compression along any direction, and the
/// approach speed `h ‖E‖` (m/s). It is what Monaghan's viscosity tends to in one dimension as the
/// spacing falls; it always heats, since `E : D ≤ 0`. From density (kg/m³), sound speed (m/s) and
/// smoothing length (m).
#[must_use]
pub fn viscous_stress(
    l: &[f64; 9],
    density: f64,
    sound_speed: f64,
    h: f64,
    viscosity: &Viscosity,
) -> ([f64; 6], f64) {
    let shear = |a: usize, b: usize| -0.5 * (l[a] + l[b]);
    let [xx, yy, zz, xy, xz, yz] =
        tensile_part(&[-l[0], -l[4], -l[8], shear(1, 3), shear(2, 6), shear(5, 7)]);
    let square = [
        xx * xx + xy * xy + xz * xz,
        xy * xy + yy * yy + yz * yz,
        xz * xz + yz * yz + zz * zz,
        xx * xy + xy * yy + xz * yz,
        xx * xz + xy * yz + xz * zz,
        xy * xz + yy * yz + yz * zz,
    ];
    let scale = -0.5 * density * h;
    let (linear, quadratic) = (viscosity.alpha * sound_speed, viscosity.beta * h);
    let rates = [xx, yy, zz, xy, xz, yz];
    let mut stress = [0.0; 6];
    for c in 0..6 {
        stress[c] = scale * (linear * rates[c] + quadratic * square[c]);
    }
    (stress, h * (square[0] + square[1] + square[2]).sqrt())
}

/// `h/Δt` (m/s) of the longest stable step where gradients have this
/// [norm](super::linear_fit::Fit::norm), from the sound speed (m/s) and the approach speed
/// `h ‖E‖` (m/s).
///
/// A lattice has waves of up to `ω = √(2/d) c √(Σ |G|²)`: a wave along one of its d axes strains
/// the points on that axis alone, which have 1/d of the volume. In one dimension it is `2c/Δp`.
/// Viscosity damps them by `ζ = ¼ (α c + 2 β h ‖E‖) h ω/c²`, and their velocity is known half a
/// step late: `ω Δt ≤ 2 (√(1 + ζ²) − ζ)`.
#[inline(always)]
#[must_use]
pub fn signal(
    norm: f64,
    sound_speed: f64,
    approach: f64,
    viscosity: &Viscosity,
    dimension: usize,
) -> f64 {
    // √(2/d)
    let share = [0.0, std::f64::consts::SQRT_2, 1.0, 0.816_496_580_927_726][dimension];
    // h ω/c and c ζ
    let frequency = share / NORM * norm;
    let braked = viscosity.alpha * sound_speed + 2.0 * viscosity.beta * approach;
    let damping = 0.25 * frequency * braked;
    0.5 * frequency * ((sound_speed * sound_speed + damping * damping).sqrt() + damping)
}
