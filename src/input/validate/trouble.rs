//! `[trouble]`

use super::check::{Allowed, number};
use crate::input::schema::{TroubleParams, TroublePolicyName};
use crate::input::source::Complaint;
use crate::model::{Case, Trouble, TroublePolicy};

/// Ranges as given, else the case's natural ones.
pub fn trouble(params: &TroubleParams, case: &Case) -> Result<Trouble, Complaint> {
    let natural = Trouble::natural(case);
    let speed_max = number(
        params.speed_max.as_ref(),
        "speed_max",
        natural.speed_max,
        Allowed::Positive,
    )?;
    Ok(Trouble {
        policy: match params.policy {
            None | Some(TroublePolicyName::Stop) => TroublePolicy::Stop,
            Some(TroublePolicyName::Remove) => TroublePolicy::Remove,
            Some(TroublePolicyName::Freeze) => TroublePolicy::Freeze,
        },
        speed_max,
        energy_max: number(
            params.energy_max.as_ref(),
            "energy_max",
            natural.energy_max,
            Allowed::Positive,
        )?,
        density_min: number(
            params.density_min.as_ref(),
            "density_min",
            natural.density_min,
            Allowed::Within(0.0, 1.0),
        )?,
        density_max: number(
            params.density_max.as_ref(),
            "density_max",
            natural.density_max,
            Allowed::AboveOne,
        )?,
        step_min: number(
            params.step_min.as_ref(),
            "step_min",
            natural.step_min,
            Allowed::NotNegative,
        )?,
        gain_max: number(
            params.gain_max.as_ref(),
            "gain_max",
            natural.gain_max,
            Allowed::AboveOne,
        )?,
    })
}
