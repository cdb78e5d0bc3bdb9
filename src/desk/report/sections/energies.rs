//! Energies over time.

use crate::report::html::{Html, table_of_texts};
use crate::report::picture::chart;
use crate::report::run_files::{Rows, Run};
use plot::History;

/// Columns of the history that are listed at the start and at the end.
const COLUMNS: [&str; 7] = [
    "kinetic_energy",
    "internal_energy",
    "contact_energy",
    "gravity_energy",
    "self_gravity_energy",
    "load_work",
    "total_energy",
];

/// Draws and lists the energies.
pub fn render(run: &Run) -> Result<Html, String> {
    let rows = Rows::read(&run.folder.history())?;
    let table = (String::new(), run.folder.history());
    let drawn = History::Energies.chart(&[table], run.title());
    let drawn = chart(
        drawn.map_err(|error| run.without_path(&error)),
        "Kinetic, internal, contact and total energy over time",
    );
    let known = COLUMNS.iter().filter(|name| rows.column(name).is_ok());
    let row = |name: &&str| {
        let ends = [0, rows.len() - 1].map(|row| rows.cell(row, name));
        let [first, last] = ends;
        vec![name.replace('_', " "), first, last]
    };
    let table = table_of_texts(&["energy", "at the start", "at the end"], known.map(row));
    Ok(drawn.then(table))
}
