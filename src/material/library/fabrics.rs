//! Dry cloth, and cores of walls, homogenised: members along directions, with pores between.

use super::Parts;
use crate::{
    Compaction, Eos, Failure, MieGruneisen, PAlpha, Porosity, Strength, StrengthOf, Uncoupled,
    UncoupledFailure,
};

const NEXTEL: &str = "3M Nextel 312: 2700 kg/m³, E 150 GPa, strength of filaments 1.7 GPa, as commonly quoted; not checked against its data sheet";
const NEXTEL_HALF: &str = "half of the 150 GPa of the filaments of 3M Nextel 312, as commonly quoted: half of them run either way";
const NEXTEL_STRENGTH: &str = "a quarter of the 1.7 GPa of the filaments of 3M Nextel 312, as commonly quoted: half of them run either way, and assumed: half of \
     the strength is left in yarns and weave";
const NEXTEL_SHOCK: &str =
    "assumed: the bulk modulus of E = 150 GPa with ν = .25; slope and γ₀ of no one source";
const NEXTEL_PORES: &str = "assumed: 40 % of cloth are fibres, so that 1 kg/m², as AF-62 commonly is said to have, is .93 mm thick; pressures and speed of pores \
     of no one source";
const KEVLAR: &str = "DuPont Kevlar 129: 1440 kg/m³, E 97 GPa, strength of yarns 3.4 GPa, as commonly quoted; not checked against its data sheet";
const KEVLAR_HALF: &str = "half of the 97 GPa of the yarns of DuPont Kevlar 129, as commonly quoted: half of them run either way";
const KEVLAR_STRENGTH: &str = "half of the 3.4 GPa of the yarns of DuPont Kevlar 129, as commonly quoted: half of them run either way";
const KEVLAR_SHOCK: &str = "of nylon 6/6, another polyamide, as an approximation: Steinberg, UCRL-MA-106439 (1996), in Uintah";
const KEVLAR_PORES: &str = "assumed: 53 % of cloth are fibres, so that .32 kg/m², as style 710 commonly is said to have, is .42 mm thick; pressures and speed of \
     pores of no one source";
const SLIP: &str = "assumed: yarns hardly resist shear";
const TEARING: &str = "assumed: some times the elastic energy of yarns of a millimetre";
const BUCKLES: &str = "what is pressed buckles";
const NONE: &str = "no yarns across the cloth";
const CORE: &str = "Hexcel 5052, 3/16 in cells, .001 in foil, 3.1 lb/ft³: strength and moduli of its tables of 1999, as commonly quoted; not checked against \
     them";
const CORE_PLATEAU: &str = "with the .02 MPa of the pores the crush strength (130 psi) of Hexcel 5052, 3/16 in cells, .001 in foil, 3.1 lb/ft³, as commonly quoted; not checked against its tables";
const CORE_ACROSS: &str = "assumed: walls bend across the cells";
const CORE_TENSION: &str = "assumed: foils of 5052 at 280 MPa, which fill 1/54 of the core";
const CORE_SHOCK: &str = "of aluminium 6061, as an approximation: Steinberg-Guinan constants in Uintah, citing Steinberg, UCRL-MA-106439";
const CORE_PORES: &str = "assumed: 50 kg/m³ of walls of 2680 kg/m³, of which .2 MPa leave a quarter of the volume; speed of no one source";

/// Shock data: c₀ (m/s), the slopes s₁ to s₃, and γ₀.
fn shock(c0: f64, [s1, s2, s3]: [f64; 3], gamma0: f64) -> Eos {
    Eos::MieGruneisen(MieGruneisen {
        c0,
        s1,
        s2,
        s3,
        gamma0,
        b: 0.0,
    })
}

/// Plain weave of yarns of a modulus and a strength (Pa) each way, which take an energy (J/m²) to tear.
fn weave(density: f64, eos: Eos, [modulus, strength, energy]: [f64; 3]) -> Parts {
    Parts {
        density,
        eos,
        strength: Strength::Uncoupled(Uncoupled {
            e1: modulus,
            e2: modulus,
            e3: 0.0,
            g12: 0.1e9,
            g13: 0.1e9,
            g23: 0.1e9,
            c1: 0.0,
            c2: 0.0,
            c3: 0.0,
            s12: 2e6,
            s13: 2e6,
            s23: 2e6,
        }),
        thermal: None,
        failure: Failure {
            uncoupled: Some(UncoupledFailure {
                t1: strength,
                t2: strength,
                t3: 0.0,
                gf1: energy,
                gf2: energy,
                gf3: 0.0,
            }),
            ..Failure::NONE
        },
    }
}

