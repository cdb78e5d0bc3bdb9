//! Metals with the ductile failure of Johnson and Cook, each with the strength that its failure was
//! fitted beside where that is known.

use super::alloys::{AL_5083, AL_7075, IRON_ALPHA, IRON_ELASTIC, MARSH, TI_6AL_4V, WELDOX_460E};
use super::metal::{jc, jc_of_rate};
use super::metals::{AL_2024, AL_6061, COPPER, STEEL_4340};
use super::{Parts, heat};
use crate::{AfterSpall, Coupling, Effect, Failure, JohnsonCookFailure, RateForm, Spall};

const UINTAH: &str = "Steinberg-Guinan constants in Uintah, citing Steinberg, UCRL-MA-106439";
const STEINBERG: &str =
    "Steinberg, UCRL-MA-106439 (1996), as a public table of Hugoniots quotes it";
const LIKE_6061: &str = "of aluminium 6061, as an approximation: Steinberg-Guinan constants in \
     Uintah, citing Steinberg, UCRL-MA-106439";
const LIKE_4340: &str = "of steel 4340 (Rockwell C 38), as an approximation: Steinberg, \
     UCRL-MA-106439 (1996), as a public table of Hugoniots quotes it";
const IRON: &str = "Johnson & Cook (1983), Proc. 7th Int. Symp. Ballistics, 541, as WeldFormSPH quotes it; \
     Uintah has m = 1.44";
const JOHNSON_COOK_IRON: &str = "Johnson & Cook (1985), Eng. Fract. Mech. 21, 31; not checked against the \
     paper";
const JOHNSON_COOK: &str = "Johnson & Cook (1983), Proc. 7th Int. Symp. Ballistics, 541, as other \
     programs quote it";
const UINTAH_JC: &str = "Johnson-Cook constants in Uintah";
const JOHNSON_COOK_1985: &str =
    "Johnson & Cook (1985), Eng. Fract. Mech. 21, 31, as Uintah quotes it";
const LESUER_6061: &str = "Lesuer, Kay & LeBlanc (2001), UCRL-JC-134118, as Uintah quotes it";
const DECKS_2024: &str =
    "Johnson-Cook constants of 2024 that public decks have beside this failure";
const KAY: &str = "Kay (2003), DOT/FAA/AR-03/57; others print .27 for D₂ and .48 for D₃";
const LESUER: &str = "Lesuer (2000), DOT/FAA/AR-00/25; not checked against the report";
const BORVIK: &str = "Børvik et al. (2001, 2002), Eur. J. Mech. A 20, 685 and Int. J. Impact Eng. 27, \
     37; their (1 + ε̇*)^C is taken as 1 + C ln ε̇*";
const BORVIK_FAILURE: &str = "Børvik et al. (2001), Eur. J. Mech. A 20, 685; in 2002 D₄ is -.015";
const BAND: &str =
    "fitted to plugs of two shots of Børvik et al. (1999), Int. J. Impact Eng. 22, 855";
const CLAUSEN: &str = "Clausen et al. (2004), Mater. Sci. Eng. A 364, 260, plates of 5083-H116; not \
     checked against the paper";
const BRAR: &str = "Brar, Joshi & Harris (2009), AIP Conf. Proc. 1195, 945, of 7075-T651; not checked \
     against the paper";
const LIQUIDUS_7075: &str = "liquidus of 7075 (635 °C), assumed";
const ROOM: &str = "300 K, to which the other constants belong";
const RATE: &str = "1/s, as in Johnson & Cook (1983)";
const CONSTANT_GAMMA: &str = "no volume dependence of γρ assumed";
const FLOOR: &str = "assumed: fits may fall below zero where tension is high";
const OPEN: &str = "none: beyond the tests of the fit a spall limit rules";
const SPALL: &str = "assumed: the middle of what plate impacts are reported to give at some 1e5/s \
     (2024 1.1-1.7, 6061 1.0-1.6, copper 1.2-2.0, 4340 2.6-5.0 GPa); it grows with the rate";
