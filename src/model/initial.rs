//! The initial state of the particles of a body, as in a case.

use super::{Fibres, Loading, Profile};
use material::Stressed;

/// The source of the specific energy of particles.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Heat {
    /// The material's reference state.
    #[default]
    Reference,
    /// Specific energy (J/kg).
    Energy(Profile),
    /// Temperature (K) at the body's initial density.
    Temperature(Profile),
}

/// The initial state of the particles of a body beside its density, its spin and a uniform
/// velocity.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Initial {
    /// Components of the velocity (m/s) where it varies, in place of
    /// [`Body::velocity`](super::Body::velocity), which is then the middle of them.
    pub velocity: Option<[Profile; 3]>,
    /// Largest difference of that from its middle (m/s).
    pub velocity_spread: f64,
    /// The source of the specific energy.
    pub heat: Heat,
    /// Specific energy (J/kg) of the largest magnitude, where it varies.
    pub largest_energy: f64,
    /// Equivalent plastic strain.
    pub plastic_strain: Profile,
    /// The stress that it begins under, if there is any; the density is that of its pressure.
    pub loading: Option<Loading>,
    /// The state under it, where that is the same everywhere and has been found.
    pub even: Option<Stressed>,
    /// Directions of its matter, where that has some of its own.
    pub fibres: Option<Fibres>,
}

impl Initial {
    /// `true` if anything varies within the body.
    #[must_use]
    pub fn varies(&self) -> bool {
        let heat = match &self.heat {
            Heat::Reference => None,
            Heat::Energy(profile) | Heat::Temperature(profile) => Some(profile),
        };
        let profiles = self.velocity.iter().flatten().chain(heat);
        let mut profiles = profiles.chain([&self.plastic_strain]);
        profiles.any(|profile| profile.constant().is_none()) || self.varies_in_stress()
    }

    /// `true` if the stress that it begins under, or what comes with that, varies within the body.
    #[must_use]
    pub fn varies_in_stress(&self) -> bool {
        let of_heat = match &self.heat {
            Heat::Reference => false,
            Heat::Energy(profile) | Heat::Temperature(profile) => profile.constant().is_none(),
        };
        let loading = self.loading.as_ref();
        loading.is_some_and(|loading| of_heat || loading.varies())
    }
}
