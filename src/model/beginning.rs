//! The initial state of one particle, and its physical range.

use super::readable::shown;
use super::{Body, Case, Heat, Place, Profile, Quantity, Vec3};
use material::{Material, Stressed, Unborne};

/// No speed is as large (m/s).
const LIGHT: f64 = 299_792_458.0;
/// No temperature is as high (K), none of the middles of stars.
const HOTTEST: f64 = 1e9;
/// No specific energy is as large (J/kg): that of all the mass.
const MOST_ENERGY: f64 = 9e16;
/// More than any material bears.
const MOST_STRAIN: f64 = 1e3;

/// The initial state of one particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beginning {
    /// Velocity (m/s).
    pub velocity: Vec3,
    /// Density (kg/m³).
    pub density: f64,
    /// Temperature (K), if that is given.
    pub temperature: Option<f64>,
    /// Specific energy (J/kg).
    pub specific_energy: f64,
    /// Equivalent plastic strain.
    pub plastic_strain: f64,
    /// Deviatoric stress `xx yy zz xy xz yz`, tension positive (Pa).
    pub deviatoric_stress: [f64; 6],
    /// How far pores have been crushed, along the crush curve; zero without pores.
    pub compaction: f64,
    /// The key of a stress that it does not bear, and why.
    pub unborne: Option<(&'static str, Unborne)>,
}

impl Beginning {
    /// The key whose value is out of range, the value in words, and what it must be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let speed = self.velocity.norm();
        let temperature = self.temperature.unwrap_or(1.0);
        // NaN is in no range.
        if !(0.0..LIGHT).contains(&speed) {
            Some(("velocity", shown(speed, "m/s"), "slower than light"))
        } else if !(temperature > 0.0 && temperature < HOTTEST) {
            let range = "above 0 K and below that of any star";
            Some(("temperature", shown(temperature, "K"), range))
        } else if !(0.0..MOST_ENERGY).contains(&self.specific_energy.abs()) {
            let value = shown(self.specific_energy, "J/kg");
            Some(("specific_energy", value, "less than that of all the mass"))
        } else if !(0.0..MOST_STRAIN).contains(&self.plastic_strain) {
            let value = shown(self.plastic_strain, "");
            Some(("plastic_strain", value, "zero or positive and below 1000"))
        } else {
            let (key, unborne) = self.unborne?;
            let (value, range) = match unborne {
                Unborne::Pressure(pressure) => (
                    shown(pressure, "Pa"),
                    "one that the equation of state has at the body's energy or temperature",
                ),
                Unborne::Tension(pressure) => (
                    shown(pressure, "Pa"),
                    "no more tension than the material bears",
                ),
                Unborne::Shear(stress) => (
                    format!("one of {} in shear (von Mises)", shown(stress, "Pa")),
                    "within the strength of the material",
                ),
            };
            Some((key, value, range))
        }
    }
}

impl Case {
    /// Initial density of a body (kg/m³).
    #[must_use]
    pub fn initial_density(&self, body: &Body) -> f64 {
        let reference = || self.materials[body.material].reference_density;
        body.density.unwrap_or_else(reference)
    }

    /// Mass of a particle of a body (kg; kg/m or kg/m² in two or one dimensions), where sizes
    /// differ of one of the spacing.
    #[must_use]
    pub fn particle_mass(&self, body: &Body) -> f64 {
        self.initial_density(body) * body.lattice.particle_volume(self.dimension)
    }

    /// Initial specific energy of a body (J/kg); where it varies, that of the largest magnitude.
    #[must_use]
    pub fn initial_energy(&self, body: &Body) -> f64 {
        match &body.initial.heat {
            Heat::Energy(Profile::Formula(_)) | Heat::Temperature(Profile::Formula(_)) => {
                body.initial.largest_energy
            }
            _ if body.holds(Quantity::SpecificEnergy) => body.initial.largest_energy,
            _ => {
                let centre = Place::new(&body.shape.centre(), &body.shape.centre());
                self.energy_at(body, &centre, self.initial_density(body))
            }
        }
    }

