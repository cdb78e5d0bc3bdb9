//! VTU, XML with appended binary data, which ParaView, VTK, PyVista and meshio read, and `.pvd`, the index
//! of a series.
//!
//! Layout: VTK File Formats, <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>.

use std::fmt::Write as _;

use super::ExportError;
use super::column::Column;
use super::frame::Frame;
use super::values::{IS_LITTLE, Values};
use files::output::NewFile;

/// VTK's type of a cell of one point.
const VERTEX: u8 = 1;
/// Rows whose cells are made at a time.
const CELLS: u64 = 1 << 17;

/// An array: what its element says, and its bytes.
struct Declared<'a> {
    element: String,
    bytes: u64,
    content: Content<'a>,
}

enum Content<'a> {
    Column(&'a Column),
    Connectivity,
    Offsets,
    Types,
}

/// Writes a snapshot: a vertex for each particle.
pub fn write(frame: &Frame, out: &mut NewFile) -> Result<(), ExportError> {
    let mut offset = 0;
    let mut head = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
         byte_order=\"{}\" header_type=\"UInt64\">\n<UnstructuredGrid>\n",
        order()
    );
    head.push_str(&field_data(frame));
    let rows = frame.rows();
    let _ = writeln!(
        head,
        "<Piece NumberOfPoints=\"{rows}\" NumberOfCells=\"{rows}\">"
    );
    let groups = groups(frame);
    for (tag, arrays) in &groups {
        let _ = writeln!(head, "<{tag}>");
        for array in arrays {
            let (opening, keys) = array.element.split_once('>').unwrap_or_default();
            let _ = writeln!(
                head,
                "<DataArray {opening} format=\"appended\" offset=\"{offset}\">{keys}</DataArray>"
            );
            offset += 8 + array.bytes;
        }
        let _ = writeln!(head, "</{tag}>");
    }
    head.push_str("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    out.put(head.as_bytes())?;
    for array in groups.iter().flat_map(|(_, arrays)| arrays) {
        out.put(&array.bytes.to_ne_bytes())?;
        write_array(frame, &array.content, out)?;
    }
    out.put(b"\n</AppendedData>\n</VTKFile>\n")?;
    Ok(())
}

fn groups(frame: &Frame) -> [(&'static str, Vec<Declared<'_>>); 3] {
    let rows = frame.rows();
    let declared = |column| declared(column, rows);
    let cells = |name: &str, type_name: &str, size: u64, content| Declared {
        element: format!("type=\"{type_name}\" Name=\"{name}\">"),
        bytes: rows * size,
        content,
    };
    [
        ("PointData", frame.columns.iter().map(declared).collect()),
        ("Points", vec![declared(&frame.position)]),
        (
            "Cells",
            vec![
                cells("connectivity", "Int64", 8, Content::Connectivity),
                cells("offsets", "Int64", 8, Content::Offsets),
                cells("types", "UInt8", 1, Content::Types),
            ],
        ),
    ]
}

/// A column as an array, with its unit.
fn declared(column: &Column, rows: u64) -> Declared<'_> {
    let type_name = match Values::zeros(column.element, 0) {
        Values::F64(_) => "Float64",
        Values::F32(_) => "Float32",
        Values::I64(_) => "Int64",
        Values::U64(_) => "UInt64",
        Values::U32(_) => "UInt32",
        Values::U8(_) => "UInt8",
    };
    let width = column.components.len();
    let mut element = format!(
        "type=\"{type_name}\" Name=\"{}\" NumberOfComponents=\"{width}\"",
        column.name
    );
    for (k, name) in column.components.iter().enumerate().filter(|_| width > 1) {
        let _ = write!(element, " ComponentName{k}=\"{name}\"");
    }
    element.push('>');
    if !column.unit.is_empty() {
        let unit = escaped(&column.unit);
        let _ = write!(
            element,
            "<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{unit}</InformationKey>"
        );
    }
    Declared {
        element,
        bytes: rows * (width * column.element.bytes()) as u64,
        content: Content::Column(column),
    }
}

fn write_array(frame: &Frame, content: &Content, out: &mut NewFile) -> Result<(), ExportError> {
    if let Content::Column(column) = content {
        for piece in frame.pieces() {
            out.put(frame.read(column, &piece)?.bytes())?;
        }
        return Ok(());
    }
    let rows = frame.rows();
    for first in (0..rows).step_by(usize::try_from(CELLS).unwrap_or(1)) {
        let rows = first..rows.min(first + CELLS);
        match content {
            Content::Types => out.put(&rows.map(|_| VERTEX).collect::<Vec<u8>>())?,
            Content::Connectivity => out.put(bytemuck::cast_slice(&rows.collect::<Vec<u64>>()))?,
            _ => out.put(bytemuck::cast_slice(
                &rows.map(|k| k + 1).collect::<Vec<u64>>(),
            ))?,
        }
    }
    Ok(())
}

/// The time, and in a comment, since not all readers take arrays of texts, the title and the names of bodies.
fn field_data(frame: &Frame) -> String {
    let snapshot = &frame.snapshot;
    format!(
        "{}<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" \
         format=\"ascii\">{:?}</DataArray>\n</FieldData>\n",
        comment(&snapshot.title, &snapshot.bodies),
        snapshot.time
    )
}

/// A comment of XML, a line for the title and for each body.
fn comment(title: &str, bodies: &[String]) -> String {
    let mut text = format!("<!--\ntitle: {}\n", commented(title));
    for (number, name) in bodies.iter().enumerate() {
        let _ = writeln!(text, "body {number}: {}", commented(name));
    }
    text + "-->\n"
}

/// A text as a comment of XML has it: on one line, without two hyphens.
fn commented(text: &str) -> String {
    escaped(text).replace('-', "\u{2010}")
}

/// The index of a series: times (s) and names of files beside it.
pub fn index(files: &[(f64, String)]) -> String {
    let order = order();
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
         byte_order=\"{order}\">\n<Collection>\n"
    );
    for (time, name) in files {
        let name = escaped(name);
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>"
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    text
}

fn order() -> &'static str {
    if IS_LITTLE {
        "LittleEndian"
    } else {
        "BigEndian"
    }
}

/// A text as XML has it.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push('_'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_ends_where_it_shall() {
        let text = comment("a --> b\n<x>", &["wall-1".to_owned(), "b&c".to_owned()]);
        assert_eq!(
            text,
            "<!--\ntitle: a \u{2010}\u{2010}&gt; b_&lt;x&gt;\nbody 0: wall\u{2010}1\nbody 1: b&amp;c\n-->\n"
        );
    }
}
