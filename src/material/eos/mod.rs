//! Equations of state: pressure from density and specific energy.
//!
//! One is a file that implements [`EquationOfState`]; its row here gives it a name and a key of the input, its rows in
//! `input/schema/materials.rs` its constants.

mod sesame;

use super::{Constants, Contradiction, LANES, Lanes, Listed, PointBatch, Porosity, PorousPoint};

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
#[derive(Debug, Clone, Copy, Default)]
pub struct Response {
    /// Pressures (Pa).
    pub pressure: Lanes,
    /// ∂p/∂ρ (m²/s²).
    pub dp_drho: Lanes,
    /// ∂p/∂e (kg/m³).
    pub dp_de: Lanes,
}

impl Response {
    /// Takes the response of one point to a lane.
    #[inline(always)]
    pub(super) fn set(&mut self, k: usize, at: PointResponse) {
        self.pressure[k] = at.pressure;
        self.dp_drho[k] = at.dp_drho;
        self.dp_de[k] = at.dp_de;
    }
}

/// One equation of state.
pub trait EquationOfState: Listed {
    /// True if it acts in a function of its own, as equations that raise to powers do: inside the vector code, their
    /// calls slow down those that have no need of them.
    const APART: bool = false;

    /// Contradiction of constants that are each within their range.
    fn contradiction(&self) -> Option<Contradiction> {
        None
    }

    /// Bulk modulus in the reference state (Pa), for a reference density in kg/m³.
    fn bulk_modulus(&self, rho0: f64) -> f64;

    /// Specific energy (J/kg) of the reference state at density `rho` (kg/m³): where a body
    /// begins that states none.
    fn reference_energy(&self, _rho: f64) -> f64 {
        0.0
    }

    /// Specific energy (J/kg) below which matter that has come apart is drops and void, and expands no farther than spray; none where
    /// the equation bears any tension or knows of no vapour.
    fn spray_energy(&self) -> Option<f64> {
        None
    }

    /// `[a, b]` of the bulk modulus `a (p + b)` (Pa) of a gas at the pressure p (Pa); none of condensed matter, whose
    /// modulus is for the most part that of its reference state.
    fn modulus_over_pressure(&self) -> Option<[f64; 2]> {
        None
    }

    /// The density (kg/m³) from which pressure is linear up to that of torn matter, for matter of the mean
    /// density `rho`.
    #[inline(always)]
    fn linear_density(&self, _rho0: f64, rho: f64) -> f64 {
        rho
    }

    /// Pressure and derivatives at one state: reference density and density (kg/m³), specific
    /// energy (J/kg).
    fn at(&self, rho0: f64, rho: f64, e: f64) -> PointResponse;

    /// [`Self::at`] of a batch.
    #[inline(always)]
    fn of_batch(&self, rho0: f64, rho: &Lanes, e: &Lanes) -> Response {
        let mut response = Response::default();
        for k in 0..LANES {
            response.set(k, self.at(rho0, rho[k], e[k]));
        }
        response
    }
}

/// Makes [`Eos`] of its table.
macro_rules! equations_of_state {
    ($( $(#[doc = $doc:literal])+ $key:ident: $law:ident; )+) => {
        $( mod $key; )+
        $( pub use $key::$law; )+

        /// The equation of state of a material.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Eos {
            $( $(#[doc = $doc])+ $law($law), )+
        }

        impl Eos {
            /// Key of the law in the input and its constants.
            #[must_use]
            pub fn constants(&self) -> (&'static str, Constants) {
                match self {
                    $( Self::$law(law) => (stringify!($key), law.constants()), )+
                }
            }

            /// See [`EquationOfState::bulk_modulus`].
            #[must_use]
            pub fn bulk_modulus(&self, rho0: f64) -> f64 {
                match self {
                    $( Self::$law(law) => EquationOfState::bulk_modulus(law, rho0), )+
                }
            }

            /// See [`EquationOfState::reference_energy`].
            #[must_use]
            pub fn reference_energy(&self, rho: f64) -> f64 {
                match self {
                    $( Self::$law(law) => EquationOfState::reference_energy(law, rho), )+
                }
            }

            /// See [`EquationOfState::spray_energy`].
            #[must_use]
            pub fn spray_energy(&self) -> Option<f64> {
                match self {
                    $( Self::$law(law) => law.spray_energy(), )+
                }
            }

            /// See [`EquationOfState::modulus_over_pressure`].
            #[must_use]
            pub fn modulus_over_pressure(&self) -> Option<[f64; 2]> {
                match self {
                    $( Self::$law(law) => law.modulus_over_pressure(), )+
                }
            }

            /// See [`EquationOfState::linear_density`].
            #[inline(always)]
            #[must_use]
            pub fn linear_density(&self, rho0: f64, rho: f64) -> f64 {
                match self {
                    $( Self::$law(law) => law.linear_density(rho0, rho), )+
                }
            }

            /// See [`EquationOfState::at`].
            #[must_use]
            pub fn at(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
                match self {
                    $( Self::$law(law) => law.at(rho0, rho, e), )+
                }
            }

            /// Pressure and derivatives of a batch, from reference density and densities (kg/m³) and
            /// specific energies (J/kg).
            #[inline(always)]
            pub(super) fn response(&self, rho0: f64, rho: &Lanes, e: &Lanes) -> Response {
                match self {
                    $( Self::$law(law) if !$law::APART => law.of_batch(rho0, rho, e), )+
                    _ => self.apart(rho0, rho, e),
                }
            }

            /// Points of a batch of porous matter.
            pub(super) fn porous(
                &self,
                porosity: &Porosity,
                batch: &PointBatch,
                crushes: bool,
            ) -> [PorousPoint; LANES] {
                match self {
                    $( Self::$law(law) => porosity.of_batch(law, batch, crushes), )+
                }
            }

            /// A point of porous matter that was virgin, of a density (kg/m³) and a specific energy (J/kg).
            pub(super) fn first(
                &self,
                porosity: &Porosity,
                state: [f64; 2],
                crushes: bool,
            ) -> PorousPoint {
                match self {
                    $( Self::$law(law) => porosity.first(law, state, crushes), )+
                }
            }

            /// [`Self::response`] of the equations that act in a function of their own.
            #[inline(never)]
            fn apart(&self, rho0: f64, rho: &Lanes, e: &Lanes) -> Response {
                match self {
                    $( Self::$law(law) => law.of_batch(rho0, rho, e), )+
                }
            }
        }
    };
}

// The key below `eos` in the input, and the law. A material has one of them.
equations_of_state! {
    /// Pressure linear in the volumetric strain or in the density, without heat.
    linear: Linear;
    /// Mie–Grüneisen about the Hugoniot of the reference state.
    mie_gruneisen: MieGruneisen;
    /// Polynomial in the compression.
    polynomial: Polynomial;
    /// Tait's law of a liquid, without heat.
    tait: Tait;
    /// Tillotson's law, from cold compression to vapour.
    tillotson: Tillotson;
    /// Ideal or stiffened gas.
    ideal_gas: IdealGas;
    /// Products of an explosive by Jones, Wilkins and Lee, with its burn.
    jwl: Jwl;
    /// Murnaghan's law, without heat.
    murnaghan: Murnaghan;
    /// A table of densities and temperatures.
    table: Table;
}
pub use jwl::{Burn, UNLIT};
pub use linear::LinearForm;
pub use table::Grid;
