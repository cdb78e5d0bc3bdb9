//! What is measured in a run.

use super::check::{Allowed, optional};
use crate::input::schema::MeasureParams;
use crate::input::source::Diagnostic;
use crate::model::MeasureOptions;

/// The table `[measure]`.
pub fn measure(params: &MeasureParams) -> Result<MeasureOptions, Diagnostic> {
    let arrival = params.arrival_pressure.as_ref();
    Ok(MeasureOptions {
        bodies: params.bodies.unwrap_or(true),
        arrival_pressure: optional(arrival, "arrival_pressure", Allowed::Positive)?,
    })
}
