//! Extended XYZ, which OVITO and ASE read: a text, with a frame for each snapshot.
//!
//! Layout: <https://github.com/libAtoms/extxyz>.

use std::fmt::Write as _;

use super::ExportError;
use super::column::Column;
use super::frame::Frame;
use super::text::{Printed, Style, line, word, write_lines};
use super::values::Values;
use files::output::NewFile;

const STYLE: Style = Style {
    separator: b' ',
    nan: "nan",
};

/// Adds a frame. The species of a particle is the name of its body. Z, which separates atoms in ASE
/// beyond the names of elements, is the body's number, from one on.
pub fn write(frame: &Frame, out: &mut NewFile) -> Result<(), ExportError> {
    let bodies: Vec<String> = (frame.snapshot.bodies.iter())
        .map(|name| word(name))
        .collect();
    let numbers: Vec<String> = (1..=bodies.len()).map(|n| n.to_string()).collect();
    let radius = Column::radius();
    let position = &frame.position;
    let mut columns = Vec::new();
    let mut properties = Vec::new();
    let mut add = |column, words, more: Vec<Property>| {
        columns.push(Printed { column, words });
        properties.extend(more);
    };
    let one = |name: &str, type_code, width| vec![(name.to_owned(), type_code, width)];
    if let Some(body) = frame.column("body") {
        add(body, Some(&bodies[..]), one("species", 'S', 1));
        add(position, None, one("pos", 'R', 3));
        add(body, Some(&numbers[..]), one("Z", 'I', 1));
    } else {
        add(position, None, one("pos", 'R', 3));
    }
    add(&radius, None, properties_of(&radius));
    for column in &frame.columns {
        if !["body", "radius"].contains(&column.name.as_str()) {
            add(column, None, properties_of(column));
        }
    }
    out.put(head(frame, &columns, &properties, &bodies).as_bytes())?;
    write_lines(frame, &columns, STYLE, out)
}

/// Name, type and number of columns.
type Property = (String, char, usize);

fn head(frame: &Frame, columns: &[Printed], properties: &[Property], bodies: &[String]) -> String {
    let properties = properties.iter();
    let properties =
        properties.map(|(name, type_code, width)| format!("{name}:{type_code}:{width}"));
    let properties: Vec<String> = properties.collect();
    let unit = |printed: &Printed| {
        let column = printed.column;
        (!column.unit.is_empty()).then(|| format!(", {}: {}", column.name, line(&column.unit)))
    };
    let units: String = columns.iter().filter_map(unit).collect();
    let mut head = format!("{}\nProperties={}", frame.rows(), properties.join(":"));
    let _ = write!(head, " pbc=\"F F F\" Time={:?}", frame.snapshot.time);
    if let Some(step) = frame.step {
        let _ = write!(head, " Step={step}");
    }
    let (title, bodies) = (line(&frame.snapshot.title), bodies.join(" "));
    let _ = writeln!(
        head,
        " title=\"{title}\" bodies=\"{bodies}\" units=\"Time: s{units}\""
    );
    head
}

/// Properties of a column: a vector is one, a tensor has one for each component.
fn properties_of(column: &Column) -> Vec<Property> {
    let type_code = match Values::zeros(column.element, 0) {
        Values::F64(_) | Values::F32(_) => 'R',
        _ => 'I',
    };
    if column.components.len() == 3 {
        return vec![(column.name.clone(), type_code, 3)];
    }
    let names = column.names().into_iter();
    names.map(|name| (name, type_code, 1)).collect()
}
