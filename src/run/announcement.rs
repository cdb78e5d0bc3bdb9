//! What is said as a run begins.

use std::path::Path;

use super::say::{counted, seconds};
use crate::comm::Comm;
use crate::numerics::dispatch::instructions;
use crate::output::{COMMIT, VERSION};
use crate::step::Simulation;

/// Three lines: the program; what is run, by how many, and from which checkpoint if it is
/// `restarted`; and the seconds of the `set_up`. Collective.
pub fn announcement(
    comm: &Comm,
    simulation: &Simulation,
    restarted: Option<&Path>,
    set_up: f64,
) -> [String; 3] {
    let mut counts = [simulation.particles.owned() as u64];
    comm.sum_u64(&mut counts);
    let from = restarted.map_or(String::new(), |path| {
        let time = seconds(simulation.state.time);
        format!(", from {} at {time}", path.display())
    });
    [
        format!("whipple {VERSION} ({COMMIT})"),
        format!(
            "{}: {} particles, {} with {} each ({}){from}",
            simulation.case.title,
            counts[0],
            counted(comm.size() as u64, "rank"),
            counted(rayon::current_num_threads() as u64, "thread"),
            instructions().name(),
        ),
        format!("set up in {set_up:.3} s"),
    ]
}
