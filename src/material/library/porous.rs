//! Porous materials: a solid with a law of compaction.

use super::Parts;
use super::impact::{UNCUT, aluminium};
use super::rocks::basalt;
use crate::{
    Compaction, Effect, Eos, Failure, HolmquistJohnsonCook, HolmquistJohnsonCookCompaction,
    HolmquistJohnsonCookFailure, Lundborg, PAlpha, Polynomial, Porosity, RiedelHiermaierThoma,
    RiedelHiermaierThomaFailure, Strength,
};

const FOAM: &str = "Jutzi, Benz & Michel (2008), Icarus 198, 242, section 5.1, after Herrmann (1969); as the tests of \
     Spheral quote it";
const SOLID: &str = "of aluminium-tillotson";
const FLUID: &str = "without strength, as in that test";
const QUADRATIC: &str = "Herrmann (1969), J. Appl. Phys. 40, 2490";
const PLAIN: &str = "no steep beginning";
const CONCRETE: &str = "concrete of 48 MPa of Holmquist, Johnson & Cook (1993), 14th Int. Symp. Ballistics, 591, as the manual of CDEM \
     (SetHJCMat) quotes it";
const GRAIN: &str = "1.1 times the 2440 kg/m³ of the whole, by the locking strain of .1; Holmquist, Johnson & Cook (1993), 14th Int. \
     Symp. Ballistics, 591, as public decks quote it";
const CONCRETE_35: &str = "concrete of 35 MPa of Borrvall & Riedel (2011), The RHT concrete model in LS-DYNA, 8th European LS-DYNA Users \
     Conference; as commonly quoted, not compared with the paper";
const PORES_35: &str = "the speed of sound of the whole in the library of Autodyn, which gives ν = .17 with G; as commonly quoted, not compared with it";
const JSC: &str =
    "JSC-1A of Luther et al. (2022), as miluphcuda quotes it in Regolith_simulant.cfg";
const JSC_SHEAR: &str = "ν = .3, as in miluphcuda's Regolith_simulant.cfg, with ρ₀ c_e² of the whole for the bulk modulus; there the \
     12.32 GPa of the solid";
const JSC_SPEED: &str = "about the least that the law takes with this crush curve; miluphcuda's Regolith_simulant.cfg has 950 m/s";
const JSC_LIMIT: &str = "1.3 GPa, where the crush curve of miluphcuda's Regolith_simulant.cfg ends (its P_t, as α_t is one); JSC-1A of \
     Luther et al. (2022)";
const BASALT: &str = "of basalt-tillotson, as in Luther et al. (2022)";
const COLD: &str = "none: the law has no heat";
const RATE: &str = "1/s, as in Holmquist, Johnson & Cook (1993), 14th Int. Symp. Ballistics, 591";
const LAW: &str = "as the law has it";

records! {
    "aluminium-foam", "aluminium with 22 % of pores, P-alpha, without strength":
        Parts {
            strength: Strength::None,
            ..aluminium()
        },
        &[
            ("porosity.p_alpha.exponent", QUADRATIC),
            ("porosity.p_alpha.transition", PLAIN),
            ("porosity", FOAM),
            ("strength", FLUID),
            ("eos.tillotson.least_density", UNCUT),
            ("", SOLID),
        ];
    "concrete-48", "concrete of 48 MPa, Holmquist-Johnson-Cook strength, crushing and damage":
        concrete(),
        &[
            ("eos.polynomial.gamma0", COLD),
            ("strength.holmquist_johnson_cook.reference_rate", RATE),
            ("failure.effect", LAW),
            ("density", GRAIN),
            ("", CONCRETE),
        ];
    "concrete-35", "concrete of 35 MPa, Riedel-Hiermaier-Thoma strength and damage, P-alpha":
        concrete_35(),
        &[
            ("porosity.p_alpha.sound_speed", PORES_35),
            ("porosity.p_alpha.transition", PLAIN),
            ("failure.effect", LAW),
            ("", CONCRETE_35),
        ];
    "regolith-jsc-1a", "lunar regolith simulant JSC-1A with 42 % of pores, P-alpha, friction, for impacts":
        {
            let (density, law) = basalt();
            Parts {
                density,
                eos: Eos::Tillotson(law),
                strength: Strength::Lundborg(Lundborg {
                    shear_modulus: 1.043e9,
                    cohesion: 1.4e3,
                    friction: 0.77,
                    max_strength: 1e9,
                }),
                thermal: None,
                failure: Failure::NONE,
            }
        },
        &[
            ("porosity.p_alpha.exponent", QUADRATIC),
            ("porosity.p_alpha.solid_pressure", JSC_LIMIT),
            ("porosity.p_alpha.sound_speed", JSC_SPEED),
            ("porosity.p_alpha.transition", PLAIN),
            ("strength.lundborg.shear_modulus", JSC_SHEAR),
            ("strength", JSC),
            ("porosity", JSC),
            ("eos.tillotson.least_density", UNCUT),
            ("", BASALT),
        ];
}

