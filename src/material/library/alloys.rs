//! More alloys of shields, projectiles and armour, and iron.
//!
//! The line of a source says so if it has been read in another program's files only; "not checked"
//! means that the paper itself has not been at hand.

use super::heat;
use super::metal::{Metal, jc, jc_of_rate, sg, von_mises};
use super::metals::{AL_2024, AL_6061};

const UINTAH: &str = "Steinberg-Guinan constants in Uintah, citing Steinberg, UCRL-MA-106439";
const STEINBERG: &str = "Steinberg, UCRL-MA-106439 (1996), as a public table of Hugoniots and \
     Uintah quote it";
const STEINBERG_TABLE: &str =
    "Steinberg, UCRL-MA-106439 (1996), as a public table of Hugoniots quotes it";
const PIERAZZO: &str =
    "Johnson-Cook constants of Pierazzo et al. (2008), Meteorit. Planet. Sci. 43, 1917";
const PIERAZZO_YIELD: &str =
    "Pierazzo et al. (2008), Meteorit. Planet. Sci. 43, 1917; Uintah prints ten times as much";
const CLAUSEN: &str = "Clausen et al. (2004), Mater. Sci. Eng. A 364, 260, plates of 5083-H116; not \
     checked against the paper";
const BRAR: &str = "Brar, Joshi & Harris (2009), AIP Conf. Proc. 1195, 945, of 7075-T651; not checked \
     against the paper";
const BORVIK: &str = "Børvik et al. (2001, 2002), Eur. J. Mech. A 20, 685 and Int. J. Impact Eng. 27, \
     37; their (1 + ε̇*)^C is taken as 1 + C ln ε̇*";
const LESUER: &str = "Lesuer (2000), DOT/FAA/AR-00/25; not checked against the report";
const TI_ELASTIC: &str = "E = 113.8 GPa, ν = .342 (MatWeb)";
const TI_SHEAR: &str = "Steinberg-Guinan constants in Uintah, citing Steinberg, UCRL-MA-106439; 41.3 GPa elsewhere \
     in the same file";
const HANDBOOK_2017: &str = "aluminium 2017-T4: G 27.2 GPa, yield 275 MPa, solidus 786 K, as data \
     sheets have it";
const LIKE_2024: &str = "of aluminium 2024, as an approximation: Steinberg-Guinan constants in \
     Uintah, citing Steinberg, UCRL-MA-106439";
const LIKE_6061: &str = "of aluminium 6061, as an approximation: Steinberg-Guinan constants in \
     Uintah, citing Steinberg, UCRL-MA-106439";
const MELT_OF_6061: &str = "of aluminium 6061-T6, as an approximation";
const LIKE_4340: &str = "of steel 4340 (Rockwell C 38), as an approximation: Steinberg, \
     UCRL-MA-106439 (1996), as a public table of Hugoniots quotes it";
const IRON: &str = "Johnson & Cook (1983), Proc. 7th Int. Symp. Ballistics, 541, as WeldFormSPH quotes it; \
     Uintah has m = 1.44";
const MILD_STEEL: &str = "1006 steel of Johnson & Cook (1983), Proc. 7th Int. Symp. Ballistics, 541; not checked \
     against the paper";
pub(super) const MARSH: &str = "Hugoniot of iron: Marsh (1980), LASL shock Hugoniot data";
pub(super) const IRON_ELASTIC: &str = "assumed: E = 210 GPa, ν = .29, round values of iron";
const ROOM: &str = "300 K, to which the other constants belong";
const KEPT: &str = "no hardening: the initial yield stress is kept";
const RATE: &str = "1/s, as in Johnson & Cook (1983)";
const CONSTANT_GAMMA: &str = "no volume dependence of γρ assumed";
const ALUMINIUM_MELTS: &str = "melting point of pure aluminium, assumed";
const LIQUIDUS_7075: &str = "liquidus of 7075 (635 °C), assumed";

/// Sources of iron, from those of its strength and heat.
macro_rules! iron {
    ($law:expr) => {
        &[
            ("strength.johnson_cook.shear_modulus", IRON_ELASTIC),
            ("strength.johnson_cook.reference_rate", RATE),
            ("thermal.reference_temperature", ROOM),
            ("eos.mie_gruneisen.b", CONSTANT_GAMMA),
            ("eos", MARSH),
            ("density", MARSH),
            ("", $law),
        ]
    };
}

