//! The influence of each number of a machine.

use super::{PlanArgs, Planned, as_number, most};
use files::plan::{CONSTANTS, Load, Machine, Weak, computing, refined, step_time};
use files::run::say::say;

/// The efficiency of the most ranks, each number of the machine twice as large in turn.
pub fn print(args: &PlanArgs, machine: &Machine, alone: &Load, all: &[Planned]) {
    let sharing = args.sharing(machine);
    let Some(planned) = most(all) else {
        return;
    };
    let each = f64::from(args.per_core) * as_number(sharing.threads);
    let (ranks, levels) = (planned.row.ranks, planned.row.levels);
    let fine = refined(&planned.loads, levels, each);
    let cores = as_number(ranks * sharing.threads);
    say(&format!(
        "\n  {ranks} ranks, {levels} levels: efficiency, and that of the model refined to {} particles a core",
        args.per_core
    ));
    let efficiencies = |machine: &Machine| {
        let time = step_time(&planned.loads, machine, sharing).all;
        let strong = computing(alone, machine) / (time * cores);
        let weak = Weak::of_refined(&fine, each, machine, sharing).efficiency;
        format!("{strong:.3}  {weak:.3}")
    };
    say(&format!("  {:<24}{}", "as told", efficiencies(machine)));
    for constant in &CONSTANTS {
        let text = efficiencies(&machine.doubled(constant));
        say(&format!("  {:<24}{text}", format!("2 x {}", constant.key)));
    }
}
