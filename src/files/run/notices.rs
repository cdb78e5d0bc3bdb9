//! Notices of changes in a run, and warnings, each given once.

use super::announce::decomposition;
use comm::Comm;
use engine::step::{Simulation, measurements};
use model::SphForm;
use model::readable::short;

/// Error of the angular momentum that is worth a warning.
const WORTH: f64 = 0.01;

/// Notices given so far.
#[derive(Debug, Default)]
pub struct Notices {
    drift: bool,
    yielded: bool,
    /// Changes of the slabs so far.
    changes: u64,
}

impl Notices {
    /// A warning, the first time that it is due.
    pub fn notice(&mut self, simulation: &Simulation) -> Option<String> {
        self.drift(simulation).or_else(|| self.yielded(simulation))
    }

    /// The new decomposition, each time that it changes.
    pub fn decomposition(&mut self, comm: &Comm, simulation: &Simulation) -> Option<String> {
        let changes = simulation.changes_of_slabs();
        let has_changed = std::mem::replace(&mut self.changes, changes) != changes;
        has_changed.then(|| {
            let (step, how) = (simulation.state.step, decomposition(comm, simulation));
            format!("decomposition from step {step} on: {how}")
        })
    }

    /// A warning if angular momentum is off by more than a hundredth that no plane, surface, load or
    /// gravity explains.
    fn drift(&mut self, simulation: &Simulation) -> Option<String> {
        let state = &simulation.state;
        let errors = state.worst.angular_momentum_error;
        let error = errors.into_iter().fold(0.0, f64::max);
        if self.drift || error <= WORTH {
            return None;
        }
        self.drift = true;
        let help = match simulation.case.sph.form {
            SphForm::Corrected => "artificial stress, XSPH and friction change it",
            _ => "bodies that turn need `sph.form = \"corrected\"`",
        };
        let percent = 100.0 * error;
        Some(format!(
            "warning: angular momentum is off by {percent:.1} % of the largest so far at step {}: {help}",
            state.step
        ))
    }

    /// A warning if material in an absorbing zone, which is to be elastic, has yielded or failed.
    fn yielded(&mut self, simulation: &Simulation) -> Option<String> {
        let state = &simulation.state;
        let mass = state.totals.yielded_mass - state.initial.yielded_mass;
        if self.yielded || mass <= 0.0 {
            return None;
        }
        self.yielded = true;
        Some(format!(
            "warning: {} kg in absorbing zones have yielded or failed at step {}: zones take up \
             elastic waves; let them begin farther away",
            short(measurements::images(simulation).sum(mass)),
            state.step
        ))
    }
}
