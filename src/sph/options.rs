//! Options of the momentum and energy sums, each off unless a case asks for it.
//!
//! A set of options is a constant of the sums' type, so that those of a case without options hold
//! no trace of them.

use super::neighbourhood::{gather, gather3, records};
use super::principal::tensile_part;
use super::records::NormalisedRecord;
use crate::numerics::lanes::{LANES, Lanes};

/// Artificial stress (Monaghan 2000; Gray, Monaghan & Swift 2001).
pub const ARTIFICIAL_STRESS: u8 = 1;
/// The Balsara switch on artificial viscosity (Balsara 1995).
pub const BALSARA: u8 = 2;
/// Artificial conduction between approaching particles (Noh 1987; Monaghan 1997).
pub const CONDUCTION: u8 = 4;
/// XSPH (Monaghan 1989).
pub const XSPH: u8 = 8;
/// Stress along corrected gradients: [`super::normalised`].
pub const NORMALISED: u8 = 16;

/// The options that need the kernel's value.
pub(super) const SHAPED: u8 = ARTIFICIAL_STRESS | XSPH | NORMALISED;
/// The options for which particles show an [`OptionRecord`].
pub const RECORDED: u8 = ARTIFICIAL_STRESS | BALSARA | CONDUCTION;

/// What a particle shows to its neighbours for the options: one cache line.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub struct OptionRecord {
    /// `R`, components xx, yy, zz, xy, xz, yz (Pa m⁶/kg²).
    pub repulsion: [f64; 6],
    /// Half the factor of the Balsara switch.
    pub half_limiter: f64,
    /// Specific internal energy (J/kg).
    pub specific_energy: f64,
}

impl OptionRecord {
    /// What changes nothing.
    pub const NEUTRAL: Self = Self {
        repulsion: [0.0; 6],
        half_limiter: 0.5,
        specific_energy: 0.0,
    };
}

/// Coefficients of the options, and what particles show for them.
#[derive(Debug, Clone, Copy)]
pub struct Options<'a> {
    /// Records of all particles and images; empty without options that show any.
    pub records: &'a [OptionRecord],
    /// Stresses with corrections of all particles and images; empty without [`NORMALISED`].
    pub normalised: &'a [NormalisedRecord],
    /// `1/w(Δp/h)`, with `w = W h^d/σ_d`.
    pub inverse_shape: f64,
    /// Coefficient `α_u` of the conduction.
    pub conduction: f64,
    /// Factor ε of XSPH.
    pub xsph: f64,
}

impl Options<'_> {
    /// No options.
    pub const NONE: Self = Self {
        records: &[],
        normalised: &[],
        inverse_shape: 0.0,
        conduction: 0.0,
        xsph: 0.0,
    };

    /// What the particle or image at a place shows for a set of options.
    #[inline(always)]
    pub(super) fn record<const OPTIONS: u8>(&self, place: usize) -> &OptionRecord {
        if OPTIONS & RECORDED == 0 {
            &OptionRecord::NEUTRAL
        } else {
            &self.records[place]
        }
    }

    /// The same of [`NORMALISED`].
    #[inline(always)]
    pub(super) fn normalised<const OPTIONS: u8>(&self, place: usize) -> &NormalisedRecord {
        if OPTIONS & NORMALISED == 0 {
            &NormalisedRecord::FREE
        } else {
            &self.normalised[place]
        }
    }
}

/// Artificial stress over density squared (Pa m⁶/kg²), `R = −ε Σ_a ⟨σ_a⟩₊ n_a ⊗ n_a/ρ²` over the
/// principal stresses `σ_a` and directions `n_a` (Gray, Monaghan & Swift 2001): a pressure along
/// each direction in tension. From the factor ε, pressure and deviatoric stress (Pa) and density
/// (kg/m³).
#[must_use]
pub fn repulsion(epsilon: f64, pressure: f64, deviatoric: &[f64; 6], density: f64) -> [f64; 6] {
    let [xx, yy, zz, xy, xz, yz] = *deviatoric;
    let stress = [xx - pressure, yy - pressure, zz - pressure, xy, xz, yz];
    let scale = -epsilon / (density * density);
    tensile_part(&stress).map(|x| scale * x)
}

