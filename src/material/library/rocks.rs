//! Rock, ice and soil: strength that grows with pressure, flaws, friction of what is broken.

use super::Parts;
use super::impact::UNCUT;
use crate::{
    Collins, CollinsFailure, Crosses, Effect, Eos, Failure, Flaws, GradyKipp, Ivanov, Linear,
    LinearForm, MohrCoulomb, PrincipalStress, Strength, Tillotson, VonMises,
};

const TILLOTSON: &str = "constants on which miluphcuda, SWIFT, Phantom, OpenSPH and Spheral agree; \
     rocks of Benz & Asphaug (1999), Icarus 142, 5";
const ICE_TILLOTSON: &str = "Benz & Asphaug (1999), Icarus 142, 5, as miluphcuda quotes it";
const OLIVINE: &str = "olivine of Marinova et al. (2011), Icarus 211, 960, as miluphcuda quotes it";
const OLIVINE_SHEAR: &str = "olivine of Mao et al. (2015), Earth Planet. Sci. Lett. 409, 67, as \
     miluphcuda quotes it";
const GRANITE: &str =
    "Collins et al. (2004), Meteorit. Planet. Sci. 39, 217, as miluphcuda quotes it";
const GRANITE_SHEAR: &str = "miluphcuda, material-config/material_data/Granite.cfg";
const GRANITE_DAMAGE: &str = "Collins et al. (2004), Meteorit. Planet. Sci. 39, 217, as OpenSPH \
     quotes it: where the curves of intact and of broken granite cross";
const GRANITE_TENSION: &str = "Westerly granite: Dowling (2013), Mechanical behavior of materials, \
     table 3.10; slow tests, and impacts need more";
const BASALT: &str = "basalt of inputs for iSALE and SALEc-2D: Dey, Lonar crater, material.inp; Li, \
     utopia.inp";
const BASALT_LIMIT: &str =
    "basalt of Benz & Asphaug (1999), Icarus 142, 5, and of inputs for iSALE";
const GRANITE_FRICTION: &str = "intact and broken granite of Collins et al. (2004), Meteorit. \
     Planet. Sci. 39, 217, which OpenSPH has for basalt too";
const BASALT_TRANSITIONS: &str = "SALEc-2D; with a limit of 3.5 GPa the curves of intact and of \
     broken rock cross at 2.7 GPa, as Collins et al. (2004) define the first";
const BASALT_SHEAR: &str =
    "basalt of Benz & Asphaug (1999), Icarus 142, 5, in the codes named above";
const FLAWS: &str = "fitted by Benz & Asphaug (1999), Icarus 142, 5, to Nakamura & Fujiwara (1991)";
const FITTED_SIZE: &str = "the size with which the flaws give the largest fragment of Nakamura & \
     Fujiwara (1991), Icarus 92, 132";
const ICE_FLAWS: &str = "Benz & Asphaug (1999), Icarus 142, 5, as miluphcuda quotes it; Schäfer et \
     al. (2016) have 1e46/m³, 9.1";
const CRACKS: &str = "Grady & Kipp (1980), Int. J. Rock Mech. Min. Sci. 17, 147";
pub(super) const IVANOV: &str = "rock of Raducan et al. (2019), Icarus 329, 282, their inputs for iSALE; \
     Ivanov et al. (1997), Int. J. Impact Eng. 20, 411";
const LIMESTONE: &str =
    "limestone of Melosh (1989), Impact cratering, table AII.3, as Spheral quotes it";
const CALCITE: &str = "calcite of iSALE's example of Chicxulub";
const CALCITE_SHEAR: &str = "ν = .3 of calcite in iSALE's example of Chicxulub, with A";
const CALCITE_DAMAGE: &str =
    "Ivanov et al. (1997), Int. J. Impact Eng. 20, 411, as in iSALE's example of Chicxulub";
const DUNITE: &str = "dunite of Bowling et al. (2013), J. Geophys. Res. 118, 1821, as miluphcuda \
     quotes it";
const ICE: &str = "from a Hugoniot elastic limit of .62 GPa of cold ice, Stewart & Ahrens (2005), J. \
     Geophys. Res. 110, E03005, as pyko's book turns it into a yield stress; Benz & Asphaug (1999) \
     have 1 GPa";
const REGOLITH: &str = "dry regolith of Schäfer et al. (2017), as miluphcuda quotes it in \
     Regolith.cfg, φ = 30°; a linear law for its Murnaghan's";
const LINEAR_FORM: &str = "the first term of Murnaghan's law";
pub(super) const OFF: &str = "none: heat is left out";
pub(super) const SAME: &str = "that of intact rock";
const FADES: &str = "as the laws have it";

