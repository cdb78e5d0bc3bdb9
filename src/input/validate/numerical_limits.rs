//! `[numerical_limits]`

use crate::input::schema::NumericalLimitsParams;
use crate::input::source::Diagnostic;
use crate::model::{Case, NumericalLimits};

/// Ranges as given, else the case's natural ones.
pub fn numerical_limits(
    params: &NumericalLimitsParams,
    case: &Case,
) -> Result<NumericalLimits, Diagnostic> {
    let natural = NumericalLimits::natural(case);
    Ok(NumericalLimits {
        policy: params.policy(),
        speed_max: params.speed_max()?.unwrap_or(natural.speed_max),
        energy_max: params.energy_max()?.unwrap_or(natural.energy_max),
        density_min: params.density_min()?,
        density_max: params.density_max()?,
        step_min: params.step_min()?.unwrap_or(natural.step_min),
        gain_max: params.gain_max()?,
    })
}
