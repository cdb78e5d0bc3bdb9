//! What snapshots show and no step needs.

use super::simulation::Simulation;

impl Simulation {
    /// Writes the stress that contact forces carried at the end of the last step into
    /// `contact_stress`. Only right after a step, before anything else is done with the particles.
    pub fn measure_contact_stress(&mut self) {
        let dt = self.state.last_dt;
        self.contact
            .measure_stress(&mut self.particles, &self.lists, dt);
    }
}
