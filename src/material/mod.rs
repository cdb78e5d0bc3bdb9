//! Physics at one point: equation of state, strength, spall. Knows neither particles nor MPI.
//!
//! A [`Material`] advances eight points at a time ([`PointBatch`]); the choice of its parts is
//! made once for each batch, never for each point. Stress is positive in tension, pressure in
//! compression: `σ = −p I + S`. A NaN in a point's state gives NaN at that point, no panic.

pub mod eos;
pub mod library;
pub mod spall;
pub mod strength;

pub use eos::{Eos, Linear, LinearForm, MieGruneisen};
pub use spall::Spall;
pub use strength::{Elastic, Strength, VonMises};

/// Points advanced together; a batch lane is one point.
pub const LANES: usize = 8;

/// One value for each point of a batch.
pub type Lanes = [f64; LANES];

/// Smallest square of the bulk sound speed, as a fraction of its reference value K/ρ₀: expanded
/// and hot states where the equation of state gives less (or no real sound speed) keep a tenth
/// of the reference speed.
pub const SOUND_SPEED_SQUARED_FLOOR: f64 = 0.01;

/// The state of [`LANES`] points before and after an update. Unused lanes repeat a valid point.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
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

    /// Advances a batch of points by `dt` (s).
    ///
    /// With `dt = 0` the stress and plastic strain stay as they are, to the last bit, and the
    /// pressure and sound speed become those of the given density and energy.
    #[inline(always)]
    pub fn update(&self, batch: &mut PointBatch, dt: f64) {
        self.strength.update(batch, dt);
        let response = self.eos.response(
            self.reference_density,
            &batch.density,
            &batch.specific_energy,
        );
        batch.pressure = match self.spall {
            Some(spall) => spall.limit(&response.pressure),
            None => response.pressure,
        };
        self.set_sound_speed(batch, &response);
    }

    /// Longitudinal sound speed, `c² = ∂p/∂ρ|ₛ + 4G/(3ρ)`, where by the first law
    /// `∂p/∂ρ|ₛ = ∂p/∂ρ|ₑ + (p/ρ²) ∂p/∂e|ᵨ`.
    ///
    /// `p` is the pressure after the cut-off, since that does the work. At the cut-off the
    /// pressure no longer answers to density; its derivatives are kept, so that the speed is
    /// that of the recompression to come.
    #[inline(always)]
    fn set_sound_speed(&self, batch: &mut PointBatch, response: &eos::Response) {
        let floor = SOUND_SPEED_SQUARED_FLOOR * self.eos.bulk_modulus(self.reference_density)
            / self.reference_density;
        let shear = self.strength.shear_modulus() * (4.0 / 3.0);
        for k in 0..LANES {
            let volume = 1.0 / batch.density[k];
            let de_drho = batch.pressure[k] * volume * volume;
            let bulk = response.dp_drho[k] + de_drho * response.dp_de[k];
            batch.sound_speed[k] = (at_least(bulk, floor) + shear * volume).sqrt();
        }
    }
}

/// The larger of a value and a bound; NaN stays NaN (which `f64::max` would hide).
#[inline(always)]
fn at_least(value: f64, bound: f64) -> f64 {
    if value < bound { bound } else { value }
}

/// The smaller of a value and a bound; NaN stays NaN.
#[inline(always)]
fn at_most(value: f64, bound: f64) -> f64 {
    if value > bound { bound } else { value }
}
