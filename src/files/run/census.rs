//! Output of a run's fragments.

use super::tables::Tables;
use crate::output::fragments::{self, FragmentTable};
use crate::output::{OutputError, RunFolder, Schedule};
use comm::Comm;
use engine::step::Simulation;
use engine::step::fragments::find_in;
use model::FragmentOptions;

/// Returns true if fragments are due after a step between two times (s), after which a snapshot may be
/// due, too.
pub fn is_due(options: &FragmentOptions, [before, now]: [f64; 2], snapshot_due: bool) -> bool {
    (options.every).map_or(snapshot_due, |every| {
        Schedule::new(Some(every)).is_due(before, now)
    })
}

/// Finds the fragments and returns the label of each particle of this rank; writes their tables where
/// these are given. Collective.
///
/// # Errors
/// The same on all ranks.
pub fn take(
    comm: &Comm,
    simulation: &mut Simulation,
    tables: Option<(&RunFolder, Option<&mut Tables>)>,
) -> Result<Vec<u64>, OutputError> {
    let options = simulation.case.fragments.unwrap_or_default();
    let census = find_in(simulation, comm, &options);
    if let Some((folder, tables)) = tables {
        let (case, state) = (&simulation.case, &simulation.state);
        folder.on_root(comm, || {
            let bodies: Vec<&str> = case.bodies.iter().map(|b| b.name.as_str()).collect();
            let table = FragmentTable::new(&census, &bodies, case.extent());
            folder.write_fragments(state.step, &table)?;
            let row = fragments::row(state.step, state.time, &census);
            tables.map_or(Ok(()), |tables| tables.write_fragments(&row))
        })?;
    }
    Ok(census.labels)
}
