//! A run that continues from a checkpoint.

use std::path::PathBuf;

use super::driver::Driver;
use super::launch::{Launch, give_up};
use super::options::CommonArgs;
use super::saved_case::ResolvedCase;
use super::say::seconds;
use crate::output::RunFolder;
use crate::output::checkpoint::Restored;
use engine::step::{Reason, RunState, Simulation};
use model::Case;
use particles::ParticleStore;

/// The checkpoint and the folder of a restart.
pub struct Origin {
    /// The checkpoint.
    pub checkpoint: PathBuf,
    /// Its particles, of this rank.
    pub particles: ParticleStore,
    /// Set if a stop wrote a snapshot of the checkpoint's step.
    pub stop: bool,
    /// Newer checkpoints of the run that cannot be read.
    pub passed_over: Vec<PathBuf>,
    /// Folder of the continued run.
    pub folder: RunFolder,
    /// Set if this is the folder of the run itself.
    pub own: bool,
}

/// The state of the run that a checkpoint holds.
///
/// # Errors
/// A text if it cannot be read, or is of another step or time than the checkpoint.
pub fn state_of(restored: &Restored) -> Result<RunState, String> {
    let state = serde_json::from_str::<RunState>(&restored.state).map_err(|e| e.to_string())?;
    if (state.step, state.time.to_bits()) == (restored.step, restored.time.to_bits()) {
        Ok(state)
    } else {
        Err("it is of another step or time".to_owned())
    }
}

/// Sets up a restart, which changes nothing that cannot be undone, and steps to the end; returns the
/// exit code. Another folder than the run's own is cleared if `force`. Collective.
#[must_use]
pub fn go_on(
    launch: &Launch,
    args: &CommonArgs,
    resolved_case: ResolvedCase,
    state: RunState,
    mut origin: Origin,
    force: bool,
    mut warnings: Vec<String>,
) -> u8 {
    let comm = launch.comm;
    let folder = &mut origin.folder;
    let (step, time) = (state.step, state.time);
    if state.last_reason == Reason::End {
        warnings.push(format!(
            "step {step} was shortened to end at {}, so that a run with the later end from its \
             start would differ in the last digits",
            seconds(time)
        ));
    }
    let resolved = resolved_case.case.resolved.clone();
    let simulation = match Simulation::resume(resolved_case.case, comm, state, origin.particles) {
        Ok(simulation) => simulation,
        Err(error) => return give_up(comm, &error.to_string()),
    };
    let begun = if origin.own {
        let resolved = resolved_case.renew.then_some(&resolved[..]);
        folder.resume(comm, resolved, step, time, origin.stop, &origin.passed_over)
    } else {
        let created = folder.create(comm, &resolved, force);
        created.map(|kept| {
            warnings.extend(kept);
            None
        })
    };
    let folder = &origin.folder;
    let aside = match begun {
        Ok(aside) => aside,
        Err(error) => return give_up(comm, &error.to_string()),
    };
    let checkpoint = Some(origin.checkpoint.as_path());
    match Driver::begin(launch, args, simulation, folder, checkpoint, &warnings) {
        Ok(driver) => driver.run(comm),
        Err(error) => {
            if let Some(aside) = aside.filter(|_| folder.check().is_ok()) {
                aside.undo();
            }
            give_up(comm, &error.to_string())
        }
    }
}

/// The reason why a run has no step left, if it has none.
#[must_use]
pub fn nothing_to_do(case: &Case, state: &RunState, until: Option<f64>) -> Option<String> {
    let (step, time) = (state.step, state.time);
    let (control, now) = (&case.run, seconds(time));
    if time >= control.end_time {
        let end = seconds(control.end_time);
        Some(format!(
            "{now} and the case ends at {end}; --set run.end_time=TIME moves the end"
        ))
    } else if control.max_steps.is_some_and(|most| step >= most) {
        Some(format!(
            "step {step}, the last of run.max_steps; --set run.max_steps=N allows more"
        ))
    } else if until.is_some_and(|until| time >= until) {
        Some(format!("{now}, not before the time of --until"))
    } else {
        None
    }
}
