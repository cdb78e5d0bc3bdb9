//! Normalised SPH: Shepard's kernel with a corrected gradient, exact for linear fields on any cloud
//! (Randles & Libersky 1996; Vignjevic, Campbell & Libersky 2000), and forces that are its adjoint
//! (after Bonet & Lok 1999).
//!
//! With `s = Σ V W` (over the particle itself too) and `γ = Σ V ∇W / s`, the gradient of `W/s` is
//! `(∇W − γ W)/s`, and
//!
//! `∇ᶜW_ij = B_iᵀ (∇W_ij − γ_i W_ij)`, `B_i = [Σ V_j (x_j − x_i) ⊗ (∇W_ij − γ_i W_ij)]⁻¹`:
//! the factor `1/s` drops out. All of it is linear in sums over pairs, so one sweep makes the
//! corrected velocity gradient; only the forces need the corrections of neighbours.

mod forces;

pub use forces::NormalisedRecord;

use super::neighbourhood::Neighbourhood;
use numerics::dispatch::Vectorised;
use numerics::kernel::PairScale;
use numerics::lane_matrix::store_all;
use numerics::lanes::{F64x8, LANES, Lanes};
use numerics::matrix::adjugate;

/// Corrections that enlarge gradients more than so are left out: the particle has too few
/// neighbours, or they stand in a plane or a row. Corners of lattices have 2 to 3.
pub const LARGEST_CORRECTION: f64 = 10.0;

/// Sums of one receiver over its neighbours, itself included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// `s = Σ V_j W_ij`.
    pub kernel: f64,
    /// `Σ V_j ∇W_ij` (1/m).
    pub slope: [f64; 3],
    /// `Σ V_j (x_j − x_i) W_ij` (m).
    pub first: [f64; 3],
    /// `Σ V_j (x_j − x_i) ⊗ ∇W_ij`, components xx, yy, zz, xy, xz, yz.
    pub second: [f64; 6],
}

/// The correction of one particle's gradients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correction {
    /// `B`, row-major.
    pub matrix: [f64; 9],
    /// `γ` (1/m).
    pub shift: [f64; 3],
    /// `s ‖B‖/√d`: 1 for nothing to correct, 0 where the correction is left out.
    pub norm: f64,
}

impl Correction {
    /// None.
    pub const NONE: Self = Self {
        matrix: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        shift: [0.0; 3],
        norm: 0.0,
    };
}

impl Moments {
    /// The correction, none where it were larger than [`LARGEST_CORRECTION`].
    #[inline(always)]
    #[must_use]
    pub fn correction(&self, dimension: usize) -> Correction {
        let [xx, yy, zz, xy, xz, yz] = self.second;
        let mut m = [xx, xy, xz, xy, yy, yz, xz, yz, zz];
        let mut shift = [0.0; 3];
        for b in 0..3 {
            shift[b] = self.slope[b] / self.kernel;
            for a in 0..3 {
                m[3 * a + b] -= self.first[a] * shift[b];
            }
        }
        for a in dimension..3 {
            m[4 * a] = 1.0;
        }
        let (mut matrix, determinant) = adjugate(&m);
        let inverse = 1.0 / determinant;
        let mut square = 0.0;
        for a in 0..3 {
            for b in 0..3 {
                matrix[3 * a + b] *= inverse;
                if a < dimension && b < dimension {
                    square += matrix[3 * a + b] * matrix[3 * a + b];
                }
            }
        }
        let norm = self.kernel * (square / f64::from([1_u8, 1, 2, 3][dimension])).sqrt();
        // Also false for what is NaN.
        if determinant > 0.0 && norm <= LARGEST_CORRECTION {
            Correction {
                matrix,
                shift,
                norm,
            }
        } else {
            Correction::NONE
        }
    }
}

/// The sums over pairs.
pub struct NormalisedGradient<'a, S> {
    /// The receivers and their neighbours.
    pub around: Neighbourhood<'a, S>,
    /// Number of dimensions.
    pub dimension: usize,
}

/// Result of [`NormalisedGradient`].
#[derive(Debug, Clone, Copy)]
pub struct Corrected {
    /// Row-major `L_i = Σ V_j (v_j − v_i) ⊗ ∇ᶜW_ij` (1/s).
    pub gradient: [F64x8; 9],
    /// The corrections.
    pub corrections: [Correction; LANES],
}

impl Corrected {
    /// Of particles without neighbours, as those of rigid bodies are.
    pub const NONE: Self = Self {
        gradient: [F64x8([0.0; LANES]); 9],
        corrections: [Correction {
            norm: 1.0,
            ..Correction::NONE
        }; LANES],
    };
}

