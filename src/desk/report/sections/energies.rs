//! Energies over time.

use crate::report::found::{Rows, Run};
use crate::report::html::{Html, table_of_texts};
use crate::report::picture::chart;
use plot::History;

/// Columns of the history that are told at the start and at the end.
const TOLD: [&str; 6] = [
    "kinetic_energy",
    "internal_energy",
    "contact_energy",
    "gravity_energy",
    "load_work",
    "total_energy",
];

/// Draws and tells the energies.
pub fn tell(run: &Run) -> Result<Html, String> {
    let rows = Rows::read(&run.folder.history())?;
    let table = (String::new(), run.folder.history());
    let drawn = History::Energies.chart(&[table], run.title());
    let drawn = chart(
        drawn.map_err(|error| run.without_path(&error)),
        "Kinetic, internal, contact and total energy over time",
    );
    let known = TOLD.iter().filter(|name| rows.column(name).is_ok());
    let row = |name: &&str| {
        let ends = [0, rows.len() - 1].map(|row| rows.shown(row, name));
        let [first, last] = ends;
        vec![name.replace('_', " "), first, last]
    };
    let table = table_of_texts(&["energy", "at the start", "at the end"], known.map(row));
    Ok(drawn.then(table))
}
