//! VTK's XML files of points or of an unstructured grid, as ParaView writes them.

mod array;

use roxmltree::{Document, Node, ParsingOptions};

use super::arrays::{Array, asked, with_arrays};
use super::budget::Budget;
use super::mesh::{Cell, Kind, Mesh};
use super::text::shortened;
use super::{Fault, Request, Table, TakeName};
use array::Layout;
use model::Quantity;

/// Most elements of the XML itself, attributes of each, and names of spaces.
const MOST_ELEMENTS: u32 = 100_000;
const MOST_ATTRIBUTES: usize = 1000;
const MOST_SPACES: usize = 100;
/// Start of the element before raw data.
const APPENDED: &[u8] = b"<AppendedData";

/// Reads points, or elements or nodes of a grid, with the arrays that describe them.
///
/// # Errors
/// A fault of the file, or of what is asked of it.
pub fn read(bytes: &[u8], request: &Request) -> Result<Table, Fault> {
    let (head, appended) = split(bytes)?;
    if !is_plain(&head) {
        return Err("it is no XML file of VTK: it has too many attributes".into());
    }
    let options = ParsingOptions {
        nodes_limit: MOST_ELEMENTS,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(&head, options)
        .map_err(|cause| format!("it is no XML file of VTK: {cause}"))?;
    let root = document.root_element();
    if root.tag_name().name() != "VTKFile" {
        return Err("it is no XML file of VTK: it has no `VTKFile`".into());
    }
    let layout = layout(root, appended)?;
    let kind = root.attribute("type").unwrap_or_default();
    if !["UnstructuredGrid", "PolyData"].contains(&kind) {
        let kind = shortened(kind);
        return Err(format!("it holds `{kind}`, not an unstructured grid or points").into());
    }
    let grid = child(root, kind)?;
    let mut pieces = grid.children().filter(|node| node.has_tag_name("Piece"));
    let piece = pieces.next().ok_or("it has no `Piece`")?;
    if pieces.next().is_some() {
        return Err("it has several pieces: save it as one".into());
    }
    let asked = asked(request);
    let mut reader = Reader {
        layout,
        asked,
        budget: Budget::of(bytes.len()),
    };
    reader.piece(piece)?.table(request)
}

/// True of a text that is read in a time which grows as its length: each attribute of an element is
/// compared with all others, and those of name spaces are kept for all elements within.
fn is_plain(head: &str) -> bool {
    let mut elements = head.split('<');
    let attributes = |element: &str| element.bytes().filter(|&b| b == b'=').count();
    elements.all(|element| attributes(element) <= MOST_ATTRIBUTES)
        && head.matches("xmlns").count() <= MOST_SPACES
}

/// Data at the end of a file, and whether it is in base 64.
type Appended<'a> = Option<(&'a [u8], bool)>;

/// The XML without the data at its end, and those.
fn split(bytes: &[u8]) -> Result<(String, Appended<'_>), Fault> {
    let at = bytes
        .windows(APPENDED.len())
        .position(|part| part == APPENDED);
    let head = std::str::from_utf8(&bytes[..at.unwrap_or(bytes.len())])
        .map_err(|_| "it is no XML file of VTK: it is no UTF-8 text")?;
    let Some(at) = at else {
        return Ok((head.to_owned(), None));
    };
    let rest = &bytes[at..];
    let end = rest
        .iter()
        .position(|&b| b == b'>')
        .ok_or("its appended data do not begin")?;
    let tag = String::from_utf8_lossy(&rest[..end]).into_owned();
    let begin = rest[end..].iter().position(|&b| b == b'_');
    let begin = begin.ok_or("its appended data do not begin")?;
    let is_base64 = tag.contains("base64");
    Ok((
        format!("{head}</VTKFile>"),
        Some((&rest[end + begin + 1..], is_base64)),
    ))
}

