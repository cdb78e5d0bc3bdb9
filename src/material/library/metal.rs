//! Parts of the records of metals: Mie–Grüneisen with a strength.

use super::Parts;
use crate::{
    Eos, Failure, JohnsonCook, MieGruneisen, SteinbergGuinan, Strength, ThermalConstants, VonMises,
};

/// Density (kg/m³), shear modulus (Pa) and Hugoniot.
#[derive(Clone, Copy)]
pub(super) struct Metal {
    pub(super) density: f64,
    pub(super) shear_modulus: f64,
    /// `[c₀ (m/s), s₁, γ₀, b]`
    pub(super) hugoniot: [f64; 4],
    /// `[s₂, s₃]` of the Hugoniot.
    pub(super) curvature: [f64; 2],
}

impl Metal {
    fn with(&self, strength: Strength, thermal: ThermalConstants) -> Parts {
        let [c0, s1, gamma0, b] = self.hugoniot;
        let [s2, s3] = self.curvature;
        Parts {
            density: self.density,
            eos: Eos::MieGruneisen(MieGruneisen {
                c0,
                s1,
                s2,
                s3,
                gamma0,
                b,
            }),
            strength,
            thermal: Some(thermal),
            failure: Failure::NONE,
        }
    }
}

pub(super) fn von_mises(metal: &Metal, yield_stress: f64, thermal: ThermalConstants) -> Parts {
    let law = VonMises {
        shear_modulus: metal.shear_modulus,
        yield_stress,
        hardening_modulus: 0.0,
    };
    metal.with(Strength::VonMises(law), thermal)
}

/// `[A (Pa), B (Pa), n, C, m]`, with a reference rate of 1/s.
pub(super) fn jc(metal: &Metal, constants: [f64; 5], thermal: ThermalConstants) -> Parts {
    jc_of_rate(metal, 1.0, constants, thermal)
}

/// The same with another reference rate (1/s).
pub(super) fn jc_of_rate(
    metal: &Metal,
    reference_rate: f64,
    [a, b, n, c, m]: [f64; 5],
    thermal: ThermalConstants,
) -> Parts {
    let law = JohnsonCook {
        shear_modulus: metal.shear_modulus,
        a,
        b,
        n,
        c,
        m,
        reference_rate,
    };
    metal.with(Strength::JohnsonCook(law), thermal)
}

/// `[Y₀ (Pa), Y_max (Pa), β, n]` and `[G'_p/G₀ (1/Pa), −G'_T/G₀ (1/K), T_m0 (K), a]`.
pub(super) fn sg(
    metal: &Metal,
    [yield_stress, max_yield_stress, beta, n]: [f64; 4],
    [pressure, temperature, melting_temperature, a]: [f64; 4],
    thermal: ThermalConstants,
) -> Parts {
    let law = SteinbergGuinan {
        shear_modulus: metal.shear_modulus,
        yield_stress,
        max_yield_stress,
        beta,
        n,
        initial_strain: 0.0,
        pressure_coefficient: pressure,
        temperature_coefficient: temperature,
        melting_temperature,
        gamma0: metal.hugoniot[2],
        a,
    };
    metal.with(Strength::SteinbergGuinan(law), thermal)
}
