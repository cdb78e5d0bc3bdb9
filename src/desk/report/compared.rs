//! Two runs side by side: what of their cases differs, their figures, their curves in one chart.

use std::path::PathBuf;

use serde_json::Value;

use super::html::{Html, missing, note, or_reason, table, table_of_texts};
use super::page::{Section, snapshots, whole};
use super::picture::{chart, image};
use super::run_files::{Rows, Run, figure_in_words, with_unit, without_paths};
use super::sections::verdict;
use files::FileOpener;
use files::output::RunFolder;
use model::differences::{Difference, differences};
use model::readable::short;
use plot::{Columns, Pictures, Request, Sequence, Source, Tables};

/// The page of two runs, A and B.
#[must_use]
pub fn compare(a: &RunFolder, b: &RunFolder) -> String {
    let mut runs = [Run::read(a), Run::read(b)];
    if runs[0].name == runs[1].name {
        runs[0].name.push_str(" (A)");
        runs[1].name.push_str(" (B)");
    }
    let sections: Vec<Section> = vec![
        ("verdict", "Verdicts", Ok(verdicts(&runs))),
        ("case", "What differs in the cases", cases(&runs)),
        ("figures", "Figures of the runs", figures(&runs)),
        ("bodies", "Bodies at the end", bodies(&runs)),
        ("curves", "Curves", Ok(curves(&runs))),
        ("pictures", "Pictures", Ok(pictures(&runs))),
    ];
    let title = format!("{} against {}", runs[0].name, runs[1].name);
    let state = if runs[0].title() == runs[1].title() {
        runs[0].title().to_owned()
    } else {
        format!("{} (A) and {} (B)", runs[0].title(), runs[1].title())
    };
    whole(&title, &state, sections)
}

fn verdicts(runs: &[Run; 2]) -> Html {
    let one = |run: &Run| Html::of("h3", &run.name).then(verdict::render(run));
    runs.iter().map(one).collect()
}

/// Keys of the cases that differ.
fn cases(runs: &[Run; 2]) -> Result<Html, String> {
    let value = |run: &Run| {
        let case = run
            .case
            .as_ref()
            .map_err(|reason| format!("of {}: {reason}", run.name))?;
        serde_json::to_value(case).map_err(|error| error.to_string())
    };
    let differences = differences(&value(&runs[0])?, &value(&runs[1])?);
    if differences.is_empty() {
        return Ok(Html::of("p", "Nothing: their cases are the same."));
    }
    let word = |value: &Option<Value>| {
        value
            .as_ref()
            .map_or("not stated".to_owned(), figure_in_words)
    };
    let row = |differences: &Difference| {
        vec![
            differences.path.clone(),
            word(&differences.a),
            word(&differences.b),
        ]
    };
    Ok(table_of_texts(
        &["key", &runs[0].name, &runs[1].name],
        differences.iter().map(row),
    ))
}

/// Numbers of a tree by dotted names.
fn numbers(name: &str, value: &Value, numbers_of: &mut Vec<(String, f64)>) {
    match value {
        Value::Object(parts) => {
            for (part, value) in parts {
                let below = if name.is_empty() {
                    part.clone()
                } else {
                    format!("{name}.{part}")
                };
                numbers(&below, value, numbers_of);
            }
        }
        Value::Number(number) => {
            numbers_of.extend(number.as_f64().map(|number| (name.to_owned(), number)));
        }
        _ => {}
    }
}

/// Figures of the summaries that are numbers, with what B has more than A.
fn figures(runs: &[Run; 2]) -> Result<Html, String> {
    let mut all: [Vec<(String, f64)>; 2] = Default::default();
    for (run, numbers_of) in runs.iter().zip(&mut all) {
        let summary = run
            .summary
            .as_ref()
            .map_err(|reason| format!("of {}: {reason}", run.name))?;
        numbers("", &Value::Object(summary.clone()), numbers_of);
    }
    let [a, b] = &all;
    let rows = a.iter().filter_map(|(name, one)| {
        let (_, other) = b.iter().find(|(other, _)| other == name)?;
        Some(vec![
            Html::text(&name.replace('_', " ")),
            Html::text(&short(*one)),
            Html::text(&short(*other)),
            relative(*one, *other),
        ])
    });
    let head = [
        "figure of summary.json",
        &runs[0].name,
        &runs[1].name,
        "B against A",
    ];
    Ok(table(&head, rows).then(note(
        "In SI units; times and rates are those of the machine that the run was made on.",
    )))
}

/// The excess of B over A.
fn relative(a: f64, b: f64) -> Html {
    let text = if a.to_bits() == b.to_bits() {
        "same".to_owned()
    } else if a == 0.0 {
        "–".to_owned()
    } else {
        let percent = 100.0 * (b - a) / a.abs();
        let sign = if percent > 0.0 { "+" } else { "−" };
        format!("{sign}{} %", short(percent.abs()))
    };
    Html::element("span", &[("class", "figure")], Html::text(&text))
}

