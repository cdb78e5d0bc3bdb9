//! Ceramics, glass and a rock with the law of Johnson and Holmquist.
//!
//! The states at the Hugoniot elastic limit that a table states are those of its moduli, within 1 % (a unit test), but for
//! silicon carbide.

use super::Parts;
use crate::{
    Effect, Eos, Failure, JohnsonHolmquist2, JohnsonHolmquist2Failure, Polynomial, Strength,
};

const CRONIN: &str = "Cronin et al. (2003), 4th European LS-DYNA Users Conf.; the deck builder semgrit has the same; \
     not checked against the paper";
const LIMIT: &str = "Cronin et al. (2003), 4th European LS-DYNA Users Conf.: so the strength at the limit is 13.0 GPa; \
     semgrit has 14.457 GPa (12.8), the moduli give 12.7 GPa; not checked against the paper";
const ALUMINA: &str = "Anderson, Johnson & Holmquist (1995), 15th Int. Symp. Ballistics, 15, as public decks \
     quote it; the reference of Radioss (LAW79) has it rounded";
const CARBIDE: &str = "Johnson & Holmquist (1999), J. Appl. Phys. 85, 8060, as the reference of Radioss \
     (LAW79) quotes it";
const GLASS: &str = "float glass of Holmquist et al. (1995), 15th Int. Symp. Ballistics, 237, as Cronin et \
     al. (2003), 4th European LS-DYNA Users Conf., quote it";
const SANDSTONE: &str =
    "Baranowski et al. (2024), Sci. Rep. 14, 3339, as the deck builder semgrit quotes it";
const SANDSTONE_TENSION: &str = "Baranowski et al. (2024), Sci. Rep. 14, 3339, as the deck builder semgrit \
     quotes it: fitted to elements of 1 mm; it follows the mesh";
const RATE: &str = "1/s, as in Johnson & Holmquist (1994), AIP Conf. Proc. 309, 981";
const COLD: &str = "none: the law has no heat";
const NONE: &str = "none";
const LAW: &str = "as the law has it";
const BULKING: &str = "1, as in the sources of the other constants";

/// Sources of all keys.
macro_rules! sources {
    ($constants:expr) => {
        &[
            ("eos.polynomial.gamma0", COLD),
            ("strength.johnson_holmquist_2.reference_rate", RATE),
            ("failure.johnson_holmquist_2.bulking", BULKING),
            ("failure.effect", LAW),
            ("", $constants),
        ]
    };
}

records! {
    "alumina", "alumina of 3.7 g/cm³, Johnson-Holmquist strength, damage and bulking":
        ceramic(
            3700.0,
            [130.95e9, 0.0, 0.0],
            [90.16e9, 0.93, 0.31, 0.0, 0.6, 0.6],
            [0.2e9, 2.79e9, 1.46e9, 0.0],
            [0.005, 1.0],
        ),
        &[
            ("eos.polynomial.gamma0", COLD),
            ("strength.johnson_holmquist_2.reference_rate", RATE),
            ("strength.johnson_holmquist_2.max_fractured", NONE),
            ("failure.johnson_holmquist_2.bulking", BULKING),
            ("failure.effect", LAW),
            ("", ALUMINA),
        ];
    "boron-carbide", "boron carbide, Johnson-Holmquist strength, damage and bulking":
        ceramic(
            2510.0,
            [233e9, -593e9, 2800e9],
            [197e9, 0.927, 0.7, 0.005, 0.85, 0.67],
            [0.26e9, 19e9, 8.71e9, 0.2],
            [0.001, 0.5],
        ),
        sources!(CARBIDE);
    "glass-float", "float glass, Johnson-Holmquist strength, damage and bulking":
        ceramic(
            2530.0,
            [45.4e9, -138e9, 290e9],
            [30.4e9, 0.93, 0.088, 0.003, 0.35, 0.77],
            [0.15e9, 5.95e9, 2.92e9, 0.5],
            [0.053, 0.85],
        ),
        sources!(GLASS);
    "sandstone", "sandstone of 2.35 g/cm³, Johnson-Holmquist strength, damage and bulking":
        ceramic(
            2350.0,
            [3.7356e9, 9e9, 22e9],
            [2.686e9, 0.71, 0.3, 0.022, 0.4, 0.55],
            [8e6, 1.982e9, 1.374e9, 0.25],
            [0.002, 1.2],
        ),
        &[
            ("eos.polynomial.gamma0", COLD),
            ("strength.johnson_holmquist_2.reference_rate", RATE),
            ("strength.johnson_holmquist_2.max_tension", SANDSTONE_TENSION),
            ("failure.johnson_holmquist_2.bulking", BULKING),
            ("failure.effect", LAW),
            ("", SANDSTONE),
        ];
    "silicon-carbide", "silicon carbide, Johnson-Holmquist strength, damage and bulking":
        ceramic(
            3163.0,
            [204.785e9, 0.0, 0.0],
            [183e9, 0.96, 0.35, 0.0, 1.0, 0.65],
            [0.37e9, 14.567e9, 5.9e9, 0.8],
            [0.48, 0.48],
        ),
        &[
            ("eos.polynomial.gamma0", COLD),
            ("strength.johnson_holmquist_2.reference_rate", RATE),
            ("strength.johnson_holmquist_2.hugoniot_limit", LIMIT),
            ("failure.johnson_holmquist_2.bulking", BULKING),
            ("failure.effect", LAW),
            ("", CRONIN),
        ];
}

