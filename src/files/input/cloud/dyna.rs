//! LS-DYNA keyword files: nodes, solid elements, shells of planes, SPH elements, parts.

use super::Fault;
use super::mesh::{Cell, Kind, Mesh, Part, Point, as_place};
use super::part::PartName;
use super::text::{at, id, number};

/// Keywords that change places or elements elsewhere, so that they cannot be passed over.
const REFUSED: &[(&str, &str)] = &[
    ("INCLUDE", "put all of it into one file"),
    ("NODE_TRANSFORM", "write the moved nodes"),
    ("NODE_MERGE", "write the merged nodes"),
    ("PARAMETER", "write numbers in place of parameters"),
    ("ELEMENT_SOLID_", "only plain `*ELEMENT_SOLID` is read"),
    ("ELEMENT_GENERATE", "write out its elements"),
    ("ELEMENT_SPH_", "only plain `*ELEMENT_SPH` is read"),
];

/// Content of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    Nodes,
    Solids,
    Shells,
    Particles,
    Parts,
    /// A part with more cards than two, of which the others are passed over.
    OnePart,
    Other,
}

/// Reads a keyword file.
///
/// # Errors
/// The fault, with its line.
pub fn read(text: &str) -> Result<Mesh, Fault> {
    let mut reader = Reader::default();
    let mut section = None;
    for (n, line) in text.lines().enumerate() {
        if line.starts_with('$') {
            continue;
        }
        if let Some(word) = line.strip_prefix('*') {
            if reader.is_within_element {
                return Err(at(n, "the nodes of the element before are missing").into());
            }
            let name = word.to_uppercase();
            if name.starts_with("END") {
                break;
            }
            section = Some(begin(&name).map_err(|what| at(n, what))?);
            reader.title = None;
            continue;
        }
        let Some(section) = section else {
            if line.trim().is_empty() {
                continue;
            }
            return Err("it is no LS-DYNA file: it does not begin with a keyword".into());
        };
        reader.card(section, line).map_err(|what| at(n, what))?;
        if reader.mesh.nodes.len().max(reader.mesh.cells.len()) > super::MOST {
            return Err(at(n, "it has too many nodes or elements").into());
        }
    }
    if section.is_none() {
        return Err("it is no LS-DYNA file: it has no keyword".into());
    }
    Ok(reader.mesh)
}

/// Section that a keyword begins.
fn begin(name: &str) -> Result<Section, String> {
    let bare = name.split(['(', '$']).next().unwrap_or_default().trim();
    if bare.starts_with("KEYWORD") && bare.contains("LONG=") {
        return Err("the long format is not read: write the standard one".to_owned());
    }
    if bare.ends_with(['+', '%']) && (bare.starts_with("NODE") || bare.starts_with("ELEMENT")) {
        return Err("the long format is not read: write the standard one".to_owned());
    }
    if let Some((keyword, help)) = REFUSED.iter().find(|(word, _)| bare.starts_with(word)) {
        let keyword = keyword.trim_end_matches('_');
        return Err(format!("`*{keyword}…` is not read: {help}"));
    }
    Ok(match bare {
        "NODE" => Section::Nodes,
        "ELEMENT_SOLID" => Section::Solids,
        "ELEMENT_SHELL" => Section::Shells,
        "ELEMENT_SPH" => Section::Particles,
        "PART" => Section::Parts,
        _ if bare.starts_with("PART_") && !bare.starts_with("PART_M") => Section::OnePart,
        _ => Section::Other,
    })
}

#[derive(Debug, Default)]
struct Reader {
    mesh: Mesh,
    /// Title of the part whose card is next.
    title: Option<String>,
    /// Number and part of the element whose nodes are on the next card.
    waiting: (u64, i64),
    is_within_element: bool,
}

