//! Energies against time from a run's `history.csv`.

use std::path::Path;

use super::curves::{Chart, Curve, Quantity};
use super::table::{Table, wrong};
use crate::plot::PlotError;
use crate::plot::canvas::Rgb;
use crate::plot::header::Mark;

/// Columns that are drawn, their names in the legend and their colours.
const CURVES: [(&str, &str, Rgb); 4] = [
    ("total_energy", "total", [40, 40, 40]),
    ("kinetic_energy", "kinetic", [0, 114, 178]),
    ("internal_energy", "internal", [213, 94, 0]),
    ("contact_energy", "contact", [0, 158, 115]),
];

/// The energies of a `history.csv` against time.
///
/// # Errors
/// [`PlotError::Table`] if the file or a column is missing or a number cannot be read.
pub fn energies(path: &Path, title: &str) -> Result<Chart, PlotError> {
    let table = Table::read(path)?;
    chart(&table, title).map_err(|reason| wrong(path, reason))
}

fn chart(table: &Table, title: &str) -> Result<Chart, String> {
    let time = table.column("time")?;
    let mut curves = Vec::new();
    for (column, name, colour) in CURVES {
        let energy = table.column(column)?;
        curves.push(Curve {
            name: name.to_owned(),
            colour,
            mark: Mark::Line,
            points: time.iter().zip(energy).map(|(&t, e)| [t, e]).collect(),
        });
    }
    let unit = match table.unit("total_energy")? {
        "" | "-" => "J",
        unit => unit,
    };
    let axis = |label: &str, unit: &str, room| Quantity {
        label: label.to_owned(),
        unit: unit.to_owned(),
        from_zero: true,
        room,
        ..Quantity::default()
    };
    Ok(Chart {
        title: title.to_owned(),
        subtitle: "energies".to_owned(),
        x: axis("time", "s", false),
        y: axis("energy", unit, true),
        curves,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_energy_is_a_curve() {
        let head = "# units: -,s,J,J,J,J\n\
            step,time,kinetic_energy,internal_energy,contact_energy,total_energy\n";
        let table = Table::parse(&format!("{head}0,0.0,3,1,0,4\n5,1e-8,2,1.5,0.5,4\n")).unwrap();
        let chart = chart(&table, "").unwrap();
        assert_eq!(chart.curves[1].points, [[0.0, 3.0], [1e-8, 2.0]]);
        assert_eq!(chart.curves[3].points[1], [1e-8, 0.5]);
        let short = Table::parse("time,kinetic_energy\n0,1\n").unwrap();
        let message = super::chart(&short, "").unwrap_err();
        assert!(message.contains("no column total_energy"), "{message}");
    }
}
