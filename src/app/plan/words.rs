//! Lines above the table.

use super::source::Source;
use files::plan::{Machine, Sharing};
use files::run::say::counted;
use model::readable::{short, shown};

/// A share of the work that counts as all of it.
const ALL: f64 = 0.995;

/// The subject of the plan.
pub fn heading(source: &Source) -> String {
    let case = &source.case;
    let from = source
        .time
        .map_or(String::new(), |time| format!(" at {}", shown(time, "s")));
    let to = source.outlook.steps.map_or(String::new(), |steps| {
        let end = shown(case.run.end_time, "s");
        format!(", about {} steps to {end}", short(steps))
    });
    let count = source.particles.positions.len();
    format!(
        "{} ({}-D): {count} particles{from}{to}",
        case.title, case.dimension
    )
}

/// The machine.
pub fn machine(machine: &Machine) -> String {
    let time = shown(machine.particle_time, "s");
    let cores = machine.ranks_per_node(1);
    format!(
        "  on {}: {time} a particle and step, nodes of {cores} cores",
        machine.name
    )
}

/// How ranks share nodes.
pub fn sharing(sharing: Sharing) -> String {
    let (ranks, threads) = (sharing.ranks_per_node as u64, sharing.threads as u64);
    format!(
        "  {} of {} on a node",
        counted(ranks, "rank"),
        counted(threads, "thread")
    )
}

/// The share of the work that steps take, if it is not all.
pub fn rest(share: f64) -> Option<String> {
    let percent = 100.0 * share;
    (share < ALL).then(|| {
        format!(
            "  matter rests until a wave comes: steps take {percent:.0} % of the work of all of it"
        )
    })
}

/// The work that steps take over that of equal particles, if it is more.
pub fn unequal(times: f64) -> Option<String> {
    (times > 1.0).then(|| {
        format!("  sizes of particles differ: they take {times} times the work of equal ones")
    })
}
