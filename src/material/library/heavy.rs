//! Heavy metals of penetrators, liners and tests of vapour, and magnesium: Steinberg–Guinan strength, and its initial yield
//! stress kept constant.

use super::heat;
use super::metal::{Metal, jc, sg, von_mises};

const UINTAH: &str = "Steinberg-Guinan constants in Uintah, citing Steinberg, UCRL-MA-106439";
const STEINBERG: &str =
    "Steinberg, UCRL-MA-106439, as FronTier's table of equations of state quotes it";
const TANTALUM: &str = "Steinberg-Guinan constants in Uintah, citing Steinberg, UCRL-MA-106439; another \
     table has β = 10, n = .1";
const DIFFERENCE: &str = "γ₀ − b, as in the records of Steinberg that have it, to .06";
const MEYERS: &str = "Meyers (1994), Dynamic Behavior of Materials, as a public table of Hugoniots quotes it: linear, \
     since the cubic of Steinberg (1996) loses pressure beyond some 170 GPa";
const JOHNSON_COOK: &str = "tungsten alloy (7 % Ni, 3 % Fe) of Johnson & Cook (1983), Proc. 7th Int. Symp. \
     Ballistics, 541, as Uintah quotes it";
const BINDER: &str = "that of the binder, Johnson & Cook (1983), as other programs quote it; Uintah has 3695 K, of \
     pure tungsten";
const ROOM: &str = "300 K, to which the other constants belong";
const RATE: &str = "1/s, as in Johnson & Cook (1983)";
const KEPT: &str = "no hardening: the initial yield stress is kept";
const CONSTANT_GAMMA: &str = "no volume dependence of γρ assumed";
const MELTS: &str = "melting point of the element";

/// Sources of a record with Steinberg–Guinan strength; before them those of single keys.
macro_rules! steinberg {
    ($($key:literal: $own:expr),*) => {
        &[
            $( ($key, $own), )*
            ("thermal.reference_temperature", ROOM),
            ("", UINTAH),
        ]
    };
}

/// Sources of a record with von Mises strength; before them those of single keys.
macro_rules! simple {
    ($($key:literal: $own:expr),*) => {
        &[
            $( ($key, $own), )*
            ("strength.von_mises.hardening_modulus", KEPT),
            ("thermal.reference_temperature", ROOM),
            ("thermal.melting_temperature", MELTS),
            ("", UINTAH),
        ]
    };
}

