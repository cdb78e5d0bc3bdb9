//! Equations of state: pressure from density and specific energy.

mod linear;
mod mie_gruneisen;

pub use linear::{Linear, LinearForm};
pub use mie_gruneisen::MieGruneisen;

/// The equation of state of a material.
#[derive(Debug, Clone, PartialEq)]
pub enum Eos {
    /// Pressure linear in the strain or in the density, without heat.
    Linear(Linear),
    /// Mie–Grüneisen about a Hugoniot `U = c₀ + s₁ u + …`.
    MieGruneisen(MieGruneisen),
}

impl Eos {
    /// Bulk modulus in the reference state (Pa), for a reference density in kg/m³.
    #[must_use]
    pub fn bulk_modulus(&self, reference_density: f64) -> f64 {
        match self {
            Self::Linear(eos) => eos.bulk_modulus,
            Self::MieGruneisen(eos) => reference_density * eos.c0 * eos.c0,
        }
    }
}