impl<S: PairScale> Vectorised for NormalisedGradient<'_, S> {
    type Output = Corrected;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Corrected {
        let around = &self.around;
        // A particle whose position is NaN.
        if around.neighbours.is_empty() {
            return Corrected::NONE;
        }
        let (position, velocity) = around.motion::<V>();
        let zero = V::splat(0.0);
        // Σ V v_ji ⊗ ∇W, Σ V v_ji W, and with −x_ij in place of v_ji; Σ V ∇W, Σ V W.
        let (mut gradient, mut drift) = ([zero; 9], [zero; 3]);
        let (mut second, mut first) = ([zero; 6], [zero; 3]);
        let (mut slope, mut mass) = ([zero; 3], zero);
        for pair in around.pairs(&position) {
            let (here, kernel) = (pair.source, &pair.kernel);
            let volume = V::splat(here.volume);
            let factor = pair.separation.inverse.mul(volume).mul(kernel.slope);
            let share = around
                .sources
                .scale
                .value(kernel, around.sources.scale.shape(kernel));
            let share = share.mul(volume);
            let r = pair.separation.r;
            let steep = [r[0].mul(factor), r[1].mul(factor), r[2].mul(factor)];
            for a in 0..3 {
                let v_a = V::splat(here.velocity[a]).sub(velocity[a]);
                drift[a] = v_a.mul_add(share, drift[a]);
                for b in 0..3 {
                    gradient[3 * a + b] = v_a.mul_add(steep[b], gradient[3 * a + b]);
                }
                first[a] = r[a].neg_mul_add(share, first[a]);
                second[a] = r[a].neg_mul_add(steep[a], second[a]);
                slope[a] = slope[a].add(steep[a]);
            }
            second[3] = r[0].neg_mul_add(steep[1], second[3]);
            second[4] = r[0].neg_mul_add(steep[2], second[4]);
            second[5] = r[1].neg_mul_add(steep[2], second[5]);
            mass = mass.add(share);
        }
        let sums = Sums {
            gradient: store_all(&gradient),
            drift: store_all(&drift),
            second: store_all(&second),
            first: store_all(&first),
            slope: store_all(&slope),
            kernel: mass.store(),
        };
        sums.correct(self.dimension)
    }
}

/// The sums of eight receivers.
struct Sums {
    gradient: [F64x8; 9],
    drift: [F64x8; 3],
    second: [F64x8; 6],
    first: [F64x8; 3],
    slope: [F64x8; 3],
    kernel: F64x8,
}

impl Sums {
    #[inline(always)]
    fn correct(&self, dimension: usize) -> Corrected {
        let mut all = Corrected::NONE;
        for k in 0..LANES {
            let three = |lanes: &[F64x8; 3]| [lanes[0].0[k], lanes[1].0[k], lanes[2].0[k]];
            let s = |c: usize| self.second[c].0[k];
            let moments = Moments {
                kernel: self.kernel.0[k],
                slope: three(&self.slope),
                first: three(&self.first),
                second: [s(0), s(1), s(2), s(3), s(4), s(5)],
            };
            let correction = moments.correction(dimension);
            let (b, shift) = (&correction.matrix, &correction.shift);
            for a in 0..3 {
                let drift = self.drift[a].0[k];
                let row = |c: usize| self.gradient[3 * a + c].0[k] - drift * shift[c];
                let row = [row(0), row(1), row(2)];
                for c in 0..3 {
                    all.gradient[3 * a + c].0[k] =
                        row[0] * b[c] + row[1] * b[3 + c] + row[2] * b[6 + c];
                }
            }
            all.corrections[k] = correction;
        }
        all
    }
}

/// Power of the stress on its own particle, `σ : L/ρ` (W/kg): what its forces take from the
/// kinetic energy, since they are the adjoint of `L`. From pressure and deviatoric stress (Pa), the
/// velocity gradient (1/s) and the density (kg/m³) that volumes in the sums belong to.
#[inline]
#[must_use]
pub fn stress_power(pressure: f64, deviatoric: &[f64; 6], l: &[f64; 9], density: f64) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = *deviatoric;
    let normal = (xx - pressure) * l[0] + (yy - pressure) * l[4] + (zz - pressure) * l[8];
    let shear = xy * (l[1] + l[3]) + xz * (l[2] + l[6]) + yz * (l[5] + l[7]);
    (normal + shear) / density
}
