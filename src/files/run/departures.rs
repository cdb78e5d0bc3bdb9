//! Tells once of each body that it has begun to leave the box of interest.

use super::say::{counted, seconds};
use engine::step::Simulation;
use model::readable::shown;

/// Bodies of which it has been told, in the order of the case.
#[derive(Debug, Default)]
pub struct Departures(Vec<bool>);

impl Departures {
    /// Of a run that begins or goes on; what its state knows has been told.
    pub fn new(simulation: &Simulation) -> Self {
        let departed = &simulation.state.departed;
        Self(departed.iter().map(|gone| gone.particles > 0).collect())
    }

    /// Lines about bodies that have begun to leave since the last time.
    pub fn notices(&mut self, simulation: &Simulation) -> Vec<String> {
        let (case, state) = (&simulation.case, &simulation.state);
        let mut lines = Vec::new();
        let bodies = case.bodies.iter().zip(&state.departed);
        for ((body, gone), told) in bodies.zip(&mut self.0) {
            if gone.particles == 0 || *told {
                continue;
            }
            *told = true;
            lines.push(format!(
                "`{}` begins to leave the box of interest: {} of {}, at {}",
                body.name,
                counted(gone.particles, "particle"),
                shown(
                    gone.mass,
                    crate::output::unit_of_model("kg", case.dimension)
                ),
                seconds(state.time)
            ));
        }
        lines
    }
}
