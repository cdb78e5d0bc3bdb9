//! The fragments at the end.

use crate::report::html::{Html, note, or_reason, table_of_texts};
use crate::report::picture::chart;
use crate::report::run_files::{Rows, Run};
use plot::{By, cumulative};

/// Fragments that are listed.
const LISTED: usize = 12;

/// Renders the fragments of the run's own tables, else the output of `whipple fragments` for its
/// last snapshot, or its error.
pub fn render(run: &Run, of_snapshot: &Result<String, String>) -> Result<Html, String> {
    if !run.folder.fragments().exists() {
        let text = of_snapshot
            .as_ref()
            .map_err(|reason| run.without_path(reason))?;
        let lines = text
            .lines()
            .map(|line| Html::text(line).then(Html::own("\n")));
        let block = Html::element("pre", &[], lines.collect());
        let block = Html::element("div", &[("class", "wide")], block);
        return Ok(block.then(note(
            "By the rule of whipple fragments on the last snapshot, since the case has no [fragments].",
        )));
    }
    let rows = Rows::read(&run.folder.fragments())?;
    let named = [
        "fragments",
        "largest_mass",
        "largest_diameter",
        "fragment_mass",
        "dust_mass",
        "failed_mass",
        "total_mass",
    ];
    let times = spread(rows.len()).into_iter();
    let row = |row: usize| {
        let mut cells = vec![rows.cell(row, "time")];
        cells.extend(named.map(|name| rows.cell(row, name)));
        cells
    };
    let mut head = vec!["time"];
    let words = named.map(|name| name.replace('_', " "));
    head.extend(words.iter().map(String::as_str));
    let mut page = table_of_texts(&head, times.map(row));
    page.push(or_reason(heaviest(run)));
    Ok(page)
}

/// At most a handful of rows, the first and the last among them.
fn spread(rows: usize) -> Vec<usize> {
    let last = rows - 1;
    let mut chosen: Vec<usize> = (0..=4).map(|k| k * last / 4).collect();
    chosen.dedup();
    chosen
}

/// The heaviest fragments at the last time, and how many are as heavy as any.
fn heaviest(run: &Run) -> Result<Html, String> {
    let files = run
        .folder
        .fragment_files()
        .map_err(|error| run.without_path(&error))?;
    let is_text = |path: &std::path::Path| path.extension().is_some_and(|ending| ending == "csv");
    let Some((_, path)) = files.into_iter().rev().find(|(_, path)| is_text(path)) else {
        return Ok(note("The run has no tables of single fragments."));
    };
    let rows = Rows::read(&path)?;
    let named = ["copies", "particles", "mass", "diameter", "temperature"];
    let row = |row: usize| {
        let mut cells = named.map(|name| rows.cell(row, name)).to_vec();
        cells.insert(4, rows.vector(row, "velocity"));
        cells
    };
    let head = [
        "copies",
        "particles",
        "mass",
        "diameter",
        "velocity",
        "temperature",
    ];
    let listed = (0..rows.len()).take(LISTED).map(row);
    let drawn = cumulative(&[(run.name.clone(), path)], By::ALL[0], run.title());
    let drawn = drawn.map_err(|error| run.without_path(&error));
    Ok(Html::of("h3", "The heaviest")
        .then(table_of_texts(&head, listed))
        .then(chart(drawn, "How many fragments are as heavy as any")))
}
