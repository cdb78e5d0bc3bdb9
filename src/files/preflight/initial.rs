//! What bodies begin with, in words.

use model::readable::{shown, shown_vector};
use model::{Body, Case, Heat, Quantity};
use populate::{self, Site};

/// Bodies with more particles are looked at on a wider lattice.
const MOST_PLACES: u64 = 1_000_000;
/// A pressure from the start is worth a warning from this share of the bulk modulus on: that of a
/// metal 15 K warmer.
const PRESSURE: f64 = 1e-3;

/// What the particles of a body begin with, from the smallest to the largest; nothing of a body at
/// rest in its material's reference state.
#[must_use]
pub fn beginning(case: &Case, body: &Body) -> Option<String> {
    let seen = Seen::of(case, body, MOST_PLACES);
    let mut found = Vec::new();
    if seen.velocity.iter().all(Range::is_one) {
        let velocity = seen.velocity.map(|range| range.0[0]);
        if velocity != [0.0; 3] {
            let components = &velocity[..case.dimension];
            found.push(format!("velocity {}", shown_vector(components, "m/s")));
        }
    } else {
        for (range, axis) in seen
            .velocity
            .iter()
            .zip(["x", "y", "z"])
            .take(case.dimension)
        {
            if range.0 != [0.0; 2] {
                found.push(format!("{axis} velocity {}", range.words("m/s")));
            }
        }
    }
    match body.initial.heat {
        Heat::Temperature(_) => found.push(format!("temperature {}", seen.temperature.words("K"))),
        Heat::Energy(_) => found.push(format!("specific energy {}", seen.energy.words("J/kg"))),
        Heat::Reference if body.holds(Quantity::SpecificEnergy) => {
            found.push(format!("specific energy {}", seen.energy.words("J/kg")));
        }
        Heat::Reference => {}
    }
    if let Some(density) = body.density {
        found.push(format!("density {}", shown(density, "kg/m^3")));
    }
    let is_told = [Quantity::Density, Quantity::SpecificEnergy]
        .into_iter()
        .any(|quantity| body.holds(quantity));
    if body.density.is_some() || body.initial.heat != Heat::Reference || is_told {
        found.push(format!("pressure {}", seen.pressure.words("Pa")));
    }
    if seen.strain.0 != [0.0; 2] {
        found.push(format!("plastic strain {}", seen.strain.words("")));
    }
    (!found.is_empty()).then(|| found.join(", "))
}

/// Bodies under pressure from the start, since they are heated or cooled at the density of another
/// temperature.
pub fn warnings(case: &Case, found: &mut Vec<String>) {
    for body in &case.bodies {
        let Heat::Temperature(temperature) = &body.initial.heat else {
            continue;
        };
        let material = &case.materials[body.material];
        let [low, high] = Seen::of(case, body, MOST_PLACES / 100).pressure.0;
        let largest = if high.abs() < low.abs() { low } else { high };
        let bulk_modulus = material.eos.bulk_modulus(material.reference_density);
        if body.density.is_some() || largest.abs() <= PRESSURE * bulk_modulus {
            continue;
        }
        let free = temperature
            .constant()
            .and_then(|t| free_density(case, body, t));
        let instead = free.map_or_else(String::new, |density| {
            format!(
                "; at a `density` of {} it is free",
                shown(density, "kg/m^3")
            )
        });
        found.push(format!(
            "`{}` has its reference density at another temperature and begins with a pressure of {}{instead}",
            body.name,
            shown(largest, "Pa"),
        ));
    }
}

/// The density (kg/m³) at which matter of a body is free of pressure at a temperature (K), if there is
/// one within a quarter of the reference density.
fn free_density(case: &Case, body: &Body, temperature: f64) -> Option<f64> {
    let material = &case.materials[body.material];
    let reference = material.reference_density;
    let pressure = |density: f64| {
        let energy = material.energy(density, temperature)?;
        Some(material.eos.at(reference, density, energy).pressure)
    };
    let (mut low, mut high) = (0.75 * reference, 1.25 * reference);
    if pressure(low)? > 0.0 || pressure(high)? < 0.0 {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if pressure(middle)? < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

/// The smallest and the largest of some values.
#[derive(Clone, Copy)]
struct Range([f64; 2]);

impl Range {
    const NONE: Self = Self([f64::INFINITY, f64::NEG_INFINITY]);

    fn see(&mut self, value: f64) {
        self.0 = [self.0[0].min(value), self.0[1].max(value)];
    }

    fn is_one(&self) -> bool {
        self.0[0].to_bits() == self.0[1].to_bits()
    }

    fn words(&self, unit: &str) -> String {
        let [low, high] = self.0.map(|value| shown(value, unit));
        if low == high {
            return low;
        }
        format!("{low} to {high}")
    }
}

/// Ranges of what the particles of a body begin with, in SI units.
struct Seen {
    velocity: [Range; 3],
    temperature: Range,
    energy: Range,
    pressure: Range,
    strain: Range,
}

impl Seen {
    /// Looks at `most` places at most; one is enough where all are alike.
    fn of(case: &Case, body: &Body, most: u64) -> Self {
        let mut seen = Self {
            velocity: [Range::NONE; 3],
            temperature: Range::NONE,
            energy: Range::NONE,
            pressure: Range::NONE,
            strain: Range::NONE,
        };
        let alike = !body.initial.varies() && body.speed_spread() == 0.0 && body.cloud().is_none();
        let (places, _) = populate::sample(body, case.dimension, &case.symmetry, most);
        for site in places.take(if alike { 1 } else { usize::MAX }) {
            seen.see(case, body, &site);
        }
        seen
    }

    fn see(&mut self, case: &Case, body: &Body, site: &Site) {
        let material = &case.materials[body.material];
        let found = case.beginning_of(body, &site.position.into(), site.index);
        for (range, v) in self.velocity.iter_mut().zip(&found.velocity) {
            range.see(*v);
        }
        let energy = found.specific_energy;
        let state = material
            .eos
            .at(material.reference_density, found.density, energy);
        self.temperature.see(found.temperature.unwrap_or(0.0));
        self.energy.see(energy);
        // Matter that has failed bears no tension.
        let row = usize::try_from(site.index).unwrap_or(usize::MAX);
        let damage = body
            .cloud()
            .and_then(|(cloud, _)| cloud.get(Quantity::Damage, row));
        let has_failed = damage.is_some_and(|damage| damage[0] >= 1.0);
        let least = if has_failed { 0.0 } else { f64::NEG_INFINITY };
        self.pressure.see(state.pressure.max(least));
        self.strain.see(found.plastic_strain);
    }
}