const WIERZBICKI: &str = "Wierzbicki, Bao, Lee & Bai (2005), Int. J. Mech. Sci. 47, 719, of 2024-T351 in round \
     bars, slowly and at room temperature; not checked against the paper";
const TOUGH_2024: &str = "K² (1 − ν²)/E of a plane-strain fracture toughness of 40 MPa m^1/2";
const TOUGH_6061: &str = "K² (1 − ν²)/E of a plane-strain fracture toughness of 29 MPa m^1/2";
const TOUGH_COPPER: &str = "assumed: some 90 MPa m^1/2 as K² (1 − ν²)/E";
const TOUGH_4340: &str = "assumed: some 110 MPa m^1/2 of a soft temper as K² (1 − ν²)/E";
const TOUGH_5083: &str = "assumed: some 43 MPa m^1/2 as K² (1 − ν²)/E";
const TOUGH_7075: &str = "K² (1 − ν²)/E of a plane-strain fracture toughness of 29 MPa m^1/2";
const TOUGH_IRON: &str = "assumed: some 100 MPa m^1/2 as K² (1 − ν²)/E";
const TOUGH_TI: &str = "assumed: some 66 MPa m^1/2 as K² (1 − ν²)/E";
const SPALL_ABOUT: &str = "assumed: about what plate impacts are reported to give at some 1e5/s; not compared with papers; it \
     grows with the rate";
const SHEAR_4340: &str = "assumed: E = 200 GPa, ν = .29, round values of low-alloy steel";
const SHEAR_5083: &str = "E = 70 GPa, ν = .3, as those who fitted the strength take them";
const SHEAR_460E: &str = "E = 200 GPa, ν = .33, as those who fitted the strength take them";
const SHEAR_TI: &str = "E = 113.8 GPa, ν = .342 (MatWeb)";

/// Sources of failure, shear modulus, Hugoniot with density, and strength with heat; before them those of
/// single keys.
macro_rules! sources {
    ($failure:expr, $shear:expr, $hugoniot:expr, $strength:expr $(, $key:literal: $own:expr)*) => {
        &[
            $( ($key, $own), )*
            ("failure.johnson_cook.least_strain", FLOOR),
            ("failure.johnson_cook.spall_stress", OPEN),
            ("failure.spall", SPALL),
            ("failure", $failure),
            ("strength.johnson_cook.shear_modulus", $shear),
            ("eos", $hugoniot),
            ("", $strength),
        ]
    };
}

