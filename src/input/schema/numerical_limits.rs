//! Numerical failure limits as they are typed.

use serde::Deserialize;
use toml::Spanned;

use crate::input::quantity::{Placed, SpecificEnergy, Time, Velocity};
use crate::model::NumericalFailurePolicy;

optional_tables! {
    /// `[numerical_limits]`
    NumericalLimitsParams {
        /// What happens to a particle whose state is out of range.
        policy: Option<NumericalFailurePolicy> = NumericalFailurePolicy::Stop;
        /// Largest speed.
        speed_max: Option<Placed<Velocity>>, Positive => "20 times the case's own speeds";
        /// Largest magnitude of the specific energy.
        energy_max: Option<Placed<SpecificEnergy>>, Positive => "half the square of the largest speed";
        /// Smallest density over that at the start.
        density_min: Option<Spanned<f64>> = 1e-6, Within(0.0, 1.0);
        /// Largest density over that at the start.
        density_max: Option<Spanned<f64>> = 100.0, AboveOne;
        /// Smallest time step.
        step_min: Option<Placed<Time>>, NotNegative => "a millionth of the shortest h over the case's own speeds";
        // A sound run never reaches one.
        /// Largest kinetic energy over what there was and has been put in.
        gain_max: Option<Spanned<f64>> = 10.0, AboveOne;
    }
}
