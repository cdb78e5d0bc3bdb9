//! Explosives: products by Jones, Wilkins and Lee. The unburnt matter bears no pressure.
//!
//! Of each record the state of Chapman and Jouguet by its constants has the detonation velocity and pressure that the
//! same table states, within .1 % (a unit test).

use super::Parts;
use crate::{Burn, Eos, Failure, Jwl, Strength};

const HANDBOOK: &str = "Dobratz & Crawford (1985), LLNL explosives handbook, UCRL-52997 change 2, \
     table of JWL constants; E₀ over the density; from no text at hand, but the constants give the D and \
     p_CJ beside them";
const ANFO: &str = "ANFO of .931 g/cm³ as scripts for CDEM quote it (with 1.891 MPa for B, where others \
     have the GPa that D and p_CJ ask for); E₀ over the density";
const C_4: &str = "Dobratz & Crawford (1985), LLNL explosives handbook, UCRL-52997 change 2, as the case \
     building3D of blastFoam quotes it; E₀ over the density";
const COMPOSITION_B: &str = "Dobratz & Crawford (1985), LLNL explosives handbook, UCRL-52997 change 2, as \
     public solvers of blasts quote it; E₀ over the density";
const PBX_9404: &str = "Dobratz & Crawford (1985), LLNL explosives handbook, UCRL-52997 change 2; public \
     solvers of blasts quote A and B; R₁ of 4.6 gives the p_CJ beside them; E₀ over the density";
const PETN: &str = "Dobratz & Crawford (1985), LLNL explosives handbook, UCRL-52997 change 2, as public \
     set-ups of blastFoam quote it, rounded; E₀ over the density";
const TNT: &str = "Dobratz & Crawford (1985), LLNL explosives handbook, UCRL-52997 change 2, as the \
     reference of Radioss (LAW5) quotes it; the older set of Lee et al. (373.77 GPa) gives the same D and \
     p_CJ; E₀ over the density";
const BURNS: &str = "by the detonation that the case programs, or by compression";
const DUST: &str = "not known: unburnt matter bears no pressure";
const GAS: &str = "none: it burns to gas";
const FRONT: &str = "of the numerical front";

/// Sources of all keys, from those of the constants of the products.
macro_rules! sources {
    ($constants:expr) => {
        &[
            ("eos.jwl.burn", BURNS),
            ("eos.jwl.bulk_modulus", DUST),
            ("eos.jwl.width", FRONT),
            ("strength", GAS),
            ("", $constants),
        ]
    };
}

records! {
    "anfo", "ANFO, ammonium nitrate and fuel oil of .93 g/cm³, explosive":
        explosive([0.931, 4.16, 5.15, 2.484], [49.46, 1.891], [3.907, 1.118, 0.333]),
        sources!(ANFO);
    "c-4", "C-4, explosive of RDX and binder":
        explosive([1.601, 8.193, 28.0, 9.0], [609.77, 12.95], [4.5, 1.4, 0.25]),
        sources!(C_4);
    "composition-b", "Composition B grade A, explosive of RDX and TNT":
        explosive([1.717, 7.98, 29.5, 8.5], [524.2, 7.678], [4.2, 1.1, 0.34]),
        sources!(COMPOSITION_B);
    "cyclotol", "cyclotol 77/23, explosive of RDX and TNT":
        explosive([1.754, 8.25, 32.0, 9.2], [603.4, 9.924], [4.3, 1.1, 0.35]),
        sources!(HANDBOOK);
    "lx-14", "LX-14-0, explosive of HMX and binder":
        explosive([1.835, 8.8, 37.0, 10.2], [826.1, 17.24], [4.55, 1.32, 0.38]),
        sources!(HANDBOOK);
    "octol", "octol 78/22, explosive of HMX and TNT":
        explosive([1.821, 8.48, 34.2, 9.6], [748.6, 13.38], [4.5, 1.2, 0.38]),
        sources!(HANDBOOK);
    "pbx-9404", "PBX-9404-3, explosive of HMX and binder":
        explosive([1.84, 8.8, 37.0, 10.2], [852.4, 18.02], [4.6, 1.3, 0.38]),
        sources!(PBX_9404);
    "petn", "PETN pressed to 1.77 g/cm³, explosive":
        explosive([1.77, 8.3, 33.5, 10.1], [617.0, 16.926], [4.4, 1.2, 0.25]),
        sources!(PETN);
    "tnt", "TNT, explosive":
        explosive([1.63, 6.93, 21.0, 7.0], [371.2, 3.231], [4.15, 0.95, 0.3]),
        sources!(TNT);
}

/// `[ρ₀ (g/cm³), D (km/s), p_CJ (GPa), E₀ (GPa)]`, `[A (GPa), B (GPa)]`, `[R₁, R₂, ω]`.
fn explosive(
    [density, velocity, pressure, energy]: [f64; 4],
    [a, b]: [f64; 2],
    [r1, r2, omega]: [f64; 3],
) -> Parts {
    let density = 1e3 * density;
    Parts {
        density,
        eos: Eos::Jwl(Jwl {
            a: 1e9 * a,
            b: 1e9 * b,
            r1,
            r2,
            omega,
            e0: 1e9 * energy / density,
            detonation_velocity: 1e3 * velocity,
            cj_pressure: 1e9 * pressure,
            bulk_modulus: 0.0,
            burn: Burn::Either,
            width: 3.0,
        }),
        strength: Strength::None,
        thermal: None,
        failure: Failure::NONE,
    }
}