/// The Balsara switch `|∇·v|/(|∇·v| + |∇×v| + 10⁻⁴ c/h)` (Balsara 1995): one in compression, zero
/// in shear. From the velocity gradient (1/s, row-major), sound speed (m/s) and smoothing length
/// (m).
#[must_use]
pub fn limiter(l: &[f64; 9], sound_speed: f64, h: f64) -> f64 {
    let divergence = (l[0] + l[4] + l[8]).abs();
    let curl = [l[7] - l[5], l[2] - l[6], l[3] - l[1]];
    let curl = (curl[0] * curl[0] + curl[1] * curl[1] + curl[2] * curl[2]).sqrt();
    let all = divergence + curl + 1e-4 * sound_speed / h;
    // A rigid body has neither strain nor sound.
    divergence / all.max(f64::MIN_POSITIVE)
}

/// What eight receivers show for a set of options, and what they sum for it.
pub(super) struct OptionSums<V, const OPTIONS: u8> {
    normal: [V; 3],
    shear: [V; 3],
    half_limiter: V,
    energy: V,
    inverse_shape: V,
    conduction: V,
    xsph: V,
    correction: [V; 3],
}

impl<V: Lanes, const OPTIONS: u8> OptionSums<V, OPTIONS> {
    #[inline(always)]
    pub(super) fn begin(options: &Options, places: &[u32; LANES]) -> Self {
        let none = [&OptionRecord::NEUTRAL; LANES];
        let all = if OPTIONS & RECORDED == 0 {
            none
        } else {
            records(options.records, places)
        };
        Self {
            normal: gather3(&all, |record, a| record.repulsion[a]),
            shear: gather3(&all, |record, a| record.repulsion[3 + a]),
            half_limiter: gather(&all, |record| record.half_limiter),
            energy: gather(&all, |record| record.specific_energy),
            inverse_shape: V::splat(options.inverse_shape),
            conduction: V::splat(2.0 * options.conduction),
            xsph: V::splat(-2.0 * options.xsph),
            correction: [V::splat(0.0); 3],
        }
    }

    /// The viscosity's signal speed with the Balsara switch.
    #[inline(always)]
    pub(super) fn limit(&self, signal: V, other: &OptionRecord) -> V {
        signal.mul(self.half_limiter.add(V::splat(other.half_limiter)))
    }

    /// Adds `(R_i + R_j) f⁴` to the stress (xx, yy, zz, xy, xz, yz) of pairs of a `shape`.
    #[inline(always)]
    pub(super) fn repel(&self, stress: &mut [V; 6], other: &OptionRecord, shape: V) {
        if OPTIONS & ARTIFICIAL_STRESS == 0 {
            return;
        }
        let f = shape.mul(self.inverse_shape);
        let square = f.mul(f);
        let weight = square.mul(square);
        for a in 0..3 {
            let normal = self.normal[a].add(V::splat(other.repulsion[a]));
            stress[a] = normal.mul_add(weight, stress[a]);
            let shear = self.shear[a].add(V::splat(other.repulsion[3 + a]));
            stress[3 + a] = shear.mul_add(weight, stress[3 + a]);
        }
    }

    /// Sums `v_ij` times the `share` `m_j W/(ρ_i + ρ_j)`.
    #[inline(always)]
    pub(super) fn follow(&mut self, v: &[V; 3], share: V) {
        if OPTIONS & XSPH == 0 {
            return;
        }
        for a in 0..3 {
            self.correction[a] = v[a].mul_add(share, self.correction[a]);
        }
    }

    /// `2 α_u (e_i − e_j)` (J/kg).
    #[inline(always)]
    pub(super) fn flow(&self, other: &OptionRecord) -> V {
        let step = self.energy.sub(V::splat(other.specific_energy));
        step.mul(self.conduction)
    }

    /// `ε Σ (m_j/ρ̄) (v_j − v_i) W_ij` (m/s).
    #[inline(always)]
    pub(super) fn correction(&self) -> [V; 3] {
        let [x, y, z] = self.correction;
        [x.mul(self.xsph), y.mul(self.xsph), z.mul(self.xsph)]
    }
}
