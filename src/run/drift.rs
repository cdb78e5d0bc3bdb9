//! Tells once that angular momentum has drifted.

use crate::model::SphForm;
use crate::step::Simulation;

/// Error of the angular momentum that is worth a warning.
const WORTH: f64 = 0.01;

/// Whether it has been told.
#[derive(Debug, Default)]
pub struct Drift(bool);

impl Drift {
    /// A warning, the first time that angular momentum is off by more than a hundredth that no plane,
    /// surface, load or gravity explains.
    pub fn notice(&mut self, simulation: &Simulation) -> Option<String> {
        let state = &simulation.state;
        let errors = state.worst.angular_momentum_error;
        let error = errors.into_iter().fold(0.0, f64::max);
        if self.0 || error <= WORTH {
            return None;
        }
        self.0 = true;
        let help = match simulation.case.sph.form {
            SphForm::Corrected => "artificial stress, XSPH and friction change it",
            _ => "bodies that turn need `sph.form = \"corrected\"`",
        };
        let percent = 100.0 * error;
        Some(format!(
            "warning: angular momentum is off by {percent:.1} % at step {}: {help}",
            state.step
        ))
    }
}
