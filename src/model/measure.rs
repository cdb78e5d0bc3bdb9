//! What is measured in a run.

use super::gauge::{Gauge, Witness};
use crate::material::Material;

/// What is measured in a run: the tables `[measure]`, `[[gauge]]` and `[[witness]]`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasureOptions {
    /// Whether `bodies.csv` is written.
    pub bodies: bool,
    /// Pressure (Pa) beyond which a shock has arrived; by material if absent.
    pub arrival_pressure: Option<f64>,
    /// Gauges, in the order of the input.
    pub gauges: Vec<Gauge>,
    /// Witness planes, in the order of the input.
    pub witnesses: Vec<Witness>,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        Self {
            bodies: true,
            arrival_pressure: None,
            gauges: Vec::new(),
            witnesses: Vec::new(),
        }
    }
}

/// A shock has arrived where pressure is beyond this fraction of the bulk modulus of the matter: a
/// tenth of a percent of compression, well above the pressures at which a filling settles and
/// below the elastic limits of metals.
const ARRIVED: f64 = 1e-3;

impl MeasureOptions {
    /// The pressure (Pa) beyond which a shock has arrived in a material.
    #[must_use]
    pub fn arrival_of(&self, material: &Material) -> f64 {
        let modulus = || material.eos.bulk_modulus(material.reference_density);
        self.arrival_pressure.unwrap_or_else(|| ARRIVED * modulus())
    }
}