    /// Modulus (Pa) that the stiffness of contact is a multiple of: that of p-waves in the reference state; of a gas at
    /// least the bulk modulus at the start.
    #[must_use]
    pub fn contact_modulus(&self, body: &Body) -> f64 {
        let material = &self.materials[body.material];
        let reference = material.p_wave_modulus();
        let Some([slope, offset]) = material.eos.modulus_over_pressure() else {
            return reference;
        };
        let (density, energy) = (self.initial_density(body), self.initial_energy(body));
        let begins = material.eos.at(material.reference_density, density, energy);
        reference.max(slope * (begins.pressure + offset))
    }

    /// The initial state of a particle of a body at `position` (m).
    #[must_use]
    pub fn beginning(&self, body: &Body, position: &Vec3) -> Beginning {
        let place = Place::new(position, &body.shape.centre());
        let density = self.initial_density(body);
        let mut begins = Beginning {
            velocity: body.velocity_at(position),
            density,
            temperature: match &body.initial.heat {
                Heat::Temperature(temperature) => Some(temperature.at(&place)),
                Heat::Reference | Heat::Energy(_) => None,
            },
            specific_energy: self.energy_at(body, &place, density),
            plastic_strain: body.initial.plastic_strain.at(&place),
            deviatoric_stress: [0.0; 6],
            compaction: 0.0,
            unborne: None,
        };
        if let Some(found) = self.stressed(body, position, begins.plastic_strain) {
            match found {
                Ok(state) => {
                    begins.density = state.density;
                    begins.specific_energy = state.specific_energy;
                    begins.deviatoric_stress = state.deviatoric_stress;
                    begins.compaction = state.compaction;
                }
                Err(unborne) => begins.unborne = Some(unborne),
            }
        }
        begins
    }

    /// The state of a body at `position` (m) under the stress that it begins under, if there is any, with a plastic strain; or
    /// the key of that and why it does not bear it.
    #[must_use]
    pub fn stressed(
        &self,
        body: &Body,
        position: &Vec3,
        plastic_strain: f64,
    ) -> Option<Result<Stressed, (&'static str, Unborne)>> {
        let loading = body.initial.loading.as_ref()?;
        if let Some(even) = body.initial.even {
            return Some(Ok(even));
        }
        let place = Place::new(position, &body.shape.centre());
        let material = &self.materials[body.material];
        let mass = material.reference_density * body.lattice.particle_volume(self.dimension);
        let stress = loading.at(position, &place);
        let energy = |density: f64| self.loaded_energy_at(body, &place, density);
        let found = material.stressed(&stress, energy, [mass, plastic_strain]);
        Some(found.map_err(|unborne| (loading.key(), unborne)))
    }

    /// The initial state of the particle of a site of a body: values of a file take precedence over
    /// those of the whole body.
    #[must_use]
    pub fn beginning_of(&self, body: &Body, position: &Vec3, index: u64) -> Beginning {
        let mut begins = self.beginning(body, position);
        let (Some((cloud, _)), Ok(row)) = (body.cloud(), usize::try_from(index)) else {
            return begins;
        };
        if let Some(&[x, y, z]) = cloud.get(Quantity::Velocity, row) {
            begins.velocity = Vec3::new(x, y, z);
        }
        for (quantity, value) in [
            (Quantity::Density, &mut begins.density),
            (Quantity::SpecificEnergy, &mut begins.specific_energy),
            (Quantity::PlasticStrain, &mut begins.plastic_strain),
        ] {
            if let Some(&[given]) = cloud.get(quantity, row) {
                *value = given;
            }
        }
        begins
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

    /// Specific energy (J/kg) of a body at a place and a density (kg/m³), of virgin matter.
    fn energy_at(&self, body: &Body, place: &Place, density: f64) -> f64 {
        self.energy_by(body, place, density, Material::energy)
    }

    /// The same of matter that has been compressed to that density for the first time.
    #[must_use]
    pub fn loaded_energy_at(&self, body: &Body, place: &Place, density: f64) -> f64 {
        self.energy_by(body, place, density, Material::loaded_energy)
    }

    fn energy_by(
        &self,
        body: &Body,
        place: &Place,
        density: f64,
        of_temperature: fn(&Material, f64, f64) -> Option<f64>,
    ) -> f64 {
        let material = &self.materials[body.material];
        match &body.initial.heat {
            Heat::Reference => material.eos.reference_energy(density),
            Heat::Energy(energy) => energy.at(place),
            Heat::Temperature(temperature) => {
                let energy = of_temperature(material, density, temperature.at(place));
                energy.unwrap_or(f64::NAN)
            }
        }
    }
}
