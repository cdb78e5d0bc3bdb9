//! LAMMPS dumps, which OVITO, ASE and LAMMPS read: a text, with a frame for each snapshot.
//!
//! Layout: the page "dump command" of the LAMMPS manual, with its items UNITS and TIME.

use std::fmt::Write as _;

use super::ExportError;
use super::column::Column;
use super::frame::Frame;
use super::text::{Printed, Style, write_lines};
use files::output::NewFile;

const STYLE: Style = Style {
    separator: b' ',
    nan: "nan",
};

/// Adds a frame; types are the numbers of bodies from one on.
pub fn write(frame: &Frame, out: &mut NewFile) -> Result<(), ExportError> {
    let types: Vec<String> = (1..=frame.snapshot.bodies.len())
        .map(|n| n.to_string())
        .collect();
    let radius = Column::radius();
    let mut columns = Vec::new();
    let named = |name: &str| frame.column(name).map(Printed::numbers);
    columns.extend(named("id"));
    columns.extend(named("body").map(|body| Printed {
        words: Some(&types),
        ..body
    }));
    columns.push(Printed::numbers(&frame.position));
    columns.extend(named("velocity"));
    columns.push(Printed::numbers(&radius));
    let rest = frame.columns.iter();
    let standard = ["id", "body", "velocity", "radius"];
    let rest = rest.filter(|column| !standard.contains(&column.name.as_str()));
    columns.extend(rest.map(Printed::numbers));
    out.put(head(frame, &columns)?.as_bytes())?;
    write_lines(frame, &columns, STYLE, out)
}

fn head(frame: &Frame, columns: &[Printed]) -> Result<String, ExportError> {
    let mut head = String::new();
    let (time, step) = (frame.snapshot.time, frame.step.unwrap_or(0));
    let _ = writeln!(head, "ITEM: UNITS\nsi\nITEM: TIME\n{time:?}");
    let _ = writeln!(head, "ITEM: TIMESTEP\n{step}");
    let _ = writeln!(head, "ITEM: NUMBER OF ATOMS\n{}", frame.rows());
    let _ = writeln!(head, "ITEM: BOX BOUNDS ff ff ff");
    // Half a particle around them, so that a flat model has a box, too.
    let margin = 0.5 * frame.snapshot.coarsest();
    for [low, high] in frame.bounds()? {
        let _ = writeln!(head, "{:?} {:?}", low - margin, high + margin);
    }
    head.push_str("ITEM: ATOMS");
    for printed in columns {
        for name in names(printed.column) {
            let _ = write!(head, " {name}");
        }
    }
    head.push('\n');
    Ok(head)
}

/// The names that LAMMPS has for the columns that it knows.
fn names(column: &Column) -> Vec<String> {
    let known: &[&str] = match column.name.as_str() {
        "body" => &["type"],
        "velocity" if column.components.len() == 3 => &["vx", "vy", "vz"],
        _ => return column.names(),
    };
    known.iter().map(|name| (*name).to_owned()).collect()
}