fn layout<'a>(root: Node, appended: Appended<'a>) -> Result<Layout<'a>, Fault> {
    let header = match root.attribute("header_type") {
        None | Some("UInt32") => 4,
        Some("UInt64") => 8,
        Some(other) => return Err(format!("headers of `{}` are not read", shortened(other)).into()),
    };
    let is_compressed = match root.attribute("compressor") {
        None | Some("") => false,
        Some("vtkZLibDataCompressor") => true,
        Some(other) => {
            let help = "save it with zlib or without compression";
            return Err(format!("`{}` is not read: {help}", shortened(other)).into());
        }
    };
    Ok(Layout {
        header,
        is_little: root.attribute("byte_order") != Some("BigEndian"),
        is_compressed,
        appended,
    })
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Result<Node<'a, 'i>, Fault> {
    let mut children = node.children();
    let found = children.find(|child| child.has_tag_name(name));
    found.ok_or_else(|| format!("it has no `{name}`").into())
}

/// A grid as it is in the file.
struct Piece {
    positions: Vec<f64>,
    cells: Vec<Cell>,
    of_points: Vec<Array>,
    of_cells: Vec<Array>,
}

/// Reader of the arrays of a file.
struct Reader<'a> {
    layout: Layout<'a>,
    /// Names of the arrays that are read.
    asked: Vec<&'a str>,
    budget: Budget,
}

impl Reader<'_> {
    fn piece(&mut self, piece: Node) -> Result<Piece, Fault> {
        let count = |name: &str| -> Result<usize, Fault> {
            let text = piece.attribute(name).unwrap_or("0").trim();
            let count = text.parse::<usize>().ok();
            let count = count.filter(|count| *count <= super::MOST);
            count.ok_or_else(|| format!("its `{name}` is more than a file may hold").into())
        };
        let (points, cells) = (count("NumberOfPoints")?, count("NumberOfCells")?);
        let places = child(child(piece, "Points")?, "DataArray")?;
        let positions = self.numbers(places, 3 * points);
        let positions = positions.map_err(|what| format!("`Points`: {what}"))?;
        let mut found = Piece {
            positions,
            cells: Vec::new(),
            of_points: self.arrays(piece, "PointData", points)?,
            of_cells: Vec::new(),
        };
        if cells > 0 && child(piece, "Cells").is_ok() {
            found.cells = self.elements(child(piece, "Cells")?, cells, points)?;
            found.of_cells = self.arrays(piece, "CellData", cells)?;
        }
        Ok(found)
    }

    /// So many numbers of an array.
    fn numbers(&mut self, node: Node, values: usize) -> Result<Vec<f64>, String> {
        self.budget.take(values, size_of::<f64>())?;
        array::read(node, values, &self.layout)
    }

    /// The arrays of a kind that are asked for, and are numbers.
    fn arrays(&mut self, piece: Node, of: &str, rows: usize) -> Result<Vec<Array>, Fault> {
        let Ok(data) = child(piece, of) else {
            return Ok(Vec::new());
        };
        let mut found = Vec::new();
        for node in data
            .children()
            .filter(|node| node.has_tag_name("DataArray"))
        {
            let (name, components) = array::title(node)?;
            if node.attribute("type") == Some("String") {
                continue;
            }
            // Others have their names told alone.
            let mut values = Vec::new();
            if self.asked.contains(&&*name) {
                let count = components.checked_mul(rows).ok_or("it is too large")?;
                values = self
                    .numbers(node, count)
                    .map_err(|what| format!("the array `{}`: {what}", shortened(&name)))?;
            }
            found.push(Array {
                name,
                components,
                values,
            });
        }
        Ok(found)
    }

    /// The elements that are solids or of a plane, by their numbers from one on.
    fn elements(&mut self, cells: Node, count: usize, points: usize) -> Result<Vec<Cell>, Fault> {
        let mut named = |name: &str, values: usize| -> Result<Vec<f64>, Fault> {
            let mut arrays = cells.children();
            let found = arrays.find(|node| node.attribute("Name") == Some(name));
            let found = found.ok_or_else(|| format!("its `Cells` have no `{name}`"))?;
            let read = self.numbers(found, values);
            Ok(read.map_err(|what| format!("`{name}`: {what}"))?)
        };
        let kinds = named("types", count)?;
        let offsets = named("offsets", count)?;
        let wrong = "its `offsets` do not grow";
        let whole = |x: f64| -> Result<usize, Fault> {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked
            let found = ((0.0..1e12).contains(&x) && x.fract() == 0.0).then_some(x as usize);
            found.ok_or_else(|| format!("{x} is no number of a point").into())
        };
        let last = offsets.last().map_or(Ok(0), |x| whole(*x))?;
        if last > count.saturating_mul(1000) {
            return Err(wrong.into());
        }
        let connectivity = named("connectivity", last)?;
        let mut found = Vec::new();
        let mut first = 0;
        for (number, (kind, offset)) in (1..).zip(kinds.iter().zip(&offsets)) {
            let end = whole(*offset)?;
            let nodes = connectivity.get(first..end).ok_or(wrong)?;
            first = end;
            let Some(kind) = kind_of(*kind, number)? else {
                continue;
            };
            let mut corners = Vec::new();
            for node in nodes.iter().take(kind.corners()) {
                let node = whole(*node)?;
                if node >= points {
                    return Err(format!("cell {number} names a point {node} of {points}").into());
                }
                corners.push(node as u64 + 1);
            }
            let cell = Cell::new(kind, number, &corners);
            found.push(cell.ok_or_else(|| format!("cell {number} has too few points"))?);
        }
        Ok(found)
    }
}