records! {
    "aluminium-1100", "aluminium 1100-O, constant yield stress":
        von_mises(&AL_1100, 0.04e9, heat(884.0, 300.0, Some(933.0))),
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("strength.von_mises.yield_stress", PIERAZZO_YIELD),
            ("thermal.reference_temperature", ROOM),
            ("thermal.melting_temperature", ALUMINIUM_MELTS),
            ("thermal", STEINBERG_TABLE),
            ("", UINTAH),
        ];
    "aluminium-1100-johnson-cook", "aluminium 1100-O":
        jc(&AL_1100, [49e6, 157e6, 0.167, 0.016, 1.7], heat(884.0, 300.0, Some(933.0))),
        &[
            ("strength.johnson_cook.shear_modulus", UINTAH),
            ("strength.johnson_cook.reference_rate", RATE),
            ("thermal.reference_temperature", ROOM),
            ("thermal.melting_temperature", ALUMINIUM_MELTS),
            ("eos", UINTAH),
            ("density", UINTAH),
            ("", PIERAZZO),
        ];
    "aluminium-1100-steinberg-guinan", "aluminium 1100-O":
        sg(
            &AL_1100,
            [0.04e9, 0.48e9, 400.0, 0.27],
            [6.52e-11, 6.16e-4, 1220.0, 1.5],
            heat(884.0, 300.0, None),
        ),
        &[
            ("strength.steinberg_guinan.yield_stress", PIERAZZO_YIELD),
            ("strength.steinberg_guinan.a", MELT_OF_6061),
            ("thermal.reference_temperature", ROOM),
            ("thermal", STEINBERG_TABLE),
            ("", UINTAH),
        ];
    "aluminium-2017", "aluminium 2017-T4, constant yield stress":
        von_mises(&AL_2017, 0.275e9, heat(875.0, 300.0, Some(786.0))),
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("thermal.reference_temperature", ROOM),
            ("thermal.specific_heat", "of aluminium 2024: Johnson & Cook (1983)"),
            ("eos", LIKE_2024),
            ("", HANDBOOK_2017),
        ];
    "aluminium-5083-johnson-cook", "aluminium 5083-H116":
        jc(&AL_5083, [167e6, 596e6, 0.551, 0.001, 0.859], heat(910.0, 293.0, Some(893.0))),
        &[
            (
                "strength.johnson_cook.shear_modulus",
                "E = 70 GPa, ν = .3, as those who fitted the strength take them",
            ),
            ("eos", LIKE_6061),
            ("", CLAUSEN),
        ];
    "aluminium-7075", "aluminium 7075-T6, constant yield stress":
        von_mises(&AL_7075, 0.42e9, heat(848.0, 300.0, Some(908.0))),
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("thermal.reference_temperature", ROOM),
            ("thermal.melting_temperature", LIQUIDUS_7075),
            ("", STEINBERG),
        ];
    "aluminium-7075-johnson-cook", "aluminium 7075-T651":
        jc(&AL_7075, [546e6, 678e6, 0.71, 0.024, 1.56], heat(848.0, 300.0, Some(908.0))),
        &[
            ("strength.johnson_cook.shear_modulus", STEINBERG),
            ("strength.johnson_cook.reference_rate", RATE),
            ("thermal.reference_temperature", ROOM),
            ("thermal.melting_temperature", LIQUIDUS_7075),
            ("thermal", STEINBERG),
            ("eos", STEINBERG),
            ("density", STEINBERG),
            ("", BRAR),
        ];
    "aluminium-7075-steinberg-guinan", "aluminium 7075-T6":
        sg(
            &AL_7075,
            [0.42e9, 0.81e9, 965.0, 0.10],
            [6.52e-11, 6.16e-4, 1220.0, 1.7],
            heat(848.0, 300.0, None),
        ),
        &[("thermal.reference_temperature", ROOM), ("", STEINBERG)];
    "iron-armco-johnson-cook", "Armco iron":
        jc(&IRON_ALPHA, [175e6, 380e6, 0.32, 0.06, 0.55], heat(452.0, 300.0, Some(1811.0))),
        iron!(IRON);
    "steel-1006-johnson-cook", "mild steel 1006":
        jc(&IRON_ALPHA, [350e6, 275e6, 0.36, 0.022, 1.0], heat(452.0, 300.0, Some(1811.0))),
        iron!(MILD_STEEL);
    "steel-weldox-460e-johnson-cook", "steel Weldox 460 E":
        jc_of_rate(
            &WELDOX_460E,
            5e-4,
            [490e6, 807e6, 0.73, 0.0114, 0.94],
            heat(452.0, 293.0, Some(1800.0)),
        ),
        &[
            (
                "strength.johnson_cook.shear_modulus",
                "E = 200 GPa, ν = .33, as those who fitted the strength take them",
            ),
            ("eos.mie_gruneisen.b", CONSTANT_GAMMA),
            ("eos", LIKE_4340),
            ("", BORVIK),
        ];
    "titanium-6al-4v", "titanium Ti-6Al-4V, constant yield stress":
        von_mises(&TI_6AL_4V_STEINBERG, 1.33e9, heat(525.0, 300.0, Some(1878.0))),
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("strength.von_mises.shear_modulus", TI_SHEAR),
            ("thermal.reference_temperature", ROOM),
            ("thermal.melting_temperature", LESUER),
            ("", UINTAH),
        ];
    "titanium-6al-4v-johnson-cook", "titanium Ti-6Al-4V":
        jc(&TI_6AL_4V, [1098e6, 1092e6, 0.93, 0.014, 1.1], heat(525.0, 300.0, Some(1878.0))),
        &[
            ("strength.johnson_cook.shear_modulus", TI_ELASTIC),
            ("strength.johnson_cook.reference_rate", RATE),
            ("thermal.reference_temperature", ROOM),
            ("thermal.specific_heat", STEINBERG),
            ("eos.mie_gruneisen.b", CONSTANT_GAMMA),
            ("eos", STEINBERG_TABLE),
            ("density", STEINBERG),
            ("", LESUER),
        ];
    "titanium-6al-4v-steinberg-guinan", "titanium Ti-6Al-4V":
        sg(
            &TI_6AL_4V_STEINBERG,
            [1.33e9, 2.12e9, 12.0, 0.1],
            [1.15e-11, 6.44e-4, 2110.0, 1.0],
            heat(525.0, 300.0, None),
        ),
        &[
            ("strength.steinberg_guinan.shear_modulus", TI_SHEAR),
            ("thermal.reference_temperature", ROOM),
            ("", UINTAH),
        ];
}

