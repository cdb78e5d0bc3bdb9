//! Porous materials: a solid with a law of compaction.

use super::Parts;
use super::impact::{CUT, UNCUT, aluminium};
use super::rocks::{IVANOV, OFF, SAME, SHEAR, basalt};
use crate::{
    Collins, Compaction, CompactionDamage, Effect, Eos, Failure, HolmquistJohnsonCook,
    HolmquistJohnsonCookCompaction, HolmquistJohnsonCookFailure, Lundborg, PAlpha, Polynomial,
    Porosity, RiedelHiermaierThoma, RiedelHiermaierThomaFailure, Strength, StrengthOf,
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
const CONCRETE_140: &str = "concrete of 140 MPa of the library of Autodyn (CONC-140MPA); as commonly quoted, not compared with it";
const PORES_35: &str = "the speed of sound of the whole in the library of Autodyn, which gives ν = .17 with G; as commonly quoted, not compared with it";
const JSC: &str =
    "JSC-1A of Luther et al. (2022), as miluphcuda quotes it in Regolith_simulant.cfg";
const JSC_SHEAR: &str = "ν = .3, as in miluphcuda's Regolith_simulant.cfg, with ρ₀ c_e² of the whole for the bulk modulus; there the \
     12.32 GPa of the solid";
const JSC_SPEED: &str = "about the least that the law takes with this crush curve; miluphcuda's Regolith_simulant.cfg has 950 m/s";
const JSC_LIMIT: &str = "1.3 GPa, where the crush curve of miluphcuda's Regolith_simulant.cfg ends (its P_t, as α_t is one); JSC-1A of \
     Luther et al. (2022)";
const BASALT: &str = "of basalt-tillotson, as in Luther et al. (2022)";
const PUMICE: &str = "pumice of Spheral's library of materials: basalt of Benz & Asphaug (1999), Icarus 142, 5, with this density";
const PUMICE_PORES: &str = "crush curve of pumice of Jutzi et al. (2009), Icarus 201, 802, as ports of miluphcuda quote it for porous \
     basalt; not compared with the paper";
const PUMICE_SPEED: &str = "none: as fast as in the solid";
const PUMICE_STRENGTH: &str =
    "those of the solid, as in Jutzi, Benz & Michel (2008), Icarus 198, 242";
const PUMICE_DAMAGE: &str = "Jutzi, Benz & Michel (2008), Icarus 198, 242";
const PUMICE_FRICTION: &str = "porous basalt, as ports of miluphcuda quote it";
const COLD: &str = "none: the law has no heat";
const RATE: &str = "1/s, as in Holmquist, Johnson & Cook (1993), 14th Int. Symp. Ballistics, 591";
const LAW: &str = "as the law has it";
const NONE: &str = "none";

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
            ("eos.tillotson.least_density", CUT),
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
    "concrete-140", "concrete of 140 MPa, Riedel-Hiermaier-Thoma strength and damage, P-alpha":
        concrete_of([140e6, 22.06e9, 0.009_09, 0.0125]),
        &[
            ("porosity.p_alpha.transition", PLAIN),
            ("failure.effect", LAW),
            ("", CONCRETE_140),
        ];
    "concrete-35", "concrete of 35 MPa, Riedel-Hiermaier-Thoma strength and damage, P-alpha":
        concrete_of(CONCRETE_35_MPA),
        &[
            ("porosity.p_alpha.sound_speed", PORES_35),
            ("porosity.p_alpha.transition", PLAIN),
            ("failure.effect", LAW),
            ("", CONCRETE_35),
        ];
    "pumice", "pumice with 78 % of pores, P-alpha with a steep beginning, friction and shear damage":
        {
            let (_, law) = basalt();
            let mut failure = Failure {
                ivanov: Some(SHEAR),
                ..Failure::NONE
            };
            failure.options.effect = Effect::FrictionKept;
            Parts {
                density: 2327.0,
                eos: Eos::Tillotson(law),
                strength: Strength::Collins(Collins {
                    shear_modulus: 22.7e9,
                    cohesion: 1e6,
                    friction: 1.5,
                    max_strength: 3.5e9,
                    damaged_cohesion: 0.0,
                    damaged_friction: 0.6,
                    damaged_max_strength: 0.0,
                    softening: 0.0,
                    simon_a: 0.0,
                    simon_c: 1.0,
                }),
                thermal: None,
                failure,
            }
        },
        &[
            ("porosity.p_alpha.sound_speed", PUMICE_SPEED),
            ("porosity.strength", PUMICE_STRENGTH),
            ("porosity.damage", PUMICE_DAMAGE),
            ("porosity", PUMICE_PORES),
            ("strength.collins.damaged_max_strength", SAME),
            ("strength.collins.damaged_cohesion", NONE),
            ("strength.collins.softening", OFF),
            ("strength.collins.simon", OFF),
            ("strength", PUMICE_FRICTION),
            ("failure.effect", LAW),
            ("failure", IVANOV),
            ("eos.tillotson.least_density", UNCUT),
            ("", PUMICE),
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

/// Compressive strength (Pa), shear modulus (Pa), exponents of the rate in compression and tension of concrete of 35 `MPa`.
const CONCRETE_35_MPA: [f64; 4] = [35e6, 16.7e9, 0.032, 0.036];

/// Concrete of such constants; the density is that of the solid.
fn concrete_of(
    [
        compressive_strength,
        shear_modulus,
        rate_compression,
        rate_tension,
    ]: [f64; 4],
) -> Parts {
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
            shear_modulus,
            a: 1.6,
            n: 0.61,
            compressive_strength,
            tensile_ratio: 0.1,
            shear_ratio: 0.18,
            lode_ratio: 0.6805,
            lode_slope: 0.0105,
            elastic_compression: 0.53,
            elastic_tension: 0.7,
            hardening: 0.5,
            b: 1.6,
            m: 0.61,
            rate_compression,
            rate_tension,
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
        "concrete-140" => (2750.0 / 2520.0, p_alpha([93.3e6, 6e9], 3.0, 3242.0)),
        "concrete-35" => (2750.0 / 2314.0, p_alpha([23.3e6, 6e9], 3.0, 2920.0)),
        "pumice" => return Some(pumice(density, eos)),
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

/// Pores of pumice in a solid of this density (kg/m³): constants of the strength are the solid's, and what is crushed has failed.
fn pumice(density: f64, eos: &Eos) -> Porosity {
    let law = PAlpha {
        elastic_pressure: 1e6,
        solid_pressure: 213e6,
        exponent: 3.0,
        transition_pressure: 68e6,
        transition_distension: 1.9,
        transition_exponent: 12.0,
        sound_speed: 0.0,
    };
    let mut porosity = Porosity::new(4.64, Compaction::PAlpha(law), density, eos);
    porosity.strength = StrengthOf::Matrix;
    porosity.damage = CompactionDamage::Crushed;
    porosity
}
