//! Tillotson's law of metals and rocks.

use super::Parts;
use crate::{Eos, Failure, Strength, Tillotson, VonMises};

const TILLOTSON: &str = "constants on which miluphcuda, SWIFT, Phantom, OpenSPH and Spheral agree; \
     metals of Tillotson (1962), GA-3216, rocks of Benz & Asphaug (1999), Icarus 142, 5";
const STEINBERG_6061: &str = "of aluminium 6061-T6: Steinberg-Guinan constants in Uintah, citing \
     Steinberg, UCRL-MA-106439";
const PLAIN: &str = "no hardening";
pub(super) const CUT: &str =
    "no spall limit ends tension: Schäfer et al. (2016), A&A 590, A19, have no pressure below it";
pub(super) const UNCUT: &str = "none: a spall limit ends tension";
const FLUID: &str = "without strength: its own is for the case to choose";
const OKAMOTO: &str = "Okamoto et al. (2020), as miluphcuda quotes it in polycarbonate.till.cfg";

records! {
    "aluminium-tillotson", "aluminium to vaporisation, strength of 6061-T6":
        aluminium(),
        &[
            ("strength.von_mises.hardening_modulus", PLAIN),
            ("strength", STEINBERG_6061),
            ("eos.tillotson.least_density", CUT),
            ("", TILLOTSON),
        ];
    "copper-tillotson", "copper to vaporisation, without strength":
        {
            tillotson(
                8900.0,
                [0.5, 1.5, 139e9, 110e9],
                [32.5e6, 1.35e6, 3e6],
                [0.0; 2],
            )
        },
        &[("strength", FLUID), ("eos.tillotson.least_density", CUT), ("", TILLOTSON)];
    "granite-tillotson", "granite to vaporisation, without strength":
        {
            tillotson(
                2680.0,
                [0.5, 1.3, 18e9, 18e9],
                [16e6, 3.5e6, 18e6],
                [0.0; 2],
            )
        },
        &[("strength", FLUID), ("eos.tillotson.least_density", CUT), ("", TILLOTSON)];
    "iron-tillotson", "iron to vaporisation, without strength":
        {
            tillotson(
                7800.0,
                [0.5, 1.5, 128e9, 105e9],
                [9.5e6, 2.4e6, 8.67e6],
                [0.0; 2],
            )
        },
        &[("strength", FLUID), ("eos.tillotson.least_density", CUT), ("", TILLOTSON)];
    "polycarbonate-tillotson", "polycarbonate (Lexan) to vaporisation, without strength":
        {
            tillotson(
                1194.0,
                [0.5, 1.0, 9.2e9, 6.9e9],
                [2e6, 0.28e6, 1.3e6],
                [0.0; 2],
            )
        },
        &[("strength", FLUID), ("eos.tillotson.least_density", CUT), ("", OKAMOTO)];
}

/// Aluminium, with the strength of 6061-T6.
pub(super) fn aluminium() -> Parts {
    tillotson(
        2700.0,
        [0.5, 1.63, 75.2e9, 65e9],
        [5e6, 3e6, 13.9e6],
        [27.6e9, 0.29e9],
    )
}

/// Density (kg/m³), `[a, b, A (Pa), B (Pa)]`, `[E₀, e_iv, e_cv]` (J/kg), `[G, Y]` (Pa; zero for a
/// fluid); α = β = 5.
fn tillotson(
    density: f64,
    [a, b, bulk_modulus, quadratic_modulus]: [f64; 4],
    [e0, e_iv, e_cv]: [f64; 3],
    [shear_modulus, yield_stress]: [f64; 2],
) -> Parts {
    let strength = if shear_modulus > 0.0 {
        Strength::VonMises(VonMises {
            shear_modulus,
            yield_stress,
            hardening_modulus: 0.0,
        })
    } else {
        Strength::None
    };
    Parts {
        density,
        eos: Eos::Tillotson(Tillotson {
            a,
            b,
            bulk_modulus,
            quadratic_modulus,
            alpha: 5.0,
            beta: 5.0,
            e0,
            e_iv,
            e_cv,
            least_density: 0.9,
        }),
        strength,
        thermal: None,
        failure: Failure::NONE,
    }
}