impl Reader {
    fn card(&mut self, section: Section, line: &str) -> Result<(), String> {
        match section {
            Section::Nodes => {
                let cells = fields(line, &[8, 16, 16, 16]);
                let [node, x, y, z] = &cells[..] else {
                    return Err("a node has a number and three coordinates".to_owned());
                };
                let place = [x, y, z].map(|cell| coordinate(cell));
                let [x, y, z] = place;
                self.mesh.nodes.push((id(node)?, [x?, y?, z?]));
            }
            Section::Solids => self.solid(line)?,
            Section::Shells => {
                let numbers = numbers(&fields(line, &[8; 6]))?;
                let [element, part, nodes @ ..] = &numbers[..] else {
                    return Err("a shell has a number and a part".to_owned());
                };
                let kind = match nodes {
                    [_, _, c, d] if c == d || *d == 0 => Kind::Triangle,
                    [_, _, _] => Kind::Triangle,
                    _ => Kind::Quadrilateral,
                };
                self.add(kind, *element, *part, nodes)?;
            }
            Section::Particles => {
                let cells = fields(line, &[8, 8, 16]);
                let [node, part, mass] = &cells[..] else {
                    return Err("a particle has a node, a part and a mass".to_owned());
                };
                let (node, mass) = (id(node)?, number(mass)?);
                let place = as_place(self.mesh.points.len())?;
                self.mesh.points.push(Point { node, mass });
                let part = self.part(part_number(part)?);
                part.points.push(place);
            }
            Section::Parts | Section::OnePart => match self.title.take() {
                // The cards of a part that are more than two.
                Some(title) if title == PASSED => self.title = Some(title),
                Some(title) => {
                    let cells = fields(line, &[10]);
                    let number = part_number(cells.first().map_or("", |cell| cell))?;
                    self.part(number).name.name = title;
                    if section == Section::OnePart {
                        self.title = Some(PASSED.to_owned());
                    }
                }
                None => self.title = Some(line.trim().to_owned()),
            },
            Section::Other => {}
        }
        Ok(())
    }

    /// A solid on one card, or on two of which the second has its nodes.
    fn solid(&mut self, line: &str) -> Result<(), String> {
        let numbers = numbers(&fields(line, &[8; 10]))?;
        if std::mem::take(&mut self.is_within_element) {
            let (element, part) = self.waiting;
            return self.solid_of(element, part, &numbers);
        }
        let [element, part, nodes @ ..] = &numbers[..] else {
            return Err("an element has a number and a part".to_owned());
        };
        let part_of = i64::try_from(*part).unwrap_or(i64::MAX);
        if nodes.iter().all(|&node| node == 0) {
            self.waiting = (*element, part_of);
            self.is_within_element = true;
            return Ok(());
        }
        self.solid_of(*element, part_of, nodes)
    }

    fn solid_of(&mut self, element: u64, part: i64, nodes: &[u64]) -> Result<(), String> {
        let given = nodes.iter().take(8).take_while(|&&node| node != 0);
        let nodes: Vec<u64> = given.copied().collect();
        let is_one = |from: usize| nodes[from..].iter().all(|node| *node == nodes[from]);
        let kind = match nodes.len() {
            4 => Kind::Tetrahedron,
            6 => Kind::Wedge,
            // Of elements with fewer corners the last ones are there several times.
            8 if is_one(3) => Kind::Tetrahedron,
            8 if is_one(4) => Kind::Pyramid,
            8 => Kind::Hexahedron,
            count => return Err(format!("an element of {count} nodes is not read")),
        };
        let part = u64::try_from(part).unwrap_or(0);
        self.add(kind, element, part, &nodes)
    }

    fn add(&mut self, kind: Kind, element: u64, part: u64, nodes: &[u64]) -> Result<(), String> {
        let cell = Cell::new(kind, element, nodes);
        let cell = cell.ok_or_else(|| format!("element {element} has too few nodes"))?;
        let place = as_place(self.mesh.cells.len())?;
        self.mesh.cells.push(cell);
        let number = i64::try_from(part).unwrap_or(i64::MAX);
        self.part(number).cells.push(place);
        Ok(())
    }

    /// The part of a number.
    fn part(&mut self, number: i64) -> &mut Part {
        let parts = &mut self.mesh.parts;
        // Elements of a part follow each other.
        let found = parts
            .iter()
            .rposition(|part| part.name.number == Some(number));
        let place = found.unwrap_or_else(|| {
            parts.push(Part {
                name: PartName {
                    number: Some(number),
                    name: String::new(),
                },
                ..Part::default()
            });
            parts.len() - 1
        });
        &mut parts[place]
    }
}

