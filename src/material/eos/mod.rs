//! Equations of state: pressure from density and specific energy.

pub mod linear;
pub mod mie_gruneisen;

pub use linear::{Linear, LinearForm};
pub use mie_gruneisen::MieGruneisen;

use super::{LANES, Lanes};

/// The equation of state of a material.
#[derive(Debug, Clone, PartialEq)]
pub enum Eos {
    /// Pressure linear in the volumetric strain or in the density, without heat.
    Linear(Linear),
    /// Mie–Grüneisen about the Hugoniot of the reference state.
    MieGruneisen(MieGruneisen),
}

/// Pressure and its derivatives at one state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointResponse {
    /// Pressure p(ρ, e), compression positive (Pa).
    pub pressure: f64,
    /// ∂p/∂ρ at constant specific energy (m²/s²).
    pub dp_drho: f64,
    /// ∂p/∂e at constant density (kg/m³).
    pub dp_de: f64,
}

/// [`PointResponse`] of each point of a batch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Response {
    pub pressure: Lanes,
    pub dp_drho: Lanes,
    pub dp_de: Lanes,
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

    /// Pressure and derivatives of a batch, from reference density and densities (kg/m³) and
    /// specific energies (J/kg).
    #[inline(always)]
    pub(super) fn response(&self, rho0: f64, rho: &Lanes, e: &Lanes) -> Response {
        match self {
            Self::Linear(eos) => map(rho, e, |rho, _| eos.response(rho0, rho)),
            Self::MieGruneisen(eos) => {
                let bounds = eos.bounds();
                map(rho, e, |rho, e| eos.bounded_response(bounds, rho0, rho, e))
            }
        }
    }
}

/// Applies the response of one point to all lanes.
#[inline(always)]
fn map(rho: &Lanes, e: &Lanes, point: impl Fn(f64, f64) -> PointResponse) -> Response {
    let mut response = Response {
        pressure: [0.0; LANES],
        dp_drho: [0.0; LANES],
        dp_de: [0.0; LANES],
    };
    for k in 0..LANES {
        let at = point(rho[k], e[k]);
        response.pressure[k] = at.pressure;
        response.dp_drho[k] = at.dp_drho;
        response.dp_de[k] = at.dp_de;
    }
    response
}
