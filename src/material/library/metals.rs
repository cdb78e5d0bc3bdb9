//! Metals: Mie–Grüneisen with von Mises, Johnson–Cook or Steinberg–Guinan strength.
//!
//! Von Mises strengths are the initial yield stress Y₀ of the Steinberg–Guinan model, kept
//! constant.

use super::heat;
use super::metal::{Metal, jc, sg, von_mises};

const VERNEY: &str = "the imploding shell of Verney, as codes compute it; Kinslow (1970) has 1851 kg/m^3 and γ₀ = 1.16 with \
     the same Hugoniot";
const KINSLOW: &str =
    "Kinslow (1970), High-Velocity Impact Phenomena, as a public table of Hugoniots quotes it";
const UINTAH: &str = "Steinberg-Guinan constants in Uintah, citing Steinberg, UCRL-MA-106439";
const STEINBERG: &str =
    "Steinberg, UCRL-MA-106439, as FronTier's table of equations of state quotes it";
const KEPT: &str = "no hardening: the initial yield stress is kept";
const SPHERAL: &str = "Steinberg-Guinan constants of 304 steel in Spheral's tests";
const JOHNSON_COOK: &str = "Johnson & Cook (1983), Proc. 7th Int. Symp. Ballistics, 541, as other \
     programs quote it";
const UINTAH_JC: &str = "Johnson-Cook constants in Uintah";
const ROOM: &str = "300 K, to which the other constants belong";
const RATE: &str = "1/s, as in Johnson & Cook (1983)";
const ASSUMED_7039: &str = "assumed: about that of aluminium 2024";
const ASSUMED: &str = "assumed: a round value of austenitic steel, from no one source";
const LIKE_ALLOY: &str =
    "of tungsten with 3.5 % of nickel and 1.5 % of iron, whose γ₀ and b are the same";
const MARSH: &str = "Hugoniot of iron: Marsh (1980), LASL shock Hugoniot data";
const LIKE_2024: &str = "of aluminium 2024, as an approximation: Steinberg-Guinan constants in \
     Uintah, citing Steinberg, UCRL-MA-106439";

/// Sources of a Mie–Grüneisen metal with von Mises strength.
macro_rules! simple {
    ($hugoniot:expr, $heat:expr) => {
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("thermal.reference_temperature", ROOM),
            ("thermal", $heat),
            ("", $hugoniot),
        ]
    };
}

/// Sources of a Mie–Grüneisen metal with Johnson–Cook strength.
macro_rules! johnson_cook {
    ($hugoniot:expr, $shear:expr, $law:expr) => {
        &[
            ("strength.johnson_cook.shear_modulus", $shear),
            ("strength.johnson_cook.reference_rate", RATE),
            ("thermal.reference_temperature", ROOM),
            ("density", $shear),
            ("eos", $hugoniot),
            ("", $law),
        ]
    };
}

/// Sources of a Mie–Grüneisen metal with Steinberg–Guinan strength.
macro_rules! steinberg {
    ($heat:expr) => {
        &[
            ("thermal.reference_temperature", ROOM),
            ("thermal", $heat),
            ("", UINTAH),
        ]
    };
}

