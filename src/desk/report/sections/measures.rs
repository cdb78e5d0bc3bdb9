//! What the run has measured of itself: bodies, and what the case's measures tell.

use std::path::Path;

use crate::report::found::{Rows, Run, told};
use crate::report::html::{Html, missing, note, or_untold, table_of_texts};
use crate::report::picture::chart;
use plot::{Wanted, distributions};

/// Tells the measures at their last time.
pub fn tell(run: &Run) -> Html {
    let mut page = Html::of("h3", "Bodies at the end");
    page.push(or_untold(bodies(run)));
    page.push(Html::of("h3", "Measures of the case"));
    if !run.folder.measures().exists() {
        page.push(missing(
            "The run has no measures.csv: its case names no measures (see whipple measure).",
        ));
        return page;
    }
    page.push(or_untold(figures(&run.folder.measures())));
    let tables = [(run.name.clone(), run.folder.distributions())];
    if run.folder.distributions().exists() {
        let told = |time| told(time, "s");
        match distributions(&tables, &Wanted::Last, run.title(), told) {
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

/// What there is of each body at the last time.
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
        cells.extend(single.map(|name| rows.shown(row, name)));
        cells.insert(3, rows.shown_vector(row, "velocity"));
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
    let at = rows.shown(rows.len() - 1, "time");
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
    let mut places = [0; 7];
    for (place, name) in places.iter_mut().zip(names) {
        *place = rows.column(name)?;
    }
    let [time, measure, kind, figure, value, uncertainty, unit] = places;
    let shown = |row: usize, column: usize| {
        let unit = rows.text(row, unit);
        match rows.text(row, column).parse::<f64>() {
            Ok(number) => told(number, unit),
            Err(_) => rows.text(row, column).replace('_', " "),
        }
    };
    let row = |row: usize| {
        vec![
            rows.text(row, measure).to_owned(),
            rows.text(row, kind).replace('_', " "),
            rows.text(row, figure).replace('_', " "),
            shown(row, value),
            shown(row, uncertainty),
        ]
    };
    let head = ["measure", "of", "figure", "value", "uncertainty ±"];
    let at = rows.shown(rows.len() - 1, "time");
    let table = table_of_texts(&head, rows.like_last(time).map(row));
    Ok(table.then(note(&format!("At {at}; – where there is nothing to tell."))))
}