records! {
    "cadmium", "cadmium, constant yield stress":
        von_mises(&CADMIUM, 0.04e9, heat(231.0, 300.0, Some(594.0))),
        simple!();
    "cadmium-steinberg-guinan", "cadmium":
        sg(
            &CADMIUM,
            [0.04e9, 0.6e9, 40.0, 0.75],
            [8.75e-11, 14.6e-4, 770.0, 1.95],
            heat(231.0, 300.0, None),
        ),
        steinberg!();
    "lead", "lead, constant yield stress":
        von_mises(&LEAD, 0.008e9, heat(124.0, 300.0, Some(601.0))),
        simple!(
            "eos.mie_gruneisen.b": CONSTANT_GAMMA,
            "eos": MEYERS,
            "density": MEYERS
        );
    "lead-steinberg-guinan", "lead":
        sg(
            &LEAD,
            [0.008e9, 0.1e9, 110.0, 0.52],
            [11.63e-11, 1.16e-3, 760.0, 2.2],
            heat(124.0, 300.0, None),
        ),
        steinberg!(
            "strength.steinberg_guinan.a": DIFFERENCE,
            "strength.steinberg_guinan.gamma0": MEYERS,
            "eos.mie_gruneisen.b": CONSTANT_GAMMA,
            "eos": MEYERS,
            "density": MEYERS
        );
    "magnesium-az31b", "magnesium AZ31B-H24, constant yield stress":
        von_mises(&MAGNESIUM_AZ31B, 0.19e9, heat(999.0, 300.0, Some(923.0))),
        simple!();
    "magnesium-az31b-steinberg-guinan", "magnesium AZ31B-H24":
        sg(
            &MAGNESIUM_AZ31B,
            [0.19e9, 0.48e9, 1100.0, 0.12],
            [10.3e-11, 5.09e-4, 1150.0, 1.2],
            heat(999.0, 300.0, None),
        ),
        steinberg!();
    "tantalum", "tantalum, constant yield stress":
        von_mises(&TA, 0.77e9, heat(135.0, 300.0, Some(3290.0))),
        simple!(
            "eos.mie_gruneisen.b": STEINBERG,
            "thermal.specific_heat": STEINBERG
        );
    "tantalum-steinberg-guinan", "tantalum":
        sg(
            &TA,
            [0.77e9, 1.1e9, 22.0, 0.283],
            [1.45e-11, 1.3e-4, 4340.0, 1.25],
            heat(135.0, 300.0, None),
        ),
        steinberg!(
            "strength.steinberg_guinan.a": DIFFERENCE,
            "strength": TANTALUM,
            "eos.mie_gruneisen.b": STEINBERG,
            "thermal.specific_heat": STEINBERG
        );
    "tungsten-alloy", "tungsten with 3.5 % nickel and 1.5 % iron, constant yield stress":
        von_mises(&TUNGSTEN_ALLOY, 1.87e9, heat(143.0, 300.0, None)),
        simple!();
    "tungsten-alloy-johnson-cook", "tungsten alloy of nickel and iron":
        jc(
            &TUNGSTEN_ALLOY,
            [1506.96e6, 176.64e6, 0.12, 0.016, 1.0],
            heat(134.0, 300.0, Some(1723.0)),
        ),
        &[
            ("strength.johnson_cook.shear_modulus", UINTAH),
            ("strength.johnson_cook.reference_rate", RATE),
            ("thermal.reference_temperature", ROOM),
            ("thermal", BINDER),
            ("eos", UINTAH),
            ("density", UINTAH),
            ("", JOHNSON_COOK),
        ];
    "tungsten-alloy-steinberg-guinan", "tungsten with 3.5 % nickel and 1.5 % iron":
        sg(
            &TUNGSTEN_ALLOY,
            [1.87e9, 4.0e9, 7.7, 0.13],
            [1.03e-11, 1.52e-4, 2263.0, 1.3],
            heat(143.0, 300.0, None),
        ),
        steinberg!();
    "uranium-titanium", "uranium with .75 % titanium, constant yield stress":
        von_mises(&URANIUM_TITANIUM, 0.95e9, heat(111.0, 300.0, Some(1408.0))),
        simple!("thermal.melting_temperature": "melting point of uranium");
    "uranium-titanium-steinberg-guinan", "uranium with .75 % titanium":
        sg(
            &URANIUM_TITANIUM,
            [0.95e9, 2.2e9, 1000.0, 0.095],
            [5.88e-11, 7.84e-4, 1710.0, 1.8],
            heat(111.0, 300.0, None),
        ),
        steinberg!();
    "zinc", "zinc, constant yield stress":
        von_mises(&ZINC, 0.15e9, heat(389.0, 300.0, Some(693.0))),
        simple!();
    "zinc-steinberg-guinan", "zinc":
        sg(
            &ZINC,
            [0.15e9, 0.92e9, 100.0, 0.2],
            [5.95e-11, 7.6e-4, 900.0, 1.7],
            heat(389.0, 300.0, None),
        ),
        steinberg!();
}

const CADMIUM: Metal = Metal {
    density: 8639.0,
    shear_modulus: 24e9,
    hugoniot: [2480.0, 1.64, 2.5, 0.55],
    curvature: [0.0; 2],
};

const LEAD: Metal = Metal {
    density: 11350.0,
    shear_modulus: 8.6e9,
    hugoniot: [2050.0, 1.46, 2.8, 0.0],
    curvature: [0.0; 2],
};

const MAGNESIUM_AZ31B: Metal = Metal {
    density: 1780.0,
    shear_modulus: 16.5e9,
    hugoniot: [4520.0, 1.242, 1.54, 0.33],
    curvature: [0.0; 2],
};

const TA: Metal = Metal {
    density: 16690.0,
    shear_modulus: 69e9,
    hugoniot: [3410.0, 1.2, 1.67, 0.42],
    curvature: [0.0; 2],
};

const TUNGSTEN_ALLOY: Metal = Metal {
    density: 18167.0,
    shear_modulus: 145e9,
    hugoniot: [4030.0, 1.237, 1.67, 0.38],
    curvature: [0.0; 2],
};

const URANIUM_TITANIUM: Metal = Metal {
    density: 18620.0,
    shear_modulus: 74e9,
    hugoniot: [2567.0, 1.619, 2.32, 0.57],
    curvature: [0.0; 2],
};

const ZINC: Metal = Metal {
    density: 7139.0,
    shear_modulus: 39.5e9,
    hugoniot: [3030.0, 1.55, 2.24, 0.52],
    curvature: [0.0; 2],
};