/// The table of the bodies that both have.
fn bodies(runs: &[Run; 2]) -> Result<Html, String> {
    let read = |run: &Run| {
        Rows::read(&run.folder.bodies()).map_err(|reason| format!("of {}: {reason}", run.name))
    };
    let [a, b] = [read(&runs[0])?, read(&runs[1])?];
    let last = |rows: &Rows| -> Result<Vec<(String, usize)>, String> {
        let [time, body] = [rows.column("time")?, rows.column("body")?];
        let named = |row: usize| (rows.text(row, body).to_owned(), row);
        Ok(rows.like_last(time).map(named).collect())
    };
    let (of_a, of_b) = (last(&a)?, last(&b)?);
    let named = [
        "mass",
        "velocity_x",
        "velocity_y",
        "velocity_z",
        "kinetic_energy",
        "internal_energy",
        "failed_mass",
    ];
    let mut rows = Vec::new();
    for (name, one) in &of_a {
        let Some((_, other)) = of_b.iter().find(|(other, _)| other == name) else {
            continue;
        };
        for column in named {
            let (Ok(here), Ok(there)) = (a.column(column), b.column(column)) else {
                continue;
            };
            let [x, y] = [a.number(*one, here), b.number(*other, there)];
            rows.push(vec![
                Html::text(name),
                Html::text(&column.replace('_', " ")),
                Html::text(&with_unit(x, a.unit(here))),
                Html::text(&with_unit(y, b.unit(there))),
                relative(x, y),
            ]);
        }
    }
    let times = [&a, &b].map(|rows| rows.cell(rows.len() - 1, "time"));
    let head = [
        "body",
        "figure",
        &runs[0].name,
        &runs[1].name,
        "B against A",
    ];
    Ok(table(&head, rows).then(note(&format!("A at {}, B at {}.", times[0], times[1]))))
}

/// Curves of both.
fn curves(runs: &[Run; 2]) -> Html {
    let title = format!("{} and {}", runs[0].name, runs[1].name);
    let drawn = |file: &str, columns: &str, alt: &str| {
        let tables = runs
            .iter()
            .filter(|run| run.folder.path().join(file).exists());
        let tables: Vec<_> = tables
            .map(|run| (run.name.clone(), run.folder.path().join(file)))
            .collect();
        if tables.is_empty() {
            return Html::default();
        }
        let drawn = Columns::parse(columns).and_then(|columns| {
            let tables = Tables {
                title: title.clone(),
                tables,
                columns,
                ..Tables::default()
            };
            tables.chart(&FileOpener)
        });
        chart(
            drawn.map_err(|error| without_paths(&[&runs[0], &runs[1]], &error)),
            alt,
        )
    };
    [
        (
            "history.csv",
            "time:kinetic_energy",
            "Kinetic energy of both runs over time",
        ),
        (
            "history.csv",
            "time:internal_energy",
            "Internal energy of both runs over time",
        ),
        ("history.csv", "time:dt", "Time step of both runs over time"),
        (
            "contacts.csv",
            "time:force",
            "Contact forces of both runs over time",
        ),
    ]
    .into_iter()
    .map(|(file, columns, alt)| drawn(file, columns, alt))
    .collect()
}

/// The last section of each, side by side, and what is said of snapshots that cannot be read.
fn pictures(runs: &[Run; 2]) -> Html {
    let mut sources = Vec::new();
    let mut warnings = Html::default();
    for run in runs {
        let (available, damaged) = snapshots(run);
        let warning = |reason: String| missing(&format!("{}: {reason}", run.name));
        warnings.push(damaged.into_iter().map(warning).collect());
        sources.push(last(run, &available));
    }
    let sources: Result<Vec<Source>, String> = sources.into_iter().collect();
    let request = Request {
        mirror: true,
        ..Request::default()
    };
    let drawn = sources.map(|sources| {
        let drawn = Pictures::new(&FileOpener, &sources, &request)
            .and_then(|pictures| pictures.panels(None));
        let drawn = drawn.map_err(|error| without_paths(&[&runs[0], &runs[1]], &error));
        image(drawn, "The last section of both runs, side by side")
    });
    or_reason(drawn).then(warnings)
}

/// The last of a run's snapshots (time in s, path).
fn last(run: &Run, available: &[(f64, PathBuf)]) -> Result<Source, String> {
    let Some((_, path)) = available.last() else {
        return Err(format!("{} has no snapshots that can be read", run.name));
    };
    Ok(Source {
        name: run.name.clone(),
        snapshots: vec![path.clone()],
    })
}