/// Stands for a title where no more are read.
const PASSED: &str = "*";

/// The cells of a card: parted by commas, or of fixed widths.
fn fields<'l>(line: &'l str, widths: &[usize]) -> Vec<&'l str> {
    if line.contains(',') {
        return line.split(',').take(widths.len()).map(str::trim).collect();
    }
    let mut cells = Vec::new();
    let mut rest = line;
    for &width in widths {
        let end = rest
            .char_indices()
            .nth(width)
            .map_or(rest.len(), |(n, _)| n);
        let (cell, after) = rest.split_at(end);
        cells.push(cell.trim());
        rest = after;
    }
    cells
}

/// Whole numbers; what is blank is zero.
fn numbers(cells: &[&str]) -> Result<Vec<u64>, String> {
    let number = |cell: &&str| match *cell {
        "" | "0" => Ok(0),
        cell => id(cell),
    };
    cells.iter().map(number).collect()
}

/// A coordinate; what is blank is zero.
fn coordinate(cell: &str) -> Result<f64, String> {
    if cell.is_empty() {
        return Ok(0.0);
    }
    number(cell)
}

fn part_number(cell: &str) -> Result<i64, String> {
    let whole = cell.trim().parse::<i64>();
    whole.map_err(|_| format!("`{}` is no number of a part", super::text::shortened(cell)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DECK: &str = "*KEYWORD\n*PART\n$ a comment\nsphere\n         7         1         1\n*NODE\n\
        \x20      1              0.              0.              0.\n\
        \x20      2           1.0d0              0.              0.       0       0\n\
        3, 1, 1, 0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
        *ELEMENT_SOLID (ten nodes format)\n\
        \x20      1       7\n\
        \x20      1       2       3       4       5       6       7       8       0       0\n\
        *ELEMENT_SOLID\n\
        \x20      2       8       1       2       3       5       5       5       5       5\n\
        *ELEMENT_SPH\n       1       9          2.5e-3\n*MAT_ELASTIC\n1,2,3\n*END\nnonsense";

    #[test]
    fn both_formats_of_cards_are_read() {
        let mesh = read(DECK).unwrap();
        assert_eq!(mesh.nodes.len(), 8);
        assert_eq!(mesh.nodes[1], (2, [1.0, 0.0, 0.0]));
        let kinds: Vec<Kind> = mesh.cells.iter().map(|cell| cell.kind).collect();
        assert_eq!(kinds, [Kind::Hexahedron, Kind::Tetrahedron]);
        assert_eq!(mesh.points[0].mass, 2.5e-3);
        let parts = mesh
            .parts
            .iter()
            .map(|part| (part.name.number, &*part.name.name));
        assert_eq!(
            parts.collect::<Vec<_>>(),
            [(Some(7), "sphere"), (Some(8), ""), (Some(9), "")]
        );
    }

    #[test]
    fn what_cannot_be_read_is_told_with_its_line() {
        for (text, said) in [
            ("", "no LS-DYNA file"),
            ("solid x\n", "no LS-DYNA file"),
            ("*KEYWORD LONG=Y\n", "line 1: the long format"),
            ("*INCLUDE\nmesh.k\n", "line 1: `*INCLUDE…` is not read"),
            ("*NODE\n1,0,0\n", "line 2: a node has a number and three"),
            ("*NODE\n1,0,0,nan\n", "line 2: `nan` is no number"),
            ("*NODE\n-1,0,0,0\n", "line 2: `-1` is no number of a node"),
            (
                "*NODE\n1 0.0 0.0 0.0\n",
                "line 2: `1 0.0 0.` is no number of a node",
            ),
            (
                "*ELEMENT_SOLID\n1,1\n*END\n",
                "line 3: the nodes of the element",
            ),
            (
                "*ELEMENT_SOLID\n1,1,1,2,3,4,5\n",
                "an element of 5 nodes is not read",
            ),
            ("*ELEMENT_SOLID_ORTHO\n", "only plain `*ELEMENT_SOLID`"),
            ("*ELEMENT_SPH\n1,1,x\n", "line 2: `x` is no number"),
        ] {
            let words = read(text).unwrap_err().words;
            assert!(words.contains(said), "{text:?}: {words}");
        }
    }
}
