//! Meaning of the numbers of a file that says nothing of units.

use super::Fault;
use model::Quantity;
use model::units::Powers;

/// One unit of length, mass and time of a file, in SI units, as far as they are stated. All others
/// follow: a velocity is a length in a time, a density a mass in a cube of a length.
#[derive(Debug, Default, Clone, Copy)]
pub struct UnitSystem {
    /// Metres.
    pub length: Option<f64>,
    /// Kilograms.
    pub mass: Option<f64>,
    /// Seconds.
    pub time: Option<f64>,
}

impl UnitSystem {
    /// One unit of a quantity in SI units.
    ///
    /// # Errors
    /// The key of a unit that it takes and that is not stated.
    pub fn factor(&self, quantity: Quantity, dimension: usize) -> Result<f64, Fault> {
        self.of(quantity.powers_in(dimension))
            .map_err(|key| missing(key, quantity.name()))
    }

    /// Metres of one unit of length.
    ///
    /// # Errors
    /// If it is not stated.
    pub fn metre(&self) -> Result<f64, Fault> {
        self.length.ok_or_else(|| missing("unit", "places"))
    }

    /// One unit of a dimension, or the key of a unit that is not stated.
    fn of(&self, powers: Powers) -> Result<f64, &'static str> {
        let units = [
            (self.length, "unit"),
            (self.mass, "mass_unit"),
            (self.time, "time_unit"),
        ];
        let mut factor = 1.0;
        for ((unit, key), power) in units.into_iter().zip(powers) {
            if power != 0 {
                factor *= unit.ok_or(key)?.powi(power);
            }
        }
        Ok(factor)
    }
}

fn missing(key: &'static str, what: &str) -> Fault {
    let example = match key {
        "unit" => "unit = \"1 mm\"",
        "mass_unit" => "mass_unit = \"1 g\"",
        _ => "time_unit = \"1 ms\"",
    };
    let words = format!(
        "it does not say the units of its {what}: state `{key}`, one of the file, as in `{example}`"
    );
    Fault::of("file", words)
}
