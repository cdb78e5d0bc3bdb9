//! Equations of state: pressure from density and specific energy.

pub mod ideal_gas;
pub mod linear;
pub mod mie_gruneisen;
pub mod tait;
pub mod tillotson;

pub use ideal_gas::IdealGas;
pub use linear::{Linear, LinearForm};
pub use mie_gruneisen::MieGruneisen;
pub use tait::Tait;
pub use tillotson::Tillotson;

use super::{LANES, Lanes};

/// The equation of state of a material.
#[derive(Debug, Clone, PartialEq)]
pub enum Eos {
    /// Pressure linear in the volumetric strain or in the density, without heat.
    Linear(Linear),
    /// Mie–Grüneisen about the Hugoniot of the reference state.
    MieGruneisen(MieGruneisen),
    /// Tait's law of a liquid, without heat.
    Tait(Tait),
    /// Tillotson's law, from cold compression to vapour.
    Tillotson(Tillotson),
    /// Ideal or stiffened gas.
    IdealGas(IdealGas),
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
            Self::Tait(eos) => eos.gamma * eos.b,
            Self::Tillotson(eos) => eos.bulk_modulus,
            Self::IdealGas(eos) => eos.bulk_modulus(),
        }
    }

    /// Specific energy (J/kg) of the reference state at density `rho` (kg/m³): where a body
    /// begins that states none.
    #[must_use]
    pub fn reference_energy(&self, rho: f64) -> f64 {
        match self {
            Self::IdealGas(eos) => eos.reference_energy(rho),
            Self::Linear(_) | Self::MieGruneisen(_) | Self::Tait(_) | Self::Tillotson(_) => 0.0,
        }
    }

    /// The density (kg/m³) from which pressure is linear up to that of torn matter, for matter of the mean
    /// density `rho`.
    #[inline(always)]
    #[must_use]
    pub fn linear_density(&self, rho0: f64, rho: f64) -> f64 {
        match self {
            Self::MieGruneisen(_) => super::at_least(rho, mie_gruneisen::DENSE * rho0),
            _ => rho,
        }
    }

    /// Pressure and derivatives at one state: reference density and density (kg/m³), specific
    /// energy (J/kg).
    #[must_use]
    pub fn at(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
        match self {
            Self::Linear(eos) => eos.response(rho0, rho),
            Self::MieGruneisen(eos) => eos.response(rho0, rho, e),
            Self::Tait(eos) => eos.response(rho0, rho),
            Self::Tillotson(eos) => eos.response(rho0, rho, e),
            Self::IdealGas(eos) => eos.response(rho, e),
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
            _ => self.transcendental_response(rho0, rho, e),
        }
    }

    /// [`Self::response`] of the equations that raise to powers. A function of its own: inside the
    /// vector code, their calls slow down those that have no need of them.
    #[inline(never)]
    fn transcendental_response(&self, rho0: f64, rho: &Lanes, e: &Lanes) -> Response {
        map(rho, e, |rho, e| self.at(rho0, rho, e))
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