records! {
    "basalt-tillotson", "basalt of the laboratory, to vaporisation: friction, flaws, and shear damage":
        rock(
            basalt(),
            Strength::Collins(collins([22.7e9, 90e6, 2.0, 3.5e9], [0.0, 0.8])),
            Failure {
                collins: Some(CollinsFailure {
                    brittle_ductile: 2.7e9,
                    brittle_plastic: 4.1e9,
                }),
                grady_kipp: Some(flaws(4e35, 9.0, 1.2e-3)),
                ..Failure::NONE
            },
        ),
        &[
            ("strength.collins.shear_modulus", BASALT_SHEAR),
            ("strength.collins.max_strength", BASALT_LIMIT),
            ("strength.collins.damaged_max_strength", SAME),
            ("strength.collins.softening", OFF),
            ("strength.collins.simon", OFF),
            ("strength", GRANITE_FRICTION),
            ("failure.collins", BASALT_TRANSITIONS),
            ("failure.grady_kipp.crack_speed", CRACKS),
            ("failure.grady_kipp.least_size", FITTED_SIZE),
            ("failure.grady_kipp", FLAWS),
            ("failure.effect", FADES),
            ("eos.tillotson.least_density", UNCUT),
            ("", TILLOTSON),
        ];
    "basalt-field", "basalt of the ground, weak by joints: friction and shear damage, for craters of metres and more":
        rock(
            basalt(),
            Strength::Collins(collins([22.7e9, 10e6, 1.2, 3.5e9], [10e3, 0.6])),
            Failure {
                ivanov: Some(SHEAR),
                ..Failure::NONE
            },
        ),
        &[
            ("strength.collins.shear_modulus", BASALT_SHEAR),
            ("strength.collins.damaged_max_strength", SAME),
            ("strength.collins.softening", OFF),
            ("strength.collins.simon", OFF),
            ("strength", BASALT),
            ("failure.effect", FADES),
            ("failure", IVANOV),
            ("eos.tillotson.least_density", UNCUT),
            ("", TILLOTSON),
        ];
    "dunite", "dunite to vaporisation: friction and shear damage":
        rock(
            tillotson(3500.0, [0.5, 1.4, 131e9, 49e9], [550e6, 4.5e6, 14.5e6], [5.0, 5.0]),
            Strength::Collins(collins([81.6e9, 10e6, 1.2, 3.5e9], [10e3, 0.6])),
            Failure {
                ivanov: Some(SHEAR),
                ..Failure::NONE
            },
        ),
        &[
            ("strength.collins.shear_modulus", OLIVINE_SHEAR),
            ("strength.collins.damaged_max_strength", SAME),
            ("strength.collins.softening", OFF),
            ("strength.collins.simon", OFF),
            ("strength", DUNITE),
            ("failure.effect", FADES),
            ("failure", IVANOV),
            ("eos.tillotson.least_density", UNCUT),
            ("", OLIVINE),
        ];
    "granite", "granite to vaporisation: friction, shear damage, brittle in tension":
        rock(
            tillotson(2680.0, [0.5, 1.3, 18e9, 18e9], [16e6, 3.5e6, 18e6], [5.0, 5.0]),
            Strength::Collins(collins([27e9, 90e6, 2.0, 1.5e9], [0.0, 0.8])),
            Failure {
                principal_stress: Some(PrincipalStress { limit: 9.58e6 }),
                collins: Some(CollinsFailure {
                    brittle_ductile: 1.23e9,
                    brittle_plastic: 2.35e9,
                }),
                ..Failure::NONE
            },
        ),
        &[
            ("strength.collins.shear_modulus", GRANITE_SHEAR),
            ("strength.collins.damaged_max_strength", SAME),
            ("strength.collins.softening", OFF),
            ("strength.collins.simon", OFF),
            ("strength", GRANITE),
            ("failure.principal_stress", GRANITE_TENSION),
            ("failure.effect", FADES),
            ("failure", GRANITE_DAMAGE),
            ("eos.tillotson.least_density", UNCUT),
            ("", TILLOTSON),
        ];
    "ice-tillotson", "cold water ice to vaporisation: constant strength, flaws":
        {
            let mut ice = rock(
                tillotson(917.0, [0.3, 0.1, 9.47e9, 9.47e9], [10e6, 0.773e6, 3.04e6], [10.0, 5.0]),
                Strength::VonMises(VonMises {
                    shear_modulus: 2.8e9,
                    yield_stress: 0.328e9,
                    hardening_modulus: 0.0,
                }),
                Failure {
                    grady_kipp: Some(flaws(1.4e38, 9.6, 0.0)),
                    ..Failure::NONE
                },
            );
            ice.failure.options.effect = Effect::Scaled;
            ice
        },
        &[
            ("strength.von_mises.shear_modulus", ICE_TILLOTSON),
            ("strength.von_mises.hardening_modulus", "no hardening"),
            ("strength", ICE),
            ("failure.grady_kipp.crack_speed", CRACKS),
            ("failure.grady_kipp", ICE_FLAWS),
            ("failure.effect", FADES),
            ("eos.tillotson.least_density", UNCUT),
            ("", ICE_TILLOTSON),
        ];
    "limestone", "limestone of the ground to vaporisation, weak by joints: friction and shear damage":
        {
            let mut strength = collins([18.46e9, 5e6, 1.0, 0.5e9], [10e3, 0.4]);
            strength.damaged_max_strength = 0.5e9;
            rock(
                tillotson(2700.0, [0.5, 0.6, 40e9, 67e9], [10e6, 2.5e6, 14e6], [5.0, 5.0]),
                Strength::Collins(strength),
                Failure {
                    ivanov: Some(SHEAR),
                    ..Failure::NONE
                },
            )
        },
        &[
            ("strength.collins.shear_modulus", CALCITE_SHEAR),
            ("strength.collins.softening", OFF),
            ("strength.collins.simon", OFF),
            ("strength", CALCITE),
            ("failure.effect", FADES),
            ("failure", CALCITE_DAMAGE),
            ("eos.tillotson.least_density", UNCUT),
            ("", LIMESTONE),
        ];
    "regolith", "loose dry regolith for slow loads: friction alone, no cohesion; not for shocks":
        Parts {
            density: 1500.0,
            eos: Eos::Linear(Linear {
                bulk_modulus: 3.33e6,
                form: LinearForm::DensityRatio,
            }),
            strength: Strength::MohrCoulomb(MohrCoulomb {
                shear_modulus: 0.37e6,
                cohesion: 0.0,
                friction: TAN_30,
                tensile_strength: 0.0,
            }),
            thermal: None,
            failure: Failure::NONE,
        },
        &[("eos.linear.form", LINEAR_FORM), ("", REGOLITH)];
}

