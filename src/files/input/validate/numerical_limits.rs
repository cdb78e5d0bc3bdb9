//! `[numerical_limits]`

use crate::input::schema::NumericalLimitsParams;
use crate::input::source::Diagnostic;
use model::{Case, NumericalLimits};

/// Ranges as given, else the case's natural ones.
pub fn numerical_limits(
    params: &NumericalLimitsParams,
    case: &Case,
) -> Result<NumericalLimits, Diagnostic> {
    let natural = NumericalLimits::natural(case);
    Ok(NumericalLimits {
        policy: params.policy.unwrap_or_default(),
        speed_max: number!(params.speed_max, or natural.speed_max, Positive),
        energy_max: number!(params.energy_max, or natural.energy_max, Positive),
        density_min: number!(params.density_min, or natural.density_min, Within(0.0, 1.0)),
        density_max: number!(params.density_max, or natural.density_max, AboveOne),
        step_min: number!(params.step_min, or natural.step_min, NotNegative),
        gain_max: number!(params.gain_max, or natural.gain_max, AboveOne),
    })
}
