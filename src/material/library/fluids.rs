//! Liquids and gases.

use super::{Parts, heat};
use crate::{Eos, Failure, IdealGas, Strength, Tait, Viscous};

const ATMOSPHERE: &str = "U.S. Standard Atmosphere (1976), sea level";
const DIATOMIC: &str = "ideal gas of two atoms: γ = 7/5, c_v = R/(γ − 1) with R = 287.053 J/(kg K)";
const CAVITATES: &str = "no tension: it cavitates";
const NONE: &str = "none";
const WATER: &str = "water at 20 °C, c = 1483 m/s: Chaplin, Water structure and science, table of \
     physical properties";
const COLE: &str = "Cole (1948), Underwater explosions; Monaghan (1994), J. Comput. Phys. 110, 399";

records! {
    "air", "air at sea level as an ideal gas":
        Parts {
            density: 1.225,
            eos: Eos::IdealGas(IdealGas {
                    gamma: 1.4,
                    stiffening_pressure: 0.0,
                    reference_pressure: 101_325.0,
                }),
            strength: Strength::None,
            thermal: Some(heat(717.63, 288.15, None)),
            failure: Failure::NONE,
        },
        &[
            ("eos.ideal_gas.gamma", DIATOMIC),
            ("eos.ideal_gas.stiffening_pressure", NONE),
            ("thermal.specific_heat", DIATOMIC),
            ("strength", NONE),
            ("", ATMOSPHERE),
        ];
    "water", "water by Tait's law; lower its sound speed for free-surface flow":
        Parts {
            density: 998.2,
            eos: Eos::Tait(Tait::with_sound_speed(998.2, 1483.0, 7.0)),
            strength: Strength::Viscous(Viscous {
                    viscosity: 1.002e-3,
                }),
            thermal: None,
            failure: Failure::CAVITATES,
        },
        &[("eos.tait.gamma", COLE), ("failure", CAVITATES), ("", WATER)];
}
