//! The balance of the ranks, and the time of each phase.

use crate::report::html::{Html, bar, missing, note, or_reason, table};
use crate::report::picture::chart;
use crate::report::run_files::{Rows, Run};
use files::FileOpener;
use plot::{Columns, History, Tables};

/// Tells load and time.
pub fn render(run: &Run) -> Html {
    or_reason(balance(run)).then(phases(run))
}

/// The load of the busiest rank.
fn balance(run: &Run) -> Result<Html, String> {
    let rows = Rows::read(&run.folder.performance())?;
    let mut page = Html::default();
    if run.number("ranks").is_some_and(|ranks| ranks > 1.0) {
        let drawn = Tables {
            title: run.title().to_owned(),
            tables: vec![(run.name.clone(), run.folder.performance())],
            columns: Columns {
                x: "step".to_owned(),
                y: vec!["work_imbalance".to_owned(), "particle_imbalance".to_owned()],
            },
            label: Some("busiest rank over the mean".to_owned()),
            ..Tables::default()
        };
        let drawn = drawn
            .chart(&FileOpener)
            .map_err(|error| run.without_path(&error));
        page.push(chart(
            drawn,
            "Load of the busiest rank over the mean of all, by step",
        ));
        let ranks = [(String::new(), run.folder.ranks())];
        let drawn = History::Ranks.chart(&ranks, run.title());
        page.push(chart(
            drawn.map_err(|error| run.without_path(&error)),
            "Work of each rank over the mean of all, by step",
        ));
        let last = rows.len() - 1;
        let [work, particles] =
            ["work_imbalance", "particle_imbalance"].map(|name| rows.cell(last, name));
        page.push(note(&format!(
            "At the end the busiest rank has {work} times the mean work and {particles} times the mean \
             number of particles; 1 is even. Ranks without particles: {}. Messages: {}, of {} MB.",
            rows.cell(last, "empty_ranks"),
            rows.cell(last, "messages"),
            rows.cell(last, "megabytes_sent").trim_end_matches(" MB"),
        )));
    } else {
        page.push(note("One rank: nothing to share out."));
    }
    Ok(page)
}

/// Seconds of the steps by phase.
fn phases(run: &Run) -> Html {
    let Some(phases) = run.figure("seconds_by_phase").and_then(|p| p.as_object()) else {
        return missing("Where the time went is not told: the summary has no seconds_by_phase.");
    };
    let phases = phases
        .iter()
        .map(|(name, seconds)| (name, seconds.as_f64().unwrap_or(0.0)));
    let phases: Vec<_> = phases.collect();
    let all: f64 = phases.iter().map(|(_, seconds)| seconds).sum();
    let row = |(name, seconds): &(&String, f64)| {
        let share = seconds / all.max(f64::MIN_POSITIVE);
        vec![
            Html::text(&name.replace('_', " ")),
            Html::text(&format!("{seconds:.2}")),
            Html::text(&format!("{:.1} %", 100.0 * share)),
            bar(share),
        ]
    };
    Html::of("h3", "Where the time went").then(table(
        &["phase of a step", "seconds, mean of ranks", "share", ""],
        phases.iter().map(row),
    ))
}