records! {
    "aluminium-2024-ductile", "aluminium 2024-T351, Johnson-Cook strength and failure":
        failing(
            jc(&AL_2024, [369e6, 684e6, 0.73, 0.0083, 1.7], heat(875.0, 300.0, Some(775.0))),
            [-0.07, 1.02, -1.62, 0.0, 0.0],
        )
        .spalling(1.4e9, 20e3),
        sources!(
            WIERZBICKI, UINTAH, UINTAH, DECKS_2024,
            "failure.fracture_energy": TOUGH_2024,
            "density": UINTAH,
            "strength.johnson_cook.reference_rate": RATE,
            "thermal.reference_temperature": ROOM,
            "thermal": JOHNSON_COOK
        );
    "aluminium-5083-ductile", "aluminium 5083-H116, Johnson-Cook strength and failure":
        failing(
            jc(&AL_5083, [167e6, 596e6, 0.551, 0.001, 0.859], heat(910.0, 293.0, Some(893.0))),
            [0.0261, 0.263, -0.349, 0.247, 16.8],
        )
        .spalling(1e9, 24e3),
        sources!(
            CLAUSEN, SHEAR_5083, LIKE_6061, CLAUSEN,
            "failure.fracture_energy": TOUGH_5083,
            "failure.spall": SPALL_ABOUT
        );
    "aluminium-6061-ductile", "aluminium 6061-T6, Johnson-Cook strength and failure":
        failing(
            jc(&AL_6061, [324e6, 114e6, 0.42, 0.002, 1.34], heat(896.0, 300.0, Some(925.0))),
            [-0.77, 1.45, -0.47, 0.0, 1.60],
        )
        .spalling(1.3e9, 11e3),
        sources!(
            LESUER_6061, UINTAH, UINTAH, UINTAH_JC,
            "failure.fracture_energy": TOUGH_6061,
            "density": UINTAH,
            "strength.johnson_cook.reference_rate": RATE,
            "thermal.reference_temperature": ROOM
        );
    "aluminium-7075-ductile", "aluminium 7075-T651, Johnson-Cook strength and failure":
        failing(
            jc(&AL_7075, [546e6, 678e6, 0.71, 0.024, 1.56], heat(848.0, 300.0, Some(908.0))),
            [-0.068, 0.451, -0.952, 0.036, 0.697],
        )
        .spalling(1.4e9, 10e3),
        sources!(
            BRAR, STEINBERG, STEINBERG, BRAR,
            "failure.fracture_energy": TOUGH_7075,
            "failure.spall": SPALL_ABOUT,
            "density": STEINBERG,
            "strength.johnson_cook.reference_rate": RATE,
            "thermal.reference_temperature": ROOM,
            "thermal.melting_temperature": LIQUIDUS_7075,
            "thermal": STEINBERG
        );
    "copper-ductile", "copper OFHC, Johnson-Cook strength and failure":
        failing(
            jc(&COPPER, [90e6, 292e6, 0.31, 0.025, 1.09], heat(383.0, 300.0, Some(1356.0))),
            [0.54, 4.89, -3.03, 0.014, 1.12],
        )
        .spalling(1.6e9, 60e3),
        sources!(
            JOHNSON_COOK_1985, UINTAH, UINTAH, JOHNSON_COOK,
            "failure.fracture_energy": TOUGH_COPPER,
            "density": UINTAH,
            "strength.johnson_cook.reference_rate": RATE,
            "thermal.reference_temperature": ROOM
        );
    "iron-armco-ductile", "Armco iron, Johnson-Cook strength and failure":
        failing(
            jc(&IRON_ALPHA, [175e6, 380e6, 0.32, 0.06, 0.55], heat(452.0, 300.0, Some(1811.0))),
            [-2.2, 5.43, -0.47, 0.016, 0.63],
        )
        .spalling(2.4e9, 44e3),
        sources!(
            JOHNSON_COOK_IRON, IRON_ELASTIC, MARSH, IRON,
            "failure.fracture_energy": TOUGH_IRON,
            "failure.spall": SPALL_ABOUT,
            "density": MARSH,
            "strength.johnson_cook.reference_rate": RATE,
            "thermal.reference_temperature": ROOM,
            "eos.mie_gruneisen.b": CONSTANT_GAMMA
        );
    "steel-4340-ductile", "steel 4340 (Rockwell C 30), Johnson-Cook strength and failure":
        failing(
            jc(&STEEL_4340, [792e6, 510e6, 0.26, 0.014, 1.03], heat(477.0, 300.0, Some(1793.0))),
            [0.05, 3.44, -2.12, 0.002, 0.61],
        )
        .spalling(3.8e9, 55e3),
        sources!(
            JOHNSON_COOK_1985, SHEAR_4340, MARSH, JOHNSON_COOK,
            "failure.fracture_energy": TOUGH_4340,
            "strength.johnson_cook.reference_rate": RATE,
            "thermal.reference_temperature": ROOM,
            "eos.mie_gruneisen.b": CONSTANT_GAMMA
        );
    "steel-weldox-460e-ductile", "steel Weldox 460 E, Johnson-Cook strength and failure":
        {
            let constants = [490e6, 807e6, 0.73, 0.0114, 0.94];
            let steel = jc_of_rate(&WELDOX_460E, 5e-4, constants, heat(452.0, 293.0, Some(1800.0)));
            let mut steel = failing(steel, [0.0705, 1.732, -0.54, -0.0123, 0.0]);
            if let Some(law) = &mut steel.failure.johnson_cook {
                law.reference_rate = 5e-4;
                law.rate_form = RateForm::Power;
                law.coupling = Coupling::Localised;
            }
            steel.failure.options.fracture_energy = 500e3;
            steel.failure.options.effect = Effect::Scaled;
            steel
        },
        sources!(
            BORVIK_FAILURE, SHEAR_460E, LIKE_4340, BORVIK,
            "failure.fracture_energy": BAND,
            "eos.mie_gruneisen.b": CONSTANT_GAMMA
        );
    "titanium-6al-4v-ductile", "titanium Ti-6Al-4V, Johnson-Cook strength and failure":
        failing(
            jc(&TI_6AL_4V, [1098e6, 1092e6, 0.93, 0.014, 1.1], heat(525.0, 300.0, Some(1878.0))),
            [-0.09, 0.25, -0.5, 0.014, 3.87],
        )
        .spalling(4.4e9, 34e3),
        sources!(
            KAY, SHEAR_TI, STEINBERG, LESUER,
            "failure.fracture_energy": TOUGH_TI,
            "failure.spall": SPALL_ABOUT,
            "density": STEINBERG,
            "strength.johnson_cook.reference_rate": RATE,
            "thermal.reference_temperature": ROOM,
            "thermal.specific_heat": STEINBERG,
            "eos.mie_gruneisen.b": CONSTANT_GAMMA
        );
}

