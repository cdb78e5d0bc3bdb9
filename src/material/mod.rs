//! Physics at one point: equation of state, strength, spall. Knows neither particles nor MPI.
//!
//! A [`Material`] advances eight points at a time ([`PointBatch`]); the choice of its parts is
//! made once for each batch, never for each point. Stress is positive in tension, pressure in
//! compression: `σ = −p I + S`.

pub mod eos;
pub mod library;
mod spall;
pub mod strength;

pub use eos::{Eos, Linear, LinearForm, MieGruneisen};
pub use spall::Spall;
pub use strength::{Elastic, Strength, VonMises};

/// Points advanced together; a batch lane is one point.
pub const LANES: usize = 8;

/// One value for each point of a batch.
pub type Lanes = [f64; LANES];

/// The state of [`LANES`] points before and after an update. Unused lanes repeat a valid point.
#[derive(Debug, Clone, Copy)]
pub struct PointBatch {
    /// Density at the end of the step (kg/m³), in.
    pub density: Lanes,
    /// Specific internal energy at the end of the step (J/kg), in.
    pub specific_energy: Lanes,
    /// Velocity gradient at the middle of the step, row-major `L_ij = ∂v_i/∂x_j` (1/s), in.
    pub velocity_gradient: [Lanes; 9],
    /// Deviatoric stress `xx yy zz xy xz yz`, tension positive (Pa), in and out.
    pub deviatoric_stress: [Lanes; 6],
    /// Equivalent plastic strain, in and out.
    pub plastic_strain: Lanes,
    /// Pressure, compression positive (Pa), out.
    pub pressure: Lanes,
    /// Longitudinal sound speed (m/s), out.
    pub sound_speed: Lanes,
}

/// A material: equation of state, strength and spall.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name for reports.
    pub name: String,
    /// Reference density ρ₀ (kg/m³).
    pub reference_density: f64,
    /// Pressure as a function of density and specific energy.
    pub eos: Eos,
    /// Resistance to shear.
    pub strength: Strength,
    /// Largest tension, if the material has one.
    pub spall: Option<Spall>,
}

impl Material {
    /// Reference p-wave modulus `M = K + 4G/3` (Pa): what contact stiffness scales with.
    #[must_use]
    pub fn p_wave_modulus(&self) -> f64 {
        self.eos.bulk_modulus(self.reference_density) + self.strength.shear_modulus() * (4.0 / 3.0)
    }

    /// Advances a batch of points by `dt` (s; zero gives the stress of the given state).
    pub fn update(&self, batch: &mut PointBatch, dt: f64) {
        let _ = (batch, dt);
        todo!()
    }
}
