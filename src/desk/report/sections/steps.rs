//! The steps, and the reasons for their sizes.

use std::collections::BTreeMap;

use crate::report::html::{Html, note, swatch, table};
use crate::report::picture::chart;
use crate::report::run_files::{Rows, Run, with_unit};
use files::FileOpener;
use plot::{Columns, Tables, colour_of, hex};

/// Draws the steps over time, with what chose them.
pub fn render(run: &Run) -> Result<Html, String> {
    let rows = Rows::read(&run.folder.history())?;
    let [time, dt, reason] = [
        rows.column("time")?,
        rows.column("dt")?,
        rows.column("dt_reason")?,
    ];
    let drawn = Tables {
        title: run.title().to_owned(),
        tables: vec![(run.name.clone(), run.folder.history())],
        columns: Columns {
            x: "time".to_owned(),
            y: vec!["dt".to_owned()],
        },
        label: Some("time step".to_owned()),
        ..Tables::default()
    };
    let drawn = drawn
        .chart(&FileOpener)
        .map_err(|error| run.without_path(&error));
    // The first row is of the state before any step.
    let taken: Vec<(f64, f64, &str)> = (1..rows.len())
        .map(|row| {
            (
                rows.number(row, time),
                rows.number(row, dt),
                rows.text(row, reason),
            )
        })
        .collect();
    let mut page = chart(drawn, "Length of the time step over time");
    if taken.is_empty() {
        return Ok(page.then(note("No step has been taken yet.")));
    }
    let reasons: Vec<&str> = {
        let mut seen: Vec<&str> = taken.iter().map(|step| step.2).collect();
        seen.sort_unstable();
        seen.dedup();
        seen
    };
    page.push(strip(&taken, &reasons));
    page.push(table(
        &[
            "chosen by",
            "rows of history.csv",
            "shortest",
            "longest",
            "meaning",
        ],
        reasons
            .iter()
            .enumerate()
            .map(|(k, reason)| row(k, reason, &taken)),
    ));
    page.push(note(&format!(
        "{} steps in all; history.csv has a row for some of them. Steps that contact made shorter: {}.",
        run.status.as_ref().map_or(0, |status| status.step),
        run.number("contact_limited_steps").map_or("–".to_owned(), |steps| steps.to_string()),
    )));
    Ok(page)
}

/// The meaning of a reason, see the book's page on time integration.
fn meaning(reason: &str) -> &'static str {
    let known = BTreeMap::from([
        ("sound", "sound crosses a smoothing length (“courant”)"),
        (
            "force",
            "acceleration moves matter by part of a smoothing length (“force”)",
        ),
        (
            "contact",
            "the stiffness of contact, or the approach of two bodies (“contact”)",
        ),
        ("maximum", "the case's “max”"),
        ("flight", "bodies must not fly through each other unseen"),
        ("end", "a file is due at this time, or the end"),
    ]);
    known.get(reason).copied().unwrap_or("")
}

fn row(k: usize, reason: &str, taken: &[(f64, f64, &str)]) -> Vec<Html> {
    let lengths: Vec<f64> = (taken.iter().filter(|step| step.2 == reason))
        .map(|step| step.1)
        .collect();
    let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    vec![
        swatch(colour_of(k)).then(Html::of("span", reason)),
        Html::text(&lengths.len().to_string()),
        Html::text(&with_unit(shortest, "s")),
        Html::text(&with_unit(longest, "s")),
        Html::text(meaning(reason)),
    ]
}

/// A strip along time, coloured by what chose the steps.
fn strip(taken: &[(f64, f64, &str)], reasons: &[&str]) -> Html {
    let end = taken
        .last()
        .map_or(0.0, |step| step.0)
        .max(f64::MIN_POSITIVE);
    let mut bars = Html::default();
    let mut from = 0.0;
    for same in taken.chunk_by(|a, b| a.2 == b.2) {
        let to = 1000.0 * same[same.len() - 1].0 / end;
        let k = reasons
            .iter()
            .position(|reason| *reason == same[0].2)
            .unwrap_or(0);
        let fill = hex(colour_of(k));
        let [x, width] = [from, to - from].map(|value| format!("{value:.2}"));
        let attributes = [
            ("x", x.as_str()),
            ("width", width.as_str()),
            ("height", "24"),
            ("fill", fill.as_str()),
        ];
        bars.push(Html::element("rect", &attributes, Html::default()));
        from = to;
    }
    let attributes = [
        ("class", "strip"),
        ("viewBox", "0 0 1000 24"),
        ("preserveAspectRatio", "none"),
        ("role", "img"),
        (
            "aria-label",
            "What chose the time step, along time; the table below says it in words",
        ),
    ];
    let ends = format!("What chose the step, from 0 to {}:", with_unit(end, "s"));
    note(&ends).then(Html::element("svg", &attributes, bars))
}