/// Concrete of 48 `MPa`; the density is that of the solid.
fn concrete() -> Parts {
    let mut failure = Failure {
        holmquist_johnson_cook: Some(HolmquistJohnsonCookFailure {
            d1: 0.04,
            d2: 1.0,
            least_strain: 0.01,
        }),
        ..Failure::NONE
    };
    failure.options.effect = Effect::FrictionKept;
    Parts {
        density: 2440.0 * CONCRETE_DISTENSION,
        eos: Eos::Polynomial(Polynomial {
            k1: 85e9,
            k2: -171e9,
            k3: 208e9,
            gamma0: 0.0,
        }),
        strength: Strength::HolmquistJohnsonCook(HolmquistJohnsonCook {
            shear_modulus: 14.86e9,
            a: 0.79,
            b: 1.6,
            c: 0.007,
            n: 0.61,
            compressive_strength: 48e6,
            max_tension: 4e6,
            max_strength: 7.0,
            reference_rate: 1.0,
        }),
        thermal: None,
        failure,
    }
}

/// Concrete of 35 `MPa`; the density is that of the solid.
fn concrete_35() -> Parts {
    let mut failure = Failure {
        riedel_hiermaier_thoma: Some(RiedelHiermaierThomaFailure {
            d1: 0.04,
            d2: 1.0,
            least_strain: 0.01,
        }),
        ..Failure::NONE
    };
    failure.options.effect = Effect::FrictionKept;
    Parts {
        density: 2750.0,
        eos: Eos::Polynomial(Polynomial {
            k1: 35.27e9,
            k2: 39.58e9,
            k3: 9.04e9,
            gamma0: 1.22,
        }),
        strength: Strength::RiedelHiermaierThoma(RiedelHiermaierThoma {
            shear_modulus: 16.7e9,
            a: 1.6,
            n: 0.61,
            compressive_strength: 35e6,
            tensile_ratio: 0.1,
            shear_ratio: 0.18,
            lode_ratio: 0.6805,
            lode_slope: 0.0105,
            elastic_compression: 0.53,
            elastic_tension: 0.7,
            hardening: 0.5,
            b: 1.6,
            m: 0.61,
            rate_compression: 0.032,
            rate_tension: 0.036,
            reference_compression: 3e-5,
            reference_tension: 3e-6,
        }),
        thermal: None,
        failure,
    }
}

/// One and the locking strain.
const CONCRETE_DISTENSION: f64 = 1.1;

/// Pores of the record of a name, in a solid of this density (kg/m³).
pub(super) fn of(name: &str, density: f64, eos: &Eos) -> Option<Porosity> {
    let (distension, law) = match name {
        "aluminium-foam" => (1.275, p_alpha([80e6, 700e6], 2.0, 4110.0)),
        "concrete-48" => {
            let law = HolmquistJohnsonCookCompaction {
                crush_pressure: 16e6,
                crush_strain: 0.001,
                lock_pressure: 0.8e9,
            };
            (
                CONCRETE_DISTENSION,
                Compaction::HolmquistJohnsonCookCompaction(law),
            )
        }
        "concrete-35" => (2750.0 / 2314.0, p_alpha([23.3e6, 6e9], 3.0, 2920.0)),
        "regolith-jsc-1a" => (1.72, p_alpha([100.0, 1.3e9], 2.0, 1200.0)),
        _ => return None,
    };
    Some(Porosity::new(distension, law, density, eos))
}

/// Of `[P_e, P_s]` (Pa), the exponent and the bulk sound speed of virgin matter (m/s).
fn p_alpha(
    [elastic_pressure, solid_pressure]: [f64; 2],
    exponent: f64,
    sound_speed: f64,
) -> Compaction {
    Compaction::PAlpha(PAlpha {
        elastic_pressure,
        solid_pressure,
        exponent,
        transition_pressure: 0.0,
        transition_distension: 1.0,
        transition_exponent: 2.0,
        sound_speed,
    })
}