impl Piece {
    /// The particles with what arrays tell of them.
    fn table(self, request: &Request) -> Result<Table, Fault> {
        let (columns, arrays) = if self.cells.is_empty() {
            let metre = request.units.metre()?;
            let positions = self.positions.iter().map(|x| x * metre).collect();
            (vec![(Quantity::Position, positions)], self.of_points)
        } else {
            return self.of_grid(request);
        };
        let rows: Vec<usize> = (0..self.positions.len() / 3).collect();
        with_arrays(Table { columns }, &arrays, &rows, request)
    }

    fn of_grid(self, request: &Request) -> Result<Table, Fault> {
        let (points, _) = self.positions.as_chunks::<3>();
        let mesh = Mesh {
            nodes: (1..).zip(points.iter().copied()).collect(),
            cells: self.cells,
            ..Mesh::default()
        };
        let is_whole = Request {
            parts: Vec::new(),
            columns: request.columns.clone(),
            ..*request
        };
        let (cells, _) = mesh.chosen(&is_whole)?;
        let picked = mesh.picked(&cells, request)?;
        let table = picked.table(request.units.metre()?, request.dimension);
        let arrays = match request.take {
            TakeName::Elements => {
                // Rows of arrays count the cells of the file.
                let number = |&place: &usize| {
                    usize::try_from(mesh.cells[place].number - 1).unwrap_or(usize::MAX)
                };
                let rows: Vec<usize> = picked.of.iter().map(number).collect();
                return with_arrays(table, &self.of_cells, &rows, request);
            }
            TakeName::Nodes => self.of_points,
        };
        with_arrays(table, &arrays, &picked.of, request)
    }
}

/// Form of a cell by VTK's number; nothing of points and lines.
fn kind_of(number: f64, cell: u64) -> Result<Option<Kind>, Fault> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small
    let kind = number as u8;
    Ok(Some(match kind {
        1..=4 | 21 => return Ok(None),
        5 | 22 => Kind::Triangle,
        9 | 23 => Kind::Quadrilateral,
        10 | 24 => Kind::Tetrahedron,
        12 | 25 => Kind::Hexahedron,
        13 | 26 => Kind::Wedge,
        14 | 27 => Kind::Pyramid,
        8 | 11 => {
            let help = "make quadrilaterals or hexahedra of it";
            return Err(format!("cell {cell} is a pixel or a voxel: {help}").into());
        }
        _ => return Err(format!("cell {cell} is of a type {number} that is not read").into()),
    }))
}

#[cfg(test)]
mod tests;
