//! Plastics of projectiles, sabots, windows and films, and gelatine: shock states that are measured, strengths in round
//! numbers.

use super::metal::{Metal, von_mises};
use super::{Parts, heat};
use crate::{Eos, Failure, Polynomial, Strength, VonMises};

const KEPT: &str = "no hardening";
const ROOM: &str = "300 K, to which the other constants belong";
const CONSTANT_GAMMA: &str = "no volume dependence of γρ assumed";
const NYLON: &str = "nylon 6/6 of Steinberg, UCRL-MA-106439 (1996), in Uintah";
const NYLON_ROUND: &str = "assumed: dry nylon 6/6, E = 3 GPa, ν = .4, yield 80 MPa, melting at 538 K, \
     round values from no one source";
const PMMA: &str = "Kinslow (1970), High-Velocity Impact Phenomena, as a public table of Hugoniots \
     quotes it; Marsh (1980) has 1186 kg/m^3, 2598 m/s, 1.516";
const PMMA_SHEAR: &str = "ρ c_s² with 1401 m/s of Barker & Hollenbach (1970), J. Appl. Phys. 41, 4208; \
     not checked against the paper";
const PMMA_YIELD: &str =
    "Lucite of Steinberg, UCRL-MA-106439 (1996); not checked against the report";
const POLYCARBONATE: &str = "Lexan of Steinberg, UCRL-MA-106439 (1996), as FronTier's table of equations of state and Uintah quote it";
const POLYCARBONATE_HEAT: &str = "MatConstLexan.xml of Uintah; it softens at 418 K";
const POLYCARBONATE_YIELD: &str = "IsoPlasticLexan.xml of Uintah";
const POLYCARBONATE_SHEAR: &str = "assumed: E = 2.4 GPa, ν = .37, round values from no one source";
const GELATINE: &str = "gelatine of 10 % of Zochowski (2019), 12th European LS-DYNA Conf., as a collection of cards \
     quotes it, in MPa; it deletes elements beyond a plastic strain of .9";
const GELATINE_STATES: &str = "Wen et al. (2013), Int. J. Impact Eng. 62, 142, as commonly quoted, not compared with the paper: \
     U = 1520 m/s + 2 u to the third order";
const COLD: &str = "none: the law has no heat";
const KAPTON: &str = "data sheet of Kapton HN, DuPont, at 23 °C";
const KAPTON_SHEAR: &str = "data sheet of Kapton HN, DuPont: E = 2.5 GPa, ν = .34";
const KAPTON_YIELD: &str = "data sheet of Kapton HN, DuPont: yield point at a strain of 3 %";
const POLYIMIDE: &str = "two-stage gun: Measurement of the Mie-Grüneisen equation of state for polyimide, abstract: 2.62 ± .22 km/s, \
     1.25 ± .063, 1.53 ± .135";

records! {
    "gelatine", "gelatine of 10 %, constant yield stress":
        Parts {
            density: 1030.0,
            eos: Eos::Polynomial(Polynomial {
                k1: 2.38e9,
                k2: 7.14e9,
                k3: 11.9e9,
                gamma0: 0.0,
            }),
            strength: Strength::VonMises(VonMises {
                shear_modulus: 0.85e6,
                yield_stress: 0.22e6,
                hardening_modulus: 1e3,
            }),
            thermal: None,
            failure: Failure::NONE,
        },
        &[
            ("eos.polynomial.gamma0", COLD),
            ("eos", GELATINE_STATES),
            ("", GELATINE),
        ];
    "kapton", "polyimide film (Kapton HN), constant yield stress":
        {
            let kapton = Metal {
                density: 1420.0,
                shear_modulus: 0.933e9,
                hugoniot: [2620.0, 1.25, 1.53, 0.0],
                curvature: [0.0; 2],
            };
            von_mises(&kapton, 69e6, heat(1090.0, 300.0, None))
        },
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("strength.von_mises.shear_modulus", KAPTON_SHEAR),
            ("strength", KAPTON_YIELD),
            ("thermal.reference_temperature", ROOM),
            ("eos.mie_gruneisen.b", CONSTANT_GAMMA),
            ("eos", POLYIMIDE),
            ("", KAPTON),
        ];
    "nylon", "nylon 6/6, constant yield stress":
        {
            let nylon = Metal {
                density: 1140.0,
                shear_modulus: 1.07e9,
                hugoniot: [2208.0, 2.83, 0.7, 0.0],
                curvature: [-3.18, 1.177],
            };
            von_mises(&nylon, 0.08e9, heat(1670.0, 300.0, Some(538.0)))
        },
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("thermal.reference_temperature", ROOM),
            ("eos.mie_gruneisen.b", CONSTANT_GAMMA),
            ("eos", NYLON),
            ("", NYLON_ROUND),
        ];
    "pmma", "PMMA (Plexiglas, Lucite), constant yield stress":
        {
            let pmma = Metal {
                density: 1185.0,
                shear_modulus: 2.33e9,
                hugoniot: [2572.0, 1.536, 0.97, 0.0],
                curvature: [0.0; 2],
            };
            von_mises(&pmma, 0.42e9, heat(1469.0, 300.0, None))
        },
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("strength.von_mises.shear_modulus", PMMA_SHEAR),
            ("strength", PMMA_YIELD),
            ("thermal.reference_temperature", ROOM),
            ("eos.mie_gruneisen.b", CONSTANT_GAMMA),
            ("", PMMA),
        ];
    "polycarbonate", "polycarbonate (Lexan), constant yield stress":
        {
            let polycarbonate = Metal {
                density: 1196.0,
                shear_modulus: 0.876e9,
                hugoniot: [1933.0, 3.49, 0.61, 0.0],
                curvature: [-8.2, 9.6],
            };
            von_mises(&polycarbonate, 0.1e9, heat(1200.0, 300.0, Some(418.0)))
        },
        &[
            ("strength.von_mises.hardening_modulus", KEPT),
            ("strength.von_mises.shear_modulus", POLYCARBONATE_SHEAR),
            ("strength", POLYCARBONATE_YIELD),
            ("thermal.reference_temperature", ROOM),
            ("thermal", POLYCARBONATE_HEAT),
            ("", POLYCARBONATE),
        ];
}