const AL_1100: Metal = Metal {
    density: 2707.0,
    shear_modulus: 27.1e9,
    hugoniot: [5386.0, 1.339, 1.97, 0.48],
    curvature: [0.0; 2],
};

const AL_2017: Metal = Metal {
    density: 2790.0,
    shear_modulus: 27.2e9,
    ..AL_2024
};

pub(super) const AL_5083: Metal = Metal {
    density: 2700.0,
    shear_modulus: 26.9e9,
    ..AL_6061
};

pub(super) const AL_7075: Metal = Metal {
    density: 2804.0,
    shear_modulus: 26.7e9,
    hugoniot: [5200.0, 1.36, 2.20, 0.48],
    curvature: [0.0; 2],
};

pub(super) const IRON_ALPHA: Metal = Metal {
    density: 7850.0,
    shear_modulus: 81.4e9,
    hugoniot: [3574.0, 1.92, 1.69, 0.0],
    curvature: [0.0; 2],
};

pub(super) const WELDOX_460E: Metal = Metal {
    density: 7850.0,
    shear_modulus: 75.2e9,
    hugoniot: [4578.0, 1.33, 1.67, 0.0],
    curvature: [0.0; 2],
};

pub(super) const TI_6AL_4V: Metal = Metal {
    density: 4419.0,
    shear_modulus: 42.4e9,
    hugoniot: [5130.0, 1.028, 1.23, 0.0],
    curvature: [0.0; 2],
};

const TI_6AL_4V_STEINBERG: Metal = Metal {
    shear_modulus: 41.9e9,
    hugoniot: [5130.0, 1.028, 1.23, 0.17],
    ..TI_6AL_4V
};
