//! Laminates of fibres, homogenised.

use super::Parts;
use crate::{Criterion, Eos, Failure, Hashin, MieGruneisen, Orthotropic, Strength};

const LAMINA: &str = "Hexcel IM7/8552: Camanho, Maimí & Dávila (2007), Compos. Sci. Technol. 67, 2715, as commonly quoted; not checked against \
     the paper";
const ACROSS: &str = "alike across the fibres; ν₂₃ = .45 assumed, and G₂₃ = E₂/2(1 + ν₂₃)";
const LAYERS: &str = "assumed: that of a crack between fibres";
const FIBRES: &str = "that of the lamina under compression along the fibres";
const SHOCK: &str = "Us = 3.23 + .92 up (km/s) across the layers of a carbon–epoxy laminate: Millett, Bourne, Meziere, Vignjevic & Lukyanov \
     (2007), Compos. Sci. Technol. 67, 3253, as commonly quoted; not checked against the paper; γ₀ assumed";

records! {
    "carbon-epoxy", "carbon fibres in epoxy, all along direction 1, which crack":
        Parts {
            density: 1590.0,
            eos: Eos::MieGruneisen(MieGruneisen {
                c0: 3230.0,
                s1: 0.92,
                s2: 0.0,
                s3: 0.0,
                gamma0: 0.85,
                b: 0.0,
            }),
            strength: Strength::Orthotropic(Orthotropic {
                e1: 171.42e9,
                e2: 9.08e9,
                e3: 9.08e9,
                nu12: 0.32,
                nu13: 0.32,
                nu23: 0.45,
                g12: 5.29e9,
                g13: 5.29e9,
                g23: 3.13e9,
                crush_stress: 1.2e9,
            }),
            thermal: None,
            failure: Failure {
                hashin: Some(Hashin {
                    t1: 2326.2e6,
                    t2: 62.3e6,
                    t3: 62.3e6,
                    s12: 92.3e6,
                    s13: 92.3e6,
                    s23: 62.3e6,
                    gf1: 81.5e3,
                    gf2: 277.4,
                    gf3: 277.4,
                    criterion: Criterion::Hashin,
                }),
                ..Failure::NONE
            },
        },
        &[
            ("eos", SHOCK),
            ("strength.orthotropic.nu23", ACROSS),
            ("strength.orthotropic.g23", ACROSS),
            ("strength.orthotropic.crush_stress", FIBRES),
            ("failure.hashin.s23", LAYERS),
            ("failure.hashin.gf3", LAYERS),
            ("", LAMINA),
        ];
}
