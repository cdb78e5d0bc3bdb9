//! Numerical failure limits as they are typed.

use serde::Deserialize;
use toml::Spanned;

use crate::input::quantity::{Placed, SpecificEnergy, Time, Velocity};
use model::NumericalFailurePolicy;

optional_tables! {
    /// `[numerical_limits]`
    NumericalLimitsParams {
        /// What happens to a particle whose state is out of range; `"stop"` if absent.
        policy: Option<NumericalFailurePolicy>,
        /// Largest speed; 20 times the case's own speeds if absent.
        speed_max: Option<Placed<Velocity>>,
        /// Largest magnitude of the specific energy; half the square of the largest speed if absent.
        energy_max: Option<Placed<SpecificEnergy>>,
        /// Smallest density over that at the start; `1e-6` if absent.
        density_min: Option<Spanned<f64>>,
        /// Largest density over that at the start; `100` if absent.
        density_max: Option<Spanned<f64>>,
        /// Smallest time step; a millionth of the shortest h over the case's own speeds if absent.
        step_min: Option<Placed<Time>>,
        /// Largest kinetic energy over what there was and has been put in; `10` if absent.
        gain_max: Option<Spanned<f64>>,
    }
}