records! {
    "aluminium-2024", "aluminium 2024-T4, constant yield stress":
        von_mises(&AL_2024, 0.26e9, heat(875.0, 300.0, Some(775.0))),
        simple!(UINTAH, JOHNSON_COOK);
    "aluminium-2024-johnson-cook", "aluminium 2024-T351":
        jc(&AL_2024, [265e6, 426e6, 0.34, 0.015, 1.00], heat(875.0, 300.0, Some(775.0))),
        johnson_cook!(UINTAH, UINTAH, JOHNSON_COOK);
    "aluminium-2024-steinberg-guinan", "aluminium 2024-T4":
        sg(
            &AL_2024,
            [0.26e9, 0.76e9, 310.0, 0.185],
            [6.52e-11, 6.16e-4, 1220.0, 1.5],
            heat(875.0, 300.0, None),
        ),
        steinberg!(JOHNSON_COOK);
    "aluminium-6061", "aluminium 6061-T6, constant yield stress":
        von_mises(&AL_6061, 0.29e9, heat(896.0, 300.0, Some(925.0))),
        simple!(UINTAH, UINTAH_JC);
    "aluminium-6061-johnson-cook", "aluminium 6061-T6":
        jc(&AL_6061, [324e6, 114e6, 0.42, 0.002, 1.34], heat(896.0, 300.0, Some(925.0))),
        johnson_cook!(UINTAH, UINTAH, UINTAH_JC);
    "aluminium-6061-steinberg-guinan", "aluminium 6061-T6":
        sg(
            &AL_6061,
            [0.29e9, 0.68e9, 125.0, 0.10],
            [6.52e-11, 6.16e-4, 1220.0, 1.5],
            heat(896.0, 300.0, None),
        ),
        steinberg!(UINTAH_JC);
    "aluminium-7039-johnson-cook", "aluminium 7039":
        {
            let metal = Metal {
                density: 2770.0,
                ..AL_2024
            };
            jc(
                &metal,
                [337e6, 343e6, 0.41, 0.010, 1.00],
                heat(875.0, 300.0, Some(877.0)),
            )
        },
        &[
            ("strength.johnson_cook.shear_modulus", LIKE_2024),
            ("strength.johnson_cook.reference_rate", RATE),
            ("thermal.reference_temperature", ROOM),
            ("eos", LIKE_2024),
            ("density", ASSUMED_7039),
            ("thermal.specific_heat", ASSUMED_7039),
            ("", JOHNSON_COOK),
        ];
    "beryllium", "beryllium, constant yield stress":
        {
            let metal = Metal {
                density: 1845.0,
                shear_modulus: 151e9,
                hugoniot: [7998.0, 1.124, 1.11, 0.16],
                curvature: [0.0; 2],
            };
            von_mises(&metal, 0.33e9, heat(1755.0, 300.0, Some(1560.0)))
        },
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("thermal.reference_temperature", ROOM),
            ("thermal.melting_temperature", "melting point of the element"),
            ("thermal", KINSLOW),
            ("", VERNEY),
        ];
    "copper", "copper OFHC half-hard, constant yield stress":
        von_mises(&COPPER, 0.12e9, heat(383.0, 300.0, Some(1356.0))),
        simple!(UINTAH, JOHNSON_COOK);
    "copper-johnson-cook", "copper OFHC":
        jc(&COPPER, [90e6, 292e6, 0.31, 0.025, 1.09], heat(383.0, 300.0, Some(1356.0))),
        johnson_cook!(UINTAH, UINTAH, JOHNSON_COOK);
    "copper-steinberg-guinan", "copper OFHC half-hard":
        sg(
            &COPPER,
            [0.12e9, 0.64e9, 36.0, 0.45],
            [2.83e-11, 3.77e-4, 1790.0, 1.5],
            heat(383.0, 300.0, None),
        ),
        steinberg!(JOHNSON_COOK);
    "steel-304", "stainless steel 304, constant yield stress":
        von_mises(&STEEL_304, 0.34e9, heat(500.0, 300.0, Some(1673.0))),
        simple!(SPHERAL, ASSUMED);
    "steel-4340-johnson-cook", "steel 4340 (Rockwell C 30)":
        jc(&STEEL_4340, [792e6, 510e6, 0.26, 0.014, 1.03], heat(477.0, 300.0, Some(1793.0))),
        &[
            (
                "strength.johnson_cook.shear_modulus",
                "assumed: E = 200 GPa, ν = .29, round values of low-alloy steel",
            ),
            ("strength.johnson_cook.reference_rate", RATE),
            ("thermal.reference_temperature", ROOM),
            ("eos.mie_gruneisen.b", "no volume dependence of γρ assumed"),
            ("eos", MARSH),
            ("", JOHNSON_COOK),
        ];
    "tungsten", "tungsten, constant yield stress":
        von_mises(&TUNGSTEN, 2.2e9, heat(129.0, 300.0, None)),
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("strength", UINTAH),
            ("thermal.reference_temperature", ROOM),
            ("", STEINBERG),
        ];
    "tungsten-steinberg-guinan", "tungsten":
        sg(
            &TUNGSTEN,
            [2.2e9, 4.0e9, 24.0, 0.19],
            [9.38e-12, 1.38e-4, 4520.0, 1.3],
            heat(129.0, 300.0, None),
        ),
        &[
            ("strength.steinberg_guinan.a", LIKE_ALLOY),
            ("strength", UINTAH),
            ("thermal.reference_temperature", ROOM),
            ("", STEINBERG),
        ];
}

pub(super) const AL_2024: Metal = Metal {
    density: 2785.0,
    shear_modulus: 28.6e9,
    hugoniot: [5328.0, 1.338, 2.00, 0.48],
    curvature: [0.0; 2],
};

pub(super) const AL_6061: Metal = Metal {
    density: 2703.0,
    shear_modulus: 27.6e9,
    hugoniot: [5240.0, 1.40, 1.97, 0.48],
    curvature: [0.0; 2],
};

pub(super) const COPPER: Metal = Metal {
    density: 8930.0,
    shear_modulus: 47.7e9,
    hugoniot: [3940.0, 1.489, 2.02, 0.47],
    curvature: [0.0; 2],
};

const STEEL_304: Metal = Metal {
    density: 7900.0,
    shear_modulus: 77.0e9,
    hugoniot: [4570.0, 1.49, 1.93, 0.50],
    curvature: [0.0; 2],
};

pub(super) const STEEL_4340: Metal = Metal {
    density: 7830.0,
    shear_modulus: 77.5e9,
    hugoniot: [3574.0, 1.92, 1.69, 0.0],
    curvature: [0.0; 2],
};

const TUNGSTEN: Metal = Metal {
    density: 19300.0,
    shear_modulus: 160.0e9,
    hugoniot: [4030.0, 1.237, 1.67, 0.38],
    curvature: [0.0; 2],
};
