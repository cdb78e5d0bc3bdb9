//! The seed paper's own materials, and those of classical test cases.

use super::Parts;
use crate::{Elastic, Eos, Failure, Linear, LinearForm, NeoHookean, Strength, VonMises};

const BARS: &str = "Vignjevic et al. (2006), section 3.2: E = 2.1 Mbar, ν = .28 (steel), E = .70 \
     Mbar, ν = .33 (aluminium)";
const FORM: &str = "so that uniaxial strain follows dσ/dt = M D";
const BLOCK: &str = "Vignjevic et al. (2006), section 3.3: E = 2.1 Mbar, ν = .28, Y = .003 Mbar";
const PLAIN: &str = "no hardening";
const TAYLOR: &str = "Taylor bar of Camacho & Ortiz (1997), Comput. Methods Appl. Mech. Eng. 142, \
     269: E = 117 GPa, ν = .35";
const RINGS: &str = "colliding rubber rings in Spheral and PySPH, after Swegle: c = 852 m/s, \
     G = .22 ρ c²";

records! {
    "aluminium-bar", "the paper's aluminium bar, linear elastic":
        {
            let [k, g] = moduli(70e9, 0.33);
            let strength = Strength::Elastic(Elastic { shear_modulus: g });
            linear(2700.0, k, LinearForm::Logarithmic, strength)
        },
        &[("eos.linear.form", FORM), ("", BARS)];
    "copper-taylor-bar", "copper of the Taylor anvil test, linear hardening":
        {
            let [k, g] = moduli(117e9, 0.35);
            linear(
                8930.0,
                k,
                LinearForm::Logarithmic,
                yielding(g, 0.4e9, 0.1e9),
            )
        },
        &[("", TAYLOR)];
    "rubber", "rubber of the colliding rings":
        {
            let k = 1010.0 * 852.0 * 852.0;
            let shear_modulus = 0.22 * k;
            let strength = Strength::NeoHookean(NeoHookean { shear_modulus });
            linear(1010.0, k, LinearForm::DensityRatio, strength)
        },
        &[("", RINGS)];
    "steel-bar", "the paper's steel bar, linear elastic":
        {
            let [k, g] = moduli(210e9, 0.28);
            let strength = Strength::Elastic(Elastic { shear_modulus: g });
            linear(7830.0, k, LinearForm::Logarithmic, strength)
        },
        &[("eos.linear.form", FORM), ("", BARS)];
    "steel-block", "the paper's block of steel, elastic-plastic":
        {
            let [k, g] = moduli(210e9, 0.28);
            linear(7830.0, k, LinearForm::DensityRatio, yielding(g, 0.3e9, 0.0))
        },
        &[("strength.von_mises.hardening_modulus", PLAIN), ("", BLOCK)];
}

/// Bulk and shear modulus (Pa) of Young's modulus (Pa) and Poisson's ratio.
fn moduli(young: f64, poisson: f64) -> [f64; 2] {
    [
        young / (3.0 * (1.0 - 2.0 * poisson)),
        young / (2.0 * (1.0 + poisson)),
    ]
}

fn yielding(shear_modulus: f64, yield_stress: f64, hardening_modulus: f64) -> Strength {
    Strength::VonMises(VonMises {
        shear_modulus,
        yield_stress,
        hardening_modulus,
    })
}

fn linear(density: f64, bulk_modulus: f64, form: LinearForm, strength: Strength) -> Parts {
    Parts {
        density,
        eos: Eos::Linear(Linear { bulk_modulus, form }),
        strength,
        thermal: None,
        failure: Failure::NONE,
    }
}
