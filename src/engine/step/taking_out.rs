//! Taking particles out of a run: their numbers are booked, and the forces on the others are summed
//! anew where they stand, so that momentum and energy balance as before.
//!
//! Velocities do not change by it, so nothing is kicked. What had leant on the particles or hung on
//! them is free of them from then on, as at a new surface.

use super::candidate::{Criteria, criteria_fields};
use super::error::StepError;
use super::removal;
use super::simulation::Simulation;
use crate::diagnose::{Leave, Reason};
use crate::sph::with_formulation;
use comm::Comm;
use model::NumericalFailurePolicy;

/// Steps between two looks for what has left the box of interest: it flies some spacings meanwhile, ten in
/// the fastest impacts, and the new sums after a removal take as long as a step.
const LOOK_EVERY: u64 = 20;

impl Leave {
    /// What is said where nothing is left.
    fn of_all(self) -> &'static str {
        match self {
            Self::Failed => "all were out of range",
            Self::Departed => "the last ones have left the box of interest (domain.keep)",
        }
    }
}

impl Simulation {
    /// Takes out all particles whose state is out of range, and keeps them for the files if they are
    /// to be frozen. For a step that [`StepError::Failure`] has ended and whose particles are all
    /// finite. Collective. Gives the number of particles taken out on all ranks.
    ///
    /// # Errors
    /// The same on all ranks if a particle fails again, or nothing left.
    pub fn remove_failed(&mut self, comm: &Comm) -> Result<u64, StepError> {
        let rules = (self.case.time_step, self.loads.gravity);
        let (particles, loads, limits) = (&self.particles, &self.loads, &self.step_control.limits);
        self.leaving = with_formulation!(self.case.sph.form, Form => {
            let criteria = Criteria::<Form>::new(criteria_fields!(particles), &self.sph, limits, rules);
            removal::failed(particles, loads, &criteria)
        });
        if self.case.numerical_limits.policy == NumericalFailurePolicy::Freeze {
            self.frozen.freeze(&self.particles, &self.leaving);
        }
        self.take_out(comm, Leave::Failed)
    }

    /// Every few steps takes out what has left the box of interest, if the case has one. After the
    /// choice of a step, which finds out what is no number. Collective.
    ///
    /// # Errors
    /// The same on all ranks if a particle fails, or nothing is left.
    pub(super) fn remove_departed(&mut self, comm: &Comm) -> Result<(), StepError> {
        let Some(keep) = &self.case.domain.keep else {
            return Ok(());
        };
        if !self.state.step.is_multiple_of(LOOK_EVERY) {
            return Ok(());
        }
        let lists = (&mut self.leaving, &mut self.collector);
        removal::find_departed(&self.particles, &self.loads, keep, lists);
        if comm.any(!self.leaving.is_empty()) {
            // The step is chosen once more.
            let limited = self.state.dt_reason == Reason::Contact;
            self.state.worst.contact_limited_steps -= u64::from(limited);
            self.take_out(comm, Leave::Departed)?;
        }
        Ok(())
    }

    /// Takes out the particles in [`Self::leaving`] and books them. Collective. Gives how many there
    /// are on all ranks.
    fn take_out(&mut self, comm: &Comm, why: Leave) -> Result<u64, StepError> {
        let mut count = [self.leaving.len() as u64, self.particles.owned() as u64];
        let counted = (&self.particles, self.case.bodies.len());
        let state = &mut self.state;
        removal::book(comm, (state, why), counted, &self.loads, &self.leaving);
        let asleep = &self.dormant.asleep;
        debug_assert!(!self.leaving.iter().any(|&i| asleep.holds(i as usize)));
        self.particles.remove(&mut self.leaving, &mut Vec::new());
        comm.sum_u64(&mut count);
        if count[0] == count[1] {
            return Err(StepError::NothingLeft {
                step: self.state.step,
                why: why.of_all(),
            });
        }
        let contact_energy = self.state.contact_energy;
        if why == Leave::Failed {
            // What was predicted of its neighbours may be spoilt.
            let owned = self.particles.owned();
            let particles = &mut self.particles;
            particles.predicted_velocity[..owned].copy_from_slice(&particles.velocity[..owned]);
            particles.predicted_density[..owned].copy_from_slice(&particles.density[..owned]);
        }
        self.loads
            .prepare(&self.case, self.state.time, self.state.time);
        self.evaluate(comm, 0.0);
        let own = self.kick(0.0);
        // The sums of a step of no length have no work in them. Its defect is taken with what has
        // been lost, so the loss must be known first.
        let worst = self.state.worst;
        let candidate = self.book_step(comm, 0.0, own);
        let lost = contact_energy - self.state.contact_energy;
        *self.state.leaving(why).1 += lost;
        self.state.worst = worst;
        self.state.book_defect();
        self.choose_step(comm, candidate)?;
        Ok(count[0])
    }
}
