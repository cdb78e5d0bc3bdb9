//! Messages at the beginning of a run.

use std::path::Path;

use super::say::{counted, note, say, seconds, warn};
use crate::output::{Log, VERSION, commit};
use crate::preflight::shortened;
use comm::Comm;
use engine::step::Simulation;

/// Reports the start of a run: particles, ranks, the checkpoint `restarted` if any, the time of `set_up` (s),
/// and `warnings` about the case. Collective.
pub fn say_all(
    comm: &Comm,
    simulation: &Simulation,
    log: &mut Log,
    restarted: Option<&Path>,
    set_up: f64,
    warnings: &[String],
) {
    let mut counts = [simulation.particles.owned() as u64];
    comm.sum_u64(&mut counts);
    if !comm.is_root() {
        return;
    }
    let state = &simulation.state;
    let from = restarted.map_or(String::new(), |path| {
        let time = seconds(state.time);
        format!(", from {} at {time}", path.display())
    });
    let text = format!(
        "{}: {} particles, {} with {} each ({}){from}",
        simulation.case.title,
        counts[0],
        counted(comm.size() as u64, "rank"),
        counted(rayon::current_num_threads() as u64, "thread"),
        numerics::dispatch::instructions().name(),
    );
    let [by, ready] = [
        format!("whipple {VERSION} ({})", commit()),
        format!("set up in {set_up:.3} s"),
    ];
    for line in [&by, &text, &ready] {
        log.line(line);
    }
    note(&by);
    say(&text);
    note(&ready);
    if comm.size() > 1 {
        let text = format!("decomposition: {}", decomposition(comm, simulation));
        log.line(&text);
        say(&text);
    }
    for warning in shortened(warnings) {
        let text = format!("warning: {warning}");
        log.line(&text);
        warn(&text);
    }
}

/// The decomposition of space among ranks, in words.
pub fn decomposition(comm: &Comm, simulation: &Simulation) -> String {
    let axes: Vec<&str> = (simulation.axes_of_slabs().iter())
        .map(|axis| axis.name())
        .collect();
    let levels = match axes.len() {
        1 => String::new(),
        levels => format!("{levels} levels of "),
    };
    let ranks = counted(comm.size() as u64, "rank");
    format!("{ranks} in {levels}slabs along {}", axes.join(", "))
}
