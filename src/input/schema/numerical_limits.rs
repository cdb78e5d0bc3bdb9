//! Numerical failure limits as they are typed.

use serde::Deserialize;
use toml::Spanned;

use crate::input::quantity::{Placed, SpecificEnergy, Time, Velocity};
use crate::model::NumericalFailurePolicy;

optional_tables! {
    /// `[numerical_limits]`
    NumericalLimitsParams {
        /// What happens to a particle whose state is out of range.
        policy: Option<NumericalFailurePolicy>,
        /// Largest speed.
        speed_max: Option<Placed<Velocity>>,
        /// Largest magnitude of the specific energy.
        energy_max: Option<Placed<SpecificEnergy>>,
        /// Smallest density over that at the start.
        density_min: Option<Spanned<f64>>,
        /// Largest density over that at the start.
        density_max: Option<Spanned<f64>>,
        /// Smallest time step.
        step_min: Option<Placed<Time>>,
        /// Largest kinetic energy over what there was and has been put in.
        gain_max: Option<Spanned<f64>>,
    }
}
