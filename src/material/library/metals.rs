//! Metals: Mie–Grüneisen with von Mises strength.
//!
//! Strengths are the initial yield stress Y₀ of the Steinberg–Guinan model, kept constant.

use super::Record;
use crate::material::{Eos, Material, MieGruneisen, Strength, VonMises};

/// Sorted by name.
pub(super) const RECORDS: &[Record] = &[
    Record {
        name: "aluminium-2024",
        make: aluminium_2024,
        sources: STEINBERG_2024,
    },
    Record {
        name: "aluminium-6061",
        make: aluminium_6061,
        sources: STEINBERG_6061,
    },
    Record {
        name: "copper",
        make: copper,
        sources: STEINBERG_COPPER,
    },
    Record {
        name: "steel-304",
        make: steel_304,
        sources: SPHERAL_304,
    },
];

const STEINBERG_2024: &str = "Al 2024-T4: ρ0, C0, S1, γ0, b, G0, Y0 of the Steinberg-Guinan \
     constants in Uintah, citing Steinberg, UCRL-MA-106439";
const STEINBERG_6061: &str = "Al 6061-T6: ρ0, C0, S1, γ0, b, G0, Y0 of the Steinberg-Guinan \
     constants in Uintah, citing Steinberg, UCRL-MA-106439";
const STEINBERG_COPPER: &str = "Cu OFHC half-hard: ρ0, C0, S1, γ0, b, G0, Y0 of the \
     Steinberg-Guinan constants in Uintah, citing Steinberg, UCRL-MA-106439";
const SPHERAL_304: &str = "304 stainless steel: ρ0, C0, S1, γ0, b, G0, Y0 of the \
     Steinberg-Guinan constants in Spheral's tests";

fn aluminium_2024() -> Material {
    metal(
        "aluminium-2024",
        2785.0,
        [5328.0, 1.338, 2.00, 0.48],
        [28.6e9, 0.26e9],
    )
}

fn aluminium_6061() -> Material {
    metal(
        "aluminium-6061",
        2703.0,
        [5240.0, 1.40, 1.97, 0.48],
        [27.6e9, 0.29e9],
    )
}

fn copper() -> Material {
    metal(
        "copper",
        8930.0,
        [3940.0, 1.489, 2.02, 0.47],
        [47.7e9, 0.12e9],
    )
}

fn steel_304() -> Material {
    metal(
        "steel-304",
        7900.0,
        [4570.0, 1.49, 1.93, 0.50],
        [77.0e9, 0.34e9],
    )
}

/// A metal of reference density ρ₀ (kg/m³), `[c₀ (m/s), s₁, γ₀, b]` and `[G, Y₀]` (Pa).
fn metal(
    name: &str,
    reference_density: f64,
    [c0, s1, gamma0, b]: [f64; 4],
    [shear_modulus, yield_stress]: [f64; 2],
) -> Material {
    Material {
        name: name.to_owned(),
        reference_density,
        eos: Eos::MieGruneisen(MieGruneisen {
            c0,
            s1,
            s2: 0.0,
            s3: 0.0,
            gamma0,
            b,
        }),
        strength: Strength::VonMises(VonMises {
            shear_modulus,
            yield_stress,
            hardening_modulus: 0.0,
        }),
        spall: None,
        thermal: None,
    }
}
