//! Notices that bodies have begun to leave the box of interest, once for each.

use super::say::{counted, seconds};
use engine::step::{Simulation, measurements};
use model::readable::shown;

/// Bodies that have been reported, in the order of the case.
#[derive(Debug, Default)]
pub struct Departures(Vec<bool>);

impl Departures {
    /// Of a run that begins or continues; departures in its state have been reported.
    pub fn new(simulation: &Simulation) -> Self {
        let departed = &simulation.state.departed;
        Self(departed.iter().map(|gone| gone.particles > 0).collect())
    }

    /// Lines about bodies that have begun to leave since the last time.
    pub fn notices(&mut self, simulation: &Simulation) -> Vec<String> {
        let (case, state) = (&simulation.case, &simulation.state);
        let whole = measurements::images(simulation);
        let mut lines = Vec::new();
        let bodies = case.bodies.iter().zip(&state.departed);
        for ((body, gone), reported) in bodies.zip(&mut self.0) {
            if gone.particles == 0 || *reported {
                continue;
            }
            *reported = true;
            lines.push(format!(
                "`{}` begins to leave the box of interest: {} of {}, at {}",
                body.name,
                counted(whole.count(gone.particles), "particle"),
                shown(
                    whole.sum(gone.mass),
                    crate::output::unit_of_model("kg", case.extent())
                ),
                seconds(state.time)
            ));
        }
        lines
    }
}
