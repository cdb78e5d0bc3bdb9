//! What a step consists of.

use super::{PlanArgs, Planned, most, table::digits};
use files::run::say::say;

/// The terms of a step on the most ranks, of the model as it is and refined.
pub fn print(args: &PlanArgs, all: &[Planned]) {
    let Some(Planned { row, weak, .. }) = most(all) else {
        return;
    };
    let line = |what: &str, [strong, weak]: [&str; 2]| {
        say(&format!("  {what:<36}{strong:>10}{weak:>10}"));
    };
    say(&format!(
        "\n  {} ranks, {} levels: a step in ms, and one of the model refined to {} particles a core",
        row.ranks, row.levels, args.per_core
    ));
    let times = [row.time, weak.time];
    let [strong, fine] = times.map(|time| time.terms.named());
    for ((what, strong), (_, fine)) in strong.into_iter().zip(fine) {
        let [strong, fine] = [strong, fine].map(|time| digits(1e3 * time));
        line(what, [&strong, &fine]);
    }
    let [strong, fine] = times.map(|time| digits(1e3 * time.all));
    line("all", [&strong, &fine]);
    let [strong, fine] = [row.efficiency, weak.efficiency].map(|part| format!("{part:.3}"));
    line("efficiency", [&strong, &fine]);
}
