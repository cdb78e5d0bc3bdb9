//! Comma-separated values: a row for each particle, below the units and names of the columns, as in
//! the tables of a run.

use super::ExportError;
use super::frame::Frame;
use super::text::{Printed, Style, line, write_lines};
use files::output::{NewFile, Sheet, table_line};

const STYLE: Style = Style {
    separator: b',',
    nan: "NaN",
};

/// Writes a snapshot; particles have the names of their bodies.
pub fn write(frame: &Frame, out: &mut NewFile) -> Result<(), ExportError> {
    let quoted = |name: &String| {
        let text = String::from_utf8_lossy(&table_line([name])).into_owned();
        text.trim_end_matches('\n').to_owned()
    };
    let bodies: Vec<String> = frame.snapshot.bodies.iter().map(quoted).collect();
    let columns = [&frame.position].into_iter().chain(&frame.columns);
    let mut columns: Vec<Printed> = columns.map(Printed::numbers).collect();
    for printed in columns
        .iter_mut()
        .filter(|printed| printed.column.name == "body")
    {
        printed.words = Some(&bodies);
    }
    let mut sheet = Sheet {
        computed_share: None,
        names: Vec::new(),
        units: Vec::new(),
        rows: Vec::new(),
    };
    for printed in &columns {
        for name in printed.column.names() {
            sheet.names.push(name);
            sheet.units.push(line(&printed.column.unit));
        }
    }
    out.put(&sheet.text())?;
    out.put(format!("# time: {:?} s\n", frame.snapshot.time).as_bytes())?;
    write_lines(frame, &columns, STYLE, out)
}
