//! The initial state of the particles of a body, as in a case.

use super::Profile;

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
        profiles.any(|profile| profile.constant().is_none())
    }
}
