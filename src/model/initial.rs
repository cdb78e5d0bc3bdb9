//! What the particles of a body begin with.

use super::readable::shown;
use super::{Body, Case, Place, Profile, Vec3};

/// No speed is as large (m/s).
const LIGHT: f64 = 299_792_458.0;
/// No temperature is as high (K), none of the middles of stars.
const HOTTEST: f64 = 1e9;
/// No specific energy is as large (J/kg): that of all the mass.
const MOST_ENERGY: f64 = 9e16;
/// More than any matter bears.
const MOST_STRAIN: f64 = 1e3;

/// What decides the specific energy of particles.
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

/// What the particles of a body begin with beside density, [`Body::velocity`] and spin.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Initial {
    /// Components of the velocity (m/s) where it varies, in place of [`Body::velocity`], which is then
    /// the middle of them.
    pub velocity: Option<[Profile; 3]>,
    /// Largest difference of that from its middle (m/s).
    pub velocity_spread: f64,
    /// What decides the specific energy.
    pub heat: Heat,
    /// Specific energy (J/kg) of the largest magnitude, where it varies.
    pub largest_energy: f64,
    /// Equivalent plastic strain.
    pub plastic_strain: Profile,
}

/// What one particle begins with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beginning {
    /// Velocity (m/s).
    pub velocity: Vec3,
    /// Temperature (K), if that is given.
    pub temperature: Option<f64>,
    /// Specific energy (J/kg).
    pub specific_energy: f64,
    /// Equivalent plastic strain.
    pub plastic_strain: f64,
}

impl Beginning {
    /// The key whose value is out of range, the value in words, and what it must be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let speed = self.velocity.norm();
        let temperature = self.temperature.unwrap_or(1.0);
        // What is no number is in no range.
        if !(speed < LIGHT) {
            Some(("velocity", shown(speed, "m/s"), "slower than light"))
        } else if !(temperature > 0.0 && temperature < HOTTEST) {
            let range = "above 0 K and below that of any star";
            Some(("temperature", shown(temperature, "K"), range))
        } else if !(self.specific_energy.abs() < MOST_ENERGY) {
            let value = shown(self.specific_energy, "J/kg");
            Some(("specific_energy", value, "less than that of all the mass"))
        } else if !(self.plastic_strain >= 0.0 && self.plastic_strain < MOST_STRAIN) {
            let value = shown(self.plastic_strain, "");
            Some(("plastic_strain", value, "zero or positive and below 1000"))
        } else {
            None
        }
    }
}

impl Initial {
    /// Whether anything varies within the body.
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

impl Case {
    /// Initial density of a body (kg/m³).
    #[must_use]
    pub fn initial_density(&self, body: &Body) -> f64 {
        let reference = || self.materials[body.material].reference_density;
        body.density.unwrap_or_else(reference)
    }

    /// Initial specific energy of a body (J/kg); where it varies, that of the largest magnitude.
    #[must_use]
    pub fn initial_energy(&self, body: &Body) -> f64 {
        match &body.initial.heat {
            Heat::Energy(Profile::Formula(_)) | Heat::Temperature(Profile::Formula(_)) => {
                body.initial.largest_energy
            }
            _ => {
                self.heat(
                    body,
                    &Place::new(&body.shape.centre(), &body.shape.centre()),
                )
                .1
            }
        }
    }

    /// What a particle of a body at `position` (m) begins with.
    #[must_use]
    pub fn beginning(&self, body: &Body, position: &Vec3) -> Beginning {
        let place = Place::new(position, &body.shape.centre());
        let (temperature, specific_energy) = self.heat(body, &place);
        Beginning {
            velocity: body.velocity_at(position),
            temperature,
            specific_energy,
            plastic_strain: body.initial.plastic_strain.at(&place),
        }
    }

    /// The key that gives a particle at `position` (m) what nature does not know, and a line that says
    /// so; nothing if all is in range.
    #[must_use]
    pub fn unsound(&self, body: &Body, position: &Vec3) -> Option<(&'static str, String)> {
        let (key, value, range) = self.beginning(body, position).fault()?;
        let place = self
            .length_unit
            .vector(&position.as_slice()[..self.dimension]);
        let name = &body.name;
        Some((
            key,
            format!("`{key}` of `{name}` is {value} at {place}, and must be {range}"),
        ))
    }

    /// Temperature (K), if it is given, and specific energy (J/kg) at a place.
    fn heat(&self, body: &Body, place: &Place) -> (Option<f64>, f64) {
        let material = &self.materials[body.material];
        let density = self.initial_density(body);
        match &body.initial.heat {
            Heat::Reference => (None, material.eos.reference_energy(density)),
            Heat::Energy(energy) => (None, energy.at(place)),
            Heat::Temperature(temperature) => {
                let temperature = temperature.at(place);
                let energy = material.energy(density, temperature);
                (Some(temperature), energy.unwrap_or(f64::NAN))
            }
        }
    }
}
