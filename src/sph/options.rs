//! Options of the momentum and energy sums, each off unless a case asks for it.
//!
//! A set of options is a constant of the sums' type, so that those of a case without options hold
//! no trace of them.

use super::gradient::{gather, gather3, records};
use super::lanes::{LANES, Lanes};
use super::principal::tensile_part;

/// Artificial stress (Monaghan 2000; Gray, Monaghan & Swift 2001).
pub const ARTIFICIAL_STRESS: u8 = 1;
/// The Balsara switch on artificial viscosity (Balsara 1995).
pub const BALSARA: u8 = 2;
/// Artificial conduction between approaching particles (Noh 1987; Monaghan 1997).
pub const CONDUCTION: u8 = 4;
/// XSPH (Monaghan 1989).
pub const XSPH: u8 = 8;

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
    /// Records of all particles and images; empty without [`RECORDED`] options.
    pub records: &'a [OptionRecord],
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
        inverse_shape: 0.0,
        conduction: 0.0,
        xsph: 0.0,
    };
}

/// Artificial stress over density squared (Pa m⁶/kg²), `R = −ε Σ_a ⟨σ_a⟩₊ n_a ⊗ n_a/ρ²` over the
/// principal stresses σ_a (Gray, Monaghan & Swift 2001): a pressure along each direction in tension. From the
/// factor ε, pressure and deviatoric stress (Pa) and density (kg/m³).
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
    divergence / (divergence + curl + 1e-4 * sound_speed / h)
}

/// What eight receivers show for the options.
pub(super) struct Receivers<V> {
    normal: [V; 3],
    shear: [V; 3],
    pub(super) half_limiter: V,
    energy: V,
}

impl<V: Lanes> Receivers<V> {
    #[inline(always)]
    pub(super) fn gather<const OPTIONS: u8>(
        sources: &[OptionRecord],
        places: &[u32; LANES],
    ) -> Self {
        let none = [&OptionRecord::NEUTRAL; LANES];
        let all = if OPTIONS & RECORDED == 0 {
            none
        } else {
            records(sources, places)
        };
        Self {
            normal: gather3(&all, |record, a| record.repulsion[a]),
            shear: gather3(&all, |record, a| record.repulsion[3 + a]),
            half_limiter: gather(&all, |record| record.half_limiter),
            energy: gather(&all, |record| record.specific_energy),
        }
    }

    /// Adds `(R_i + R_j) f⁴` to the stress (xx, yy, zz, xy, xz, yz) of pairs.
    #[inline(always)]
    pub(super) fn repel(&self, stress: &mut [V; 6], other: &OptionRecord, f: V) {
        let square = f.mul(f);
        let weight = square.mul(square);
        for a in 0..3 {
            let normal = self.normal[a].add(V::splat(other.repulsion[a]));
            stress[a] = normal.mul_add(weight, stress[a]);
            let shear = self.shear[a].add(V::splat(other.repulsion[3 + a]));
            stress[3 + a] = shear.mul_add(weight, stress[3 + a]);
        }
    }

    /// `(e_i − e_j)` times `factor` (J/kg).
    #[inline(always)]
    pub(super) fn flux(&self, other: &OptionRecord, factor: V) -> V {
        self.energy.sub(V::splat(other.specific_energy)).mul(factor)
    }
}
