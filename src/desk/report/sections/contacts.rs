//! The ledger of contact, by pair of bodies.

use crate::report::html::{Html, note, table_of_texts};
use crate::report::picture::chart;
use crate::report::run_files::{Rows, Run, with_unit};
use files::FileOpener;
use plot::{Columns, Tables};

/// Draws the forces, and lists the last state of each pair.
pub fn render(run: &Run) -> Result<Html, String> {
    let rows = Rows::read(&run.folder.contacts())?;
    let [a, b] = [rows.column("body_a")?, rows.column("body_b")?];
    let mut pairs: Vec<[&str; 2]> = Vec::new();
    for row in 0..rows.len() {
        let pair = [rows.text(row, a), rows.text(row, b)];
        if !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    let cells = pairs.iter().map(|pair| {
        let is_of = |row: &usize| [rows.text(*row, a), rows.text(*row, b)] == *pair;
        let own: Vec<usize> = (0..rows.len()).filter(is_of).collect();
        of_pair(&rows, *pair, &own)
    });
    let head = [
        "pair",
        "peak force",
        "impulse on the first",
        "heat",
        "stored at the end",
        "closest pair, spacings",
        "touching at the end",
    ];
    let table = table_of_texts(&head, cells.collect::<Vec<_>>());
    let drawn = Tables {
        title: run.title().to_owned(),
        tables: vec![(run.name.clone(), run.folder.contacts())],
        columns: Columns {
            x: "time".to_owned(),
            y: vec!["force".to_owned()],
        },
        ..Tables::default()
    };
    let drawn = drawn
        .chart(&FileOpener)
        .map_err(|error| run.without_path(&error));
    let drawn = chart(drawn, "Contact force of each pair of bodies over time");
    Ok(drawn.then(table).then(note(
        "Peak and closest pair are of all steps. Forces act on the first body of a pair; on the second \
         one their opposites.",
    )))
}

fn of_pair(rows: &Rows, [a, b]: [&str; 2], own: &[usize]) -> Vec<String> {
    let last = own[own.len() - 1];
    let extreme = |name: &str, better: fn(f64, f64) -> f64, worst: f64| {
        let Ok(column) = rows.column(name) else {
            return "–".to_owned();
        };
        let all = own.iter().map(|&row| rows.number(row, column));
        with_unit(
            all.fold(worst, better),
            rows.unit(column).trim_matches(|c| c == '-'),
        )
    };
    let closest = extreme("closest_pair", f64::min, f64::INFINITY);
    vec![
        format!("{a} – {b}"),
        extreme("peak_force", f64::max, f64::NEG_INFINITY),
        rows.vector(last, "impulse"),
        rows.cell(last, "heat"),
        rows.cell(last, "contact_energy"),
        closest.trim_end_matches(" spacings").to_owned(),
        rows.cell(last, "touching"),
    ]
}
