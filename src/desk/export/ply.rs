//! PLY: a cloud of points with their columns, and the colours that bodies have in pictures.
//!
//! Layout: Turk, The PLY Polygon File Format (1994). It has no integers of 64 bits: those of a
//! column are stored in two, the lower and the upper 32 bits.

use std::fmt::Write as _;

use super::ExportError;
use super::column::Column;
use super::frame::{Frame, Piece};
use super::text::line;
use super::values::{IS_LITTLE, Values};
use files::output::{NewFile, VERSION};
use plot::colour_of;

/// Writes a snapshot.
pub fn write(frame: &Frame, out: &mut NewFile) -> Result<(), ExportError> {
    out.put(head(frame).as_bytes())?;
    let columns = [&frame.position].into_iter().chain(&frame.columns);
    let columns: Vec<&Column> = columns.collect();
    for piece in frame.pieces() {
        out.put(&rows(frame, &columns, &piece)?)?;
    }
    Ok(())
}

fn rows(frame: &Frame, columns: &[&Column], piece: &Piece) -> Result<Vec<u8>, ExportError> {
    let bodies = frame.snapshot.body_of(piece.rows.clone())?;
    let read = |column: &&Column| frame.read(column, piece);
    let values = columns.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let count = piece.rows.len();
    let size = |values: &Values| values.bytes().len() / count.max(1);
    let mut rows = Vec::with_capacity(count * (3 + values.iter().map(size).sum::<usize>()));
    for row in 0..count {
        for (index, values) in values.iter().enumerate() {
            let size = size(values);
            let bytes = &values.bytes()[row * size..(row + 1) * size];
            rows.extend_from_slice(bytes);
            if index == 0 {
                rows.extend_from_slice(&colour_of(bodies[row]));
            }
        }
    }
    Ok(rows)
}

fn head(frame: &Frame) -> String {
    let order = if IS_LITTLE { "little" } else { "big" };
    let mut head = format!("ply\nformat binary_{order}_endian 1.0\n");
    let _ = writeln!(
        head,
        "comment whipple {VERSION}: {}",
        line(&frame.snapshot.title)
    );
    let _ = writeln!(head, "comment time {:?} s", frame.snapshot.time);
    for (number, name) in frame.snapshot.bodies.iter().enumerate() {
        let _ = writeln!(head, "comment body {number} is {}", line(name));
    }
    let columns = || [&frame.position].into_iter().chain(&frame.columns);
    for column in columns().filter(|column| !column.unit.is_empty()) {
        let _ = writeln!(
            head,
            "comment unit of {} is {}",
            column.name,
            line(&column.unit)
        );
    }
    let _ = writeln!(head, "element vertex {}", frame.rows());
    for (index, column) in columns().enumerate() {
        for name in column.names() {
            for (ending, type_name) in types(column) {
                let _ = writeln!(head, "property {type_name} {name}{ending}");
            }
        }
        if index == 0 {
            for name in ["red", "green", "blue"] {
                let _ = writeln!(head, "property uchar {name}");
            }
        }
    }
    head.push_str("end_header\n");
    head
}

/// Endings of names, and types.
fn types(column: &Column) -> &'static [(&'static str, &'static str)] {
    match Values::zeros(column.element, 0) {
        Values::F64(_) => &[("", "double")],
        Values::F32(_) => &[("", "float")],
        Values::U32(_) => &[("", "uint")],
        Values::U8(_) => &[("", "uchar")],
        Values::I64(_) | Values::U64(_) if IS_LITTLE => &[("_lower", "uint"), ("_upper", "uint")],
        Values::I64(_) | Values::U64(_) => &[("_upper", "uint"), ("_lower", "uint")],
    }
}
