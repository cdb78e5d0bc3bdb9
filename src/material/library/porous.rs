//! Porous materials: a solid with a law of compaction.

use super::Parts;
use super::impact::{UNCUT, aluminium};
use crate::{Compaction, Eos, PAlpha, Porosity, Strength};

const FOAM: &str = "Jutzi, Benz & Michel (2008), Icarus 198, 242, section 5.1, after Herrmann (1969); as the tests of \
     Spheral quote it";
const SOLID: &str = "of aluminium-tillotson";
const FLUID: &str = "without strength, as in that test";
const QUADRATIC: &str = "Herrmann (1969), J. Appl. Phys. 40, 2490";
const PLAIN: &str = "no steep beginning";

records! {
    "aluminium-foam", "aluminium with 22 % of pores, P-alpha, without strength":
        Parts {
            strength: Strength::None,
            ..aluminium()
        },
        &[
            ("porosity.p_alpha.exponent", QUADRATIC),
            ("porosity.p_alpha.transition", PLAIN),
            ("porosity", FOAM),
            ("strength", FLUID),
            ("eos.tillotson.least_density", UNCUT),
            ("", SOLID),
        ];
}

/// Pores of the record of a name, in a solid of this density (kg/m³).
pub(super) fn of(name: &str, density: f64, eos: &Eos) -> Option<Porosity> {
    (name == "aluminium-foam").then(|| {
        let law = Compaction::PAlpha(PAlpha {
            elastic_pressure: 80e6,
            solid_pressure: 700e6,
            exponent: 2.0,
            transition_pressure: 0.0,
            transition_distension: 1.0,
            transition_exponent: 2.0,
            sound_speed: 4110.0,
        });
        Porosity::new(1.275, law, density, eos)
    })
}