/// Tangent of 30°.
const TAN_30: f64 = 0.577_350_269_189_625_8;

/// Ivanov's shear damage of rock.
pub(super) const SHEAR: Ivanov = Ivanov {
    least_strain: 1e-4,
    slope: 1e-11,
    pressure: 300e6,
};

/// Basalt without pores.
pub(super) fn basalt() -> (f64, Tillotson) {
    tillotson(
        2700.0,
        [0.5, 1.5, 26.7e9, 26.7e9],
        [487e6, 4.72e6, 18.2e6],
        [5.0, 5.0],
    )
}

/// Density (kg/m³), `[a, b, A (Pa), B (Pa)]`, `[E₀, e_iv, e_cv]` (J/kg), `[α, β]`.
fn tillotson(
    density: f64,
    [a, b, bulk_modulus, quadratic_modulus]: [f64; 4],
    [e0, e_iv, e_cv]: [f64; 3],
    [alpha, beta]: [f64; 2],
) -> (f64, Tillotson) {
    let law = Tillotson {
        a,
        b,
        bulk_modulus,
        quadratic_modulus,
        alpha,
        beta,
        e0,
        e_iv,
        e_cv,
        least_density: 0.0,
    };
    (density, law)
}

/// `[G (Pa), Y_i0 (Pa), μ_i, Y_m (Pa)]` and `[Y_d0 (Pa), μ_d]`, cold.
fn collins(
    [shear_modulus, cohesion, friction, max_strength]: [f64; 4],
    [damaged_cohesion, damaged_friction]: [f64; 2],
) -> Collins {
    Collins {
        shear_modulus,
        cohesion,
        friction,
        max_strength,
        damaged_cohesion,
        damaged_friction,
        damaged_max_strength: 0.0,
        softening: 0.0,
        simon_a: 0.0,
        simon_c: 1.0,
    }
}

/// Weibull's k (1/m³) and m, and the least size (m) that they hold for.
fn flaws(k: f64, m: f64, least_size: f64) -> GradyKipp {
    GradyKipp {
        k,
        m,
        crack_speed: 0.4,
        crosses: Crosses::Particle,
        flaws: Flaws::Drawn,
        most_flaws: 0.0,
        least_size,
    }
}

/// Rock that keeps friction.
fn rock((density, law): (f64, Tillotson), strength: Strength, mut failure: Failure) -> Parts {
    failure.options.effect = Effect::FrictionKept;
    Parts {
        density,
        eos: Eos::Tillotson(law),
        strength,
        thermal: None,
        failure,
    }
}
