//! The measurements of the run: bodies, and the case's measures.

use std::path::Path;

use crate::report::html::{Html, missing, note, or_reason, table_of_texts};
use crate::report::picture::chart;
use crate::report::run_files::{Rows, Run, with_unit};
use plot::{Wanted, distributions};

/// Tells the measures at their last time.
pub fn render(run: &Run) -> Html {
    let mut page = Html::of("h3", "Bodies at the end");
    page.push(or_reason(bodies(run)));
    page.push(Html::of("h3", "Measures of the case"));
    if !run.folder.measures().exists() {
        page.push(missing(
            "The run has no measures.csv: its case names no measures (see whipple measure).",
        ));
        return page;
    }
    page.push(or_reason(figures(&run.folder.measures())));
    let tables = [(run.name.clone(), run.folder.distributions())];
    if run.folder.distributions().exists() {
        let with_unit = |time| with_unit(time, "s");
        match distributions(&tables, &Wanted::Last, run.title(), with_unit) {
            Ok(charts) => {
                let drawn = charts.into_iter();
                let draw = |(name, drawn): (String, _)| chart(Ok(drawn), &name.replace('_', " "));
                page.push(drawn.map(draw).collect());
            }
            Err(error) => page.push(missing(&run.without_path(&error))),
        }
    }
    page
}

/// The table of bodies at the last time.
fn bodies(run: &Run) -> Result<Html, String> {
    let rows = Rows::read(&run.folder.bodies())?;
    let [time, body] = [rows.column("time")?, rows.column("body")?];
    let single = [
        "particles",
        "mass",
        "kinetic_energy",
        "internal_energy",
        "failed_mass",
    ];
    let row = |row: usize| {
        let mut cells = vec![rows.text(row, body).to_owned()];
        cells.extend(single.map(|name| rows.cell(row, name)));
        cells.insert(3, rows.vector(row, "velocity"));
        cells
    };
    let head = [
        "body",
        "particles",
        "mass",
        "velocity",
        "kinetic energy",
        "internal energy",
        "failed mass",
    ];
    let at = rows.cell(rows.len() - 1, "time");
    let table = table_of_texts(&head, rows.like_last(time).map(row));
    Ok(table.then(note(&format!(
        "At {at}, of the whole model with its mirror images."
    ))))
}

/// The figures of all measures at the last time.
fn figures(path: &Path) -> Result<Html, String> {
    let rows = Rows::read(path)?;
    let names = [
        "time",
        "measure",
        "kind",
        "figure",
        "value",
        "uncertainty",
        "unit",
    ];
    let mut columns = [0; 7];
    for (column, name) in columns.iter_mut().zip(names) {
        *column = rows.column(name)?;
    }
    let [time, measure, kind, figure, value, uncertainty, unit] = columns;
    let text = |row: usize, column: usize| {
        let unit = rows.text(row, unit);
        match rows.text(row, column).parse::<f64>() {
            Ok(number) => with_unit(number, unit),
            Err(_) => rows.text(row, column).replace('_', " "),
        }
    };
    let row = |row: usize| {
        vec![
            rows.text(row, measure).to_owned(),
            rows.text(row, kind).replace('_', " "),
            rows.text(row, figure).replace('_', " "),
            text(row, value),
            text(row, uncertainty),
        ]
    };
    let head = ["measure", "of", "figure", "value", "uncertainty ±"];
    let at = rows.cell(rows.len() - 1, "time");
    let table = table_of_texts(&head, rows.like_last(time).map(row));
    Ok(table.then(note(&format!("At {at}; – where there is nothing to tell."))))
}
