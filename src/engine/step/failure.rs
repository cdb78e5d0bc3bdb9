//! Numerical failures: their detection, and going on without the particles that have failed.

use super::error::StepError;
use super::simulation::Simulation;
use crate::diagnose::{Leave, NumericalFailure, PostMortem, fastest, is_explained};
use comm::Comm;
use model::NumericalFailurePolicy;
use particles::HaloPhase;

/// Checks that the kinetic energy, as of the last [`diagnose`](super::measurements::diagnose), has a source. Collective.
///
/// # Errors
/// The same on all ranks: [`StepError::Failure`] of the fastest particle if it has none.
pub fn check_gain(simulation: &Simulation, comm: &Comm) -> Result<(), StepError> {
    let hidden = simulation.step_control.limits.hidden_energy;
    let most = simulation.case.numerical_limits.gain_max;
    if is_explained(&simulation.state, hidden, most) {
        return Ok(());
    }
    let id = fastest(comm, &simulation.particles, &simulation.loads);
    Err(simulation.failure(comm, NumericalFailure::Gain, id))
}

/// The particle `id` and its surroundings, on the rank that owns it; nothing on others. Halo particles have the state of their
/// owners from here on. Right after a step, before the particles change. Collective.
#[must_use]
pub fn post_mortem(simulation: &mut Simulation, comm: &Comm, id: u64) -> Option<PostMortem> {
    let reach = 4.0 * simulation.sph.smoothing.longest();
    let past = simulation.step_control.past();
    let (particles, state) = (&mut simulation.particles, &simulation.state);
    (simulation.space.halo).exchange(comm, particles, HaloPhase::STATE);
    PostMortem::of(id, comm.rank(), particles, reach, state, past)
}

/// Takes out all particles whose state is out of range, and keeps them for the files if they are
/// to be frozen. For a step that [`StepError::Failure`] has ended and whose particles are all
/// finite. Returns the number of particles taken out on all ranks. Collective.
///
/// # Errors
/// The same on all ranks if a particle fails again, or nothing is left.
pub fn remove_failed(simulation: &mut Simulation, comm: &Comm) -> Result<u64, StepError> {
    let Simulation {
        case,
        particles,
        step_control,
        sph,
        loads,
        removal,
        ..
    } = simulation;
    let criteria = step_control.criteria(sph, loads.gravity);
    removal.choose_failed(particles, loads, case.sph.form, criteria);
    if case.numerical_limits.policy == NumericalFailurePolicy::Freeze {
        removal.freeze(particles);
    }
    simulation.take_out(comm, Leave::Failed)
}
