//! The constants of a material by the names that the input gives them.

use super::declare::{Constants, Value};
use super::{Material, Porosity, ThermalConstants};

/// One constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// Its key below `[material.NAME]`: `eos.mie_gruneisen.c0`.
    pub key: String,
    /// Its value.
    pub value: Value,
}

impl Material {
    /// All constants of the material, each at a key of the input.
    #[must_use]
    pub fn constants(&self) -> Vec<Constant> {
        let density = Value::Number(self.matter_density(), "kg/m^3");
        let mut list = vec![constant("density", density)];
        let (law, rows) = self.eos.constants();
        list.extend(group(&format!("eos.{law}"), rows));
        match self.strength.constants() {
            None => list.push(constant("strength", Value::Word("none"))),
            Some((law, rows)) => list.extend(group(&format!("strength.{law}"), rows)),
        }
        for (law, rows) in self.failure.constants() {
            let dot = if law.is_empty() { "" } else { "." };
            list.extend(group(&format!("failure{dot}{law}"), rows));
        }
        if let Some(thermal) = &self.thermal {
            list.extend(group("thermal", heat(thermal.constants())));
        }
        let pores = self.porosity.iter().flat_map(Porosity::constants);
        list.extend(pores.map(|(key, value)| constant(&format!("porosity.{key}"), value)));
        list
    }
}

fn constant(key: &str, value: Value) -> Constant {
    Constant {
        key: key.to_owned(),
        value,
    }
}

fn group(law: &str, rows: Constants) -> impl Iterator<Item = Constant> + use<> {
    let law = law.to_owned();
    rows.into_iter()
        .map(move |(key, value)| constant(&format!("{law}.{key}"), value))
}

fn heat(constants: &ThermalConstants) -> Constants {
    let mut rows = vec![
        (
            "specific_heat",
            Value::Number(constants.specific_heat, "J/(kg K)"),
        ),
        (
            "reference_temperature",
            Value::Number(constants.reference_temperature, "K"),
        ),
    ];
    let melting = constants.melting_temperature;
    rows.extend(melting.map(|t| ("melting_temperature", Value::Number(t, "K"))));
    if constants.taylor_quinney < 1.0 {
        let share = Value::Number(constants.taylor_quinney, "");
        rows.push(("taylor_quinney", share));
    }
    rows
}
