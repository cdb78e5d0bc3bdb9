//! A run from its start.

use super::driver::Driver;
use super::launch::{Launch, fail, give_up};
use super::options::CommonArgs;
use crate::output::RunFolder;
use crate::preflight::{approaches, warnings};
use engine::step::Simulation;
use model::Case;

/// Sets the case up, only then clears the folder of an earlier run, and steps to the end;
/// returns the exit code. Prints warnings about the case and `more`. Collective.
#[must_use]
pub fn start(
    launch: &Launch,
    args: &CommonArgs,
    case: Case,
    mut folder: RunFolder,
    force: bool,
    more: Vec<String>,
) -> u8 {
    launch.start_threads(args.threads);
    let comm = launch.comm;
    let mut warnings = warnings(&case, &approaches(&case));
    warnings.extend(more);
    let resolved = case.resolved.clone();
    let simulation = match Simulation::start(case, comm) {
        Ok(simulation) => simulation,
        Err(error) => return give_up(comm, &error.to_string()),
    };
    match folder.create(comm, &resolved, force) {
        Ok(kept) => warnings.extend(kept),
        Err(error) => return give_up(comm, &error.to_string()),
    }
    match Driver::begin(launch, args, simulation, &folder, None, &warnings) {
        Ok(driver) => driver.run(comm),
        Err(error) => fail(comm, &folder, &error.to_string(), 0, 0.0),
    }
}
