//! What is measured in a run, as it is typed.

use serde::Deserialize;

use crate::input::quantity::{Placed, Pressure};

optional_tables! {
    /// `[measure]`
    MeasureParams {
        /// Whether `bodies.csv` is written; it is if absent.
        bodies: Option<bool>,
        /// Pressure that counts as the arrival of a shock; that of each material if absent.
        arrival_pressure: Option<Placed<Pressure>>,
    }
}