/// Density (kg/m³), `[K₁, K₂, K₃]` (Pa), `[G (Pa), A, B, C, M, N]`, `[T, HEL, p_HEL (Pa), σ*_max]`, `[D₁, D₂]`.
fn ceramic(
    density: f64,
    [k1, k2, k3]: [f64; 3],
    [shear_modulus, a, b, c, m, n]: [f64; 6],
    [
        max_tension,
        hugoniot_limit,
        hugoniot_pressure,
        max_fractured,
    ]: [f64; 4],
    [d1, d2]: [f64; 2],
) -> Parts {
    let mut failure = Failure {
        johnson_holmquist_2: Some(JohnsonHolmquist2Failure {
            d1,
            d2,
            bulking: 1.0,
        }),
        ..Failure::NONE
    };
    failure.options.effect = Effect::FrictionKept;
    Parts {
        density,
        eos: Eos::Polynomial(Polynomial {
            k1,
            k2,
            k3,
            gamma0: 0.0,
        }),
        strength: Strength::JohnsonHolmquist2(JohnsonHolmquist2 {
            shear_modulus,
            a,
            b,
            c,
            m,
            n,
            max_tension,
            hugoniot_limit,
            hugoniot_pressure,
            max_fractured,
            reference_rate: 1.0,
        }),
        thermal: None,
        failure,
    }
}

#[cfg(test)]
mod tests {
    use crate::{Eos, Strength, library};

    /// `HEL = p + 4/3 G μ/(1 + μ)` at the compression μ whose pressure is `p_HEL`.
    #[test]
    fn hugoniot_limits_are_those_of_the_moduli() {
        let mut checked = 0;
        for name in library::names() {
            let material = library::find(name).unwrap();
            let (Eos::Polynomial(eos), Strength::JohnsonHolmquist2(law)) =
                (&material.eos, &material.strength)
            else {
                continue;
            };
            let pressure = |mu: f64| mu * (eos.k1 + mu * (eos.k2 + mu * eos.k3));
            let [mut low, mut high] = [0.0, 0.3];
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if pressure(middle) < law.hugoniot_pressure {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let limit = law.hugoniot_pressure + 4.0 / 3.0 * law.shear_modulus * low / (1.0 + low);
            let part = limit / law.hugoniot_limit;
            let bound = if name == "silicon-carbide" {
                0.13
            } else {
                0.01
            };
            assert!((part - 1.0).abs() < bound, "{name}: {part}");
            checked += 1;
        }
        assert_eq!(checked, 5);
    }
}
