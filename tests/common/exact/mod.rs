//! The paper's metals for tests of exact answers, and elastic bars of small strain to compare with.
//! Units: cm, µs, g/cm³, Mbar.

pub mod elastic;
pub mod noh;
pub mod release;
pub mod shocks;
mod steps;

use exact::finite_strain::Medium;
use material::LinearForm;

/// Young's modulus (Mbar), Poisson's ratio, density (g/cm³).
pub const STEEL: [f64; 3] = [2.1, 0.28, 7.83];
/// As [`STEEL`].
pub const ALUMINIUM: [f64; 3] = [0.7, 0.33, 2.70];

/// An elastic medium of a law of pressure.
pub fn medium([e, nu, density]: [f64; 3], form: LinearForm) -> Medium {
    Medium {
        reference_density: density,
        bulk_modulus: e / (3.0 * (1.0 - 2.0 * nu)),
        shear_modulus: e / (2.0 * (1.0 + nu)),
        form,
    }
}