/// Sources of cloth: of its shock data, pores, moduli and strength, and of the rest.
macro_rules! cloth {
    ($shock:expr, $pores:expr, $modulus:expr, $strength:expr, $rest:expr) => {
        &[
            ("eos", $shock),
            ("porosity", $pores),
            ("strength.uncoupled.e3", NONE),
            ("strength.uncoupled.e", $modulus),
            ("strength.uncoupled.g", SLIP),
            ("strength.uncoupled.s", SLIP),
            ("strength.uncoupled.c", BUCKLES),
            ("failure.uncoupled.t3", NONE),
            ("failure.uncoupled.gf3", NONE),
            ("failure.uncoupled.t", $strength),
            ("failure.uncoupled.gf", TEARING),
            ("", $rest),
        ]
    };
}

records! {
    "nextel-312-fabric", "dry cloth of Nextel 312 fibres, as AF-62":
        weave(2700.0, shock(6090.0, [1.5, 0.0, 0.0], 1.5), [75e9, 425e6, 5e3]),
        cloth!(NEXTEL_SHOCK, NEXTEL_PORES, NEXTEL_HALF, NEXTEL_STRENGTH, NEXTEL);
    "kevlar-fabric", "dry cloth of Kevlar 129 yarns, as style 710":
        weave(1440.0, shock(2208.0, [2.83, -3.18, 1.177], 0.7), [48.5e9, 1.7e9, 60e3]),
        cloth!(KEVLAR_SHOCK, KEVLAR_PORES, KEVLAR_HALF, KEVLAR_STRENGTH, KEVLAR);
    "aluminium-honeycomb", "core of foils of aluminium 5052, homogenised, cells along direction 3":
        Parts {
            density: 2680.0,
            eos: shock(5240.0, [1.4, 0.0, 0.0], 1.97),
            strength: Strength::Uncoupled(Uncoupled {
                e1: 1e6,
                e2: 1e6,
                e3: 517e6,
                g12: 1e6,
                g13: 310e6,
                g23: 152e6,
                c1: 0.02e6,
                c2: 0.02e6,
                c3: 0.88e6,
                s12: 0.02e6,
                s13: 1.45e6,
                s23: 0.9e6,
            }),
            thermal: None,
            failure: Failure {
                uncoupled: Some(UncoupledFailure {
                    t1: 0.1e6,
                    t2: 0.1e6,
                    t3: 5.2e6,
                    gf1: 1e3,
                    gf2: 1e3,
                    gf3: 1e3,
                }),
                ..Failure::NONE
            },
        },
        &[
            ("eos", CORE_SHOCK),
            ("porosity", CORE_PORES),
            ("strength.uncoupled.c3", CORE_PLATEAU),
            ("strength.uncoupled.c", CORE_ACROSS),
            ("strength.uncoupled.e1", CORE_ACROSS),
            ("strength.uncoupled.e2", CORE_ACROSS),
            ("strength.uncoupled.g12", CORE_ACROSS),
            ("strength.uncoupled.s12", CORE_ACROSS),
            ("failure.uncoupled.t3", CORE_TENSION),
            ("failure", CORE_ACROSS),
            ("", CORE),
        ];
}

/// Pores of the record of a name, in a solid of this density (kg/m³).
pub(super) fn of(name: &str, density: f64, eos: &Eos) -> Option<Porosity> {
    let p_alpha = |elastic_pressure: f64, solid_pressure: f64, sound_speed: f64| PAlpha {
        elastic_pressure,
        solid_pressure,
        exponent: 2.0,
        transition_pressure: 0.0,
        transition_distension: 1.0,
        transition_exponent: 2.0,
        sound_speed,
    };
    let (distension, law, strength) = match name {
        "nextel-312-fabric" => (2.5, p_alpha(1e6, 100e6, 1500.0), StrengthOf::Matrix),
        "kevlar-fabric" => (1.9, p_alpha(0.5e6, 50e6, 1000.0), StrengthOf::Matrix),
        "aluminium-honeycomb" => (
            53.6,
            PAlpha {
                transition_pressure: 0.2e6,
                transition_distension: 13.0,
                ..p_alpha(0.02e6, 50e6, 2500.0)
            },
            StrengthOf::Whole,
        ),
        _ => return None,
    };
    let law = Compaction::PAlpha(law);
    Some(Porosity {
        strength,
        ..Porosity::new(distension, law, density, eos)
    })
}

#[cfg(test)]
mod tests {
    use crate::library;

    #[test]
    fn pores_go_with_their_solids() {
        for record in super::RECORDS {
            let pores = library::find(record.name).and_then(|material| material.porosity);
            let pores = pores.expect("pores");
            let wrong = pores.law.contradicts(pores.distension, &pores.solid);
            assert_eq!(wrong, None, "{}", record.name);
            // As body.areal_density may have it.
            let light = 1.8 * pores.distension;
            let wrong = pores.law.contradicts(light, &pores.solid);
            assert_eq!(wrong, None, "{}, light", record.name);
        }
    }
}