/// Least failure strain, where a fit gives less: that of an input that says nothing.
const LEAST_STRAIN: f64 = 0.01;

/// The same material with failure by `[D₁, D₂, D₃, D₄, D₅]`, of a reference rate of 1/s.
fn failing(parts: Parts, [d1, d2, d3, d4, d5]: [f64; 5]) -> Parts {
    let law = JohnsonCookFailure {
        d1,
        d2,
        d3,
        d4,
        d5,
        reference_rate: 1.0,
        rate_form: RateForm::Logarithm,
        least_strain: LEAST_STRAIN,
        spall_stress: 0.0,
        coupling: Coupling::Uncoupled,
    };
    Parts {
        failure: Failure {
            johnson_cook: Some(law),
            ..Failure::NONE
        },
        ..parts
    }
}

impl Parts {
    /// The same with this spall strength (Pa), and this energy of its cracks (J/m²).
    fn spalling(mut self, strength: f64, energy: f64) -> Self {
        self.failure.spall = Some(Spall {
            pressure: -strength,
            after: AfterSpall::Failed,
        });
        self.failure.options.fracture_energy = energy;
        self.failure.options.effect = Effect::Scaled;
        self
    }
}

#[cfg(test)]
mod tests {
    use crate::library;

    /// Failure strains at the reference rate and temperature, at triaxialities −1/3, 0, 1/3 and 1:
    /// values computed apart from this code to four digits.
    #[test]
    fn failure_strains_are_those_of_the_fits() {
        let table = [
            ("aluminium-2024-ductile", [1.6803, 0.9500, 0.5244, 0.1319]),
            ("aluminium-6061-ductile", [0.9259, 0.6800, 0.4697, 0.1363]),
            ("copper-ductile", [13.97, 5.430, 2.321, 0.7763]),
            ("iron-armco-ductile", [4.151, 3.230, 2.443, 1.194]),
            ("steel-4340-ductile", [7.024, 3.490, 1.747, 0.4629]),
            ("steel-weldox-460e-ductile", [2.144, 1.8025, 1.517, 1.080]),
            ("titanium-6al-4v-ductile", [0.2053, 0.1600, 0.1216, 0.0616]),
        ];
        for (name, strains) in table {
            let material = library::find(name).unwrap();
            let law = material.failure.johnson_cook.unwrap();
            let thermal = material.thermal.as_ref().unwrap().constants();
            for (eta, expected) in [-1.0 / 3.0, 0.0, 1.0 / 3.0, 1.0].into_iter().zip(strains) {
                let temperature = thermal.reference_temperature;
                let found = law.failure_strain([-eta * 1e8, 1e8], 0.0, temperature, thermal);
                let part = found / expected - 1.0;
                assert!(part.abs() < 1e-3, "{name}, {eta}: {found} {expected}");
            }
        }
    }
}
