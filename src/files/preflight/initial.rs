//! Initial values of bodies, in words.

use model::readable::{shown, shown_vector};
use model::{Body, Case, Heat, Quantity};
use populate::{self, Site};

/// Bodies with more particles are sampled on a wider lattice.
const MOST_SAMPLES: u64 = 1_000_000;
/// A pressure from the start is worth a warning from this share of the bulk modulus on: that of a
/// metal 15 K warmer.
const PRESSURE: f64 = 1e-3;
/// Densities over that of the reference state that are worth no warning.
const SOUND: std::ops::Range<f64> = 0.8..1.5;

/// Initial values of the particles of a body, from the smallest to the largest; `None` for a body at
/// rest in its material's reference state.
#[must_use]
pub fn beginning(case: &Case, body: &Body) -> Option<String> {
    let ranges = Ranges::of(case, body, MOST_SAMPLES);
    let mut words = Vec::new();
    if ranges.velocity.iter().all(Range::is_one) {
        let velocity = ranges.velocity.map(|range| range.0[0]);
        if velocity != [0.0; 3] {
            let components = &velocity[..case.dimension];
            words.push(format!("velocity {}", shown_vector(components, "m/s")));
        }
    } else {
        for (range, axis) in ranges
            .velocity
            .iter()
            .zip(["x", "y", "z"])
            .take(case.dimension)
        {
            if range.0 != [0.0; 2] {
                words.push(format!("{axis} velocity {}", range.words("m/s")));
            }
        }
    }
    match body.initial.heat {
        Heat::Temperature(_) => {
            words.push(format!("temperature {}", ranges.temperature.words("K")));
        }
        Heat::Energy(_) => words.push(format!("specific energy {}", ranges.energy.words("J/kg"))),
        Heat::Reference if body.holds(Quantity::SpecificEnergy) => {
            words.push(format!("specific energy {}", ranges.energy.words("J/kg")));
        }
        Heat::Reference => {}
    }
    if body.density.is_some() {
        words.push(format!("density {}", ranges.density.words("kg/m^3")));
    }
    let is_given = [Quantity::Density, Quantity::SpecificEnergy]
        .into_iter()
        .any(|quantity| body.holds(quantity));
    if body.density.is_some() || body.initial.heat != Heat::Reference || is_given {
        words.push(format!("pressure {}", ranges.pressure.words("Pa")));
    }
    if ranges.shear.0 != [0.0; 2] {
        words.push(format!("shear (von Mises) {}", ranges.shear.words("Pa")));
    }
    if ranges.strain.0 != [0.0; 2] {
        words.push(format!("plastic strain {}", ranges.strain.words("")));
    }
    (!words.is_empty()).then(|| words.join(", "))
}

/// Bodies under pressure from the start, since they are heated or cooled at the density of another
/// temperature.
pub fn warnings(case: &Case, messages: &mut Vec<String>) {
    for body in &case.bodies {
        let Heat::Temperature(temperature) = &body.initial.heat else {
            continue;
        };
        let material = &case.materials[body.material];
        let [low, high] = Ranges::of(case, body, MOST_SAMPLES / 100).pressure.0;
        let largest = if high.abs() < low.abs() { low } else { high };
        let bulk_modulus = material.bulk_modulus();
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
        messages.push(format!(
            "`{}` has its reference density at another temperature and begins with a pressure of {}{instead}",
            body.name,
            shown(largest, "Pa"),
        ));
    }
}

/// Bodies that the stress which they begin under compresses or stretches beyond what their material is made for.
pub fn squeezed(case: &Case, messages: &mut Vec<String>) {
    for body in &case.bodies {
        let Some(loading) = &body.initial.loading else {
            continue;
        };
        let reference = case.materials[body.material].reference_density;
        let [low, high] = Ranges::of(case, body, MOST_SAMPLES / 100).density.0;
        let densest = if high / reference > reference / low {
            high
        } else {
            low
        };
        if !SOUND.contains(&(densest / reference)) {
            messages.push(format!(
                "the `{}` that `{}` begins under brings its material to {} times its reference density",
                loading.key(),
                body.name,
                shown(densest / reference, "")
            ));
        }
    }
}

/// The density (kg/m³) at which the material of a body is free of pressure at a temperature (K), if there
/// is one within a quarter of the reference density.
fn free_density(case: &Case, body: &Body, temperature: f64) -> Option<f64> {
    let material = &case.materials[body.material];
    let reference = material.reference_density;
    let pressure = |density: f64| {
        let energy = material.energy(density, temperature)?;
        Some(material.virgin(density, energy).pressure)
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

    fn include(&mut self, value: f64) {
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

/// Ranges of the initial values of a body's particles, in SI units.
struct Ranges {
    velocity: [Range; 3],
    temperature: Range,
    energy: Range,
    density: Range,
    pressure: Range,
    shear: Range,
    strain: Range,
}

impl Ranges {
    /// Takes `most` samples at most; one is enough where all are equal.
    fn of(case: &Case, body: &Body, most: u64) -> Self {
        let mut ranges = Self {
            velocity: [Range::NONE; 3],
            temperature: Range::NONE,
            energy: Range::NONE,
            density: Range::NONE,
            pressure: Range::NONE,
            shear: Range::NONE,
            strain: Range::NONE,
        };
        let alike = !body.initial.varies() && body.speed_spread() == 0.0 && body.cloud().is_none();
        if alike {
            let any = Site {
                position: body.shape.centre().into(),
                index: 0,
                share: 1.0,
            };
            ranges.include(case, body, &any);
            return ranges;
        }
        let (sites, _) = populate::sample(body, case.dimension, &case.symmetry, most);
        sites.for_each(|site| ranges.include(case, body, &site));
        ranges
    }

    fn include(&mut self, case: &Case, body: &Body, site: &Site) {
        let material = &case.materials[body.material];
        let initial = case.beginning_of(body, &site.position.into(), site.index);
        for (range, v) in self.velocity.iter_mut().zip(&initial.velocity) {
            range.include(*v);
        }
        let energy = initial.specific_energy;
        let state = match body.initial.loading {
            None => material.virgin(initial.density, energy),
            Some(_) => material.loaded(initial.density, energy),
        };
        self.temperature.include(initial.temperature.unwrap_or(0.0));
        self.energy.include(energy);
        self.density.include(initial.density);
        let [xx, yy, zz, xy, xz, yz] = initial.deviatoric_stress;
        let square = (xx * xx + yy * yy + zz * zz) + 2.0 * (xy * xy + xz * xz + yz * yz);
        self.shear.include((1.5 * square).sqrt());
        // Failed material bears no tension.
        let row = usize::try_from(site.index).unwrap_or(usize::MAX);
        let damage = body
            .cloud()
            .and_then(|(cloud, _)| cloud.get(Quantity::Damage, row));
        let has_failed = damage.is_some_and(|damage| damage[0] >= 1.0);
        let least = if has_failed { 0.0 } else { f64::NEG_INFINITY };
        self.pressure.include(state.pressure.max(least));
        self.strain.include(initial.plastic_strain);
    }
}
