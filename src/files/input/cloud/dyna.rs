//! LS-DYNA keyword files: nodes, solid elements, shells of planes, SPH elements, parts.

mod keywords;

#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::Fault;
use super::deck::Deck;
use super::mesh::{Cell, Kind, Mesh, Part, Point, as_place};
use super::part::{MOST_PARTS, PartName};
use super::text::{at, id, number, shortened};
use keywords::{Content, Section};

/// Reads a keyword file, with those that it includes.
///
/// # Errors
/// The fault, with its line.
pub fn read(text: &str, deck: &mut Deck) -> Result<Mesh, Fault> {
    let first = text.lines().find(|line| !is_passed(line));
    match first {
        Some(line) if line.starts_with('*') => {}
        Some(_) => return Err("it is no LS-DYNA file: it does not begin with a keyword".into()),
        None => return Err("it is no LS-DYNA file: it has no keyword".into()),
    }
    let mut reader = Reader::default();
    reader.file(text, deck, false)?;
    reader.finished()
}

/// True of a comment or a blank line before the first keyword.
fn is_passed(line: &str) -> bool {
    line.starts_with('$') || line.trim().is_empty()
}

/// Letters of the value of a parameter, which others may take over.
const LONGEST_VALUE: usize = 80;

/// Particles of one card: all nodes from one number to another.
#[derive(Debug)]
struct Range {
    first: u64,
    last: u64,
    /// Its place in [`Mesh::parts`].
    part: usize,
    /// As in [`Point`].
    mass: f64,
}

#[derive(Debug, Default)]
struct Reader {
    mesh: Mesh,
    /// Places of parts by their numbers.
    places: BTreeMap<i64, usize>,
    /// Values of parameters by their names in small letters.
    parameters: BTreeMap<String, String>,
    ranges: Vec<Range>,
    /// Displacements of parts by their numbers, in units of the file.
    moves: BTreeMap<i64, [f64; 3]>,
    /// Title of the part whose card is next.
    title: Option<String>,
    /// Number and part of the element whose nodes are on the next card.
    waiting: Option<(u64, u64)>,
    /// Cards that the element before still has.
    rest: usize,
}

impl Reader {
    /// Reads a file; the integers of a wide one have ten columns.
    fn file(&mut self, text: &str, deck: &mut Deck, mut is_wide: bool) -> Result<(), String> {
        let mut section = None;
        for (n, line) in text.lines().enumerate() {
            if line.starts_with('$') || (section.is_none() && line.trim().is_empty()) {
                continue;
            }
            if let Some(word) = line.strip_prefix('*') {
                if self.waiting.is_some() || self.rest > 0 {
                    return Err(at(n, "cards of the element before are missing"));
                }
                self.title = None;
                let begun = keywords::begin(word, is_wide).map_err(|what| at(n, what))?;
                if begun.content == Content::Keyword {
                    is_wide = begun.is_wide;
                }
                if begun.content == Content::End {
                    return Ok(());
                }
                section = Some(begun);
                continue;
            }
            let read = match &mut section {
                None => Err("it does not begin with a keyword".to_owned()),
                Some(of) if of.content == Content::Include => {
                    deck.include(line, |deck, text| self.file(text, deck, is_wide))
                }
                Some(of) => self.card(of, line),
            };
            read.map_err(|what| at(n, what))?;
            if self.mesh.nodes.len().max(self.mesh.cells.len()) > super::MOST {
                return Err(at(n, "it has too many nodes or elements"));
            }
        }
        if self.waiting.is_some() || self.rest > 0 {
            return Err("the cards of the last element are missing".to_owned());
        }
        Ok(())
    }

    fn card(&mut self, section: &mut Section, line: &str) -> Result<(), String> {
        if self.rest > 0 {
            self.rest -= 1;
            return Ok(());
        }
        let cells = |widths: &[usize]| self.cells(line, widths, section.is_wide);
        match section.content {
            Content::Nodes => {
                let cells = cells(&[8, 16, 16, 16])?;
                let [node, x, y, z] = &cells[..] else {
                    return Err("a node has a number and three coordinates".to_owned());
                };
                let node = (id(node)?, [coordinate(x)?, coordinate(y)?, coordinate(z)?]);
                self.mesh.nodes.push(node);
            }
            Content::Solids => {
                let numbers = numbers(&cells(&[8; 10])?)?;
                self.solid(&numbers)?;
            }
            Content::Shells(cards) => {
                let numbers = numbers(&cells(&[8; 10])?)?;
                let [element, part, nodes @ ..] = &numbers[..] else {
                    return Err("a shell has a number and a part".to_owned());
                };
                let kind = match nodes {
                    [_, _, c, d, ..] if c == d || *d == 0 => Kind::Triangle,
                    [_, _, _] => Kind::Triangle,
                    _ => Kind::Quadrilateral,
                };
                let has_middles = nodes.iter().skip(4).any(|node| *node != 0);
                self.rest = cards.of_each + usize::from(cards.of_corners && has_middles);
                self.add(kind, *element, *part, nodes)?;
            }
            Content::Particles { is_volume } => {
                let cells = cells(&[8, 8, 16, 8])?;
                let [node, part, mass, end @ ..] = &cells[..] else {
                    return Err("a particle has a node, a part and a mass".to_owned());
                };
                let (first, part, mass) = (id(node)?, part_number(part)?, number(mass)?);
                let mass = if is_volume { -mass } else { mass };
                let last = match end {
                    [end] if !["", "0"].contains(&&**end) => id(end)?,
                    _ => first,
                };
                self.particles(first, last, part, mass)?;
            }
            Content::Parts | Content::OnePart => {
                let number = cells(&[10]);
                let Some(title) = self.title.take() else {
                    self.title = Some(line.trim().to_owned());
                    return Ok(());
                };
                let part = part_number(number?.first().map_or("", |cell| cell))?;
                let part = self.part(part)?;
                self.mesh.parts[part].name.name = title;
                if section.content == Content::OnePart {
                    section.content = Content::Other;
                }
            }
            Content::Move => {
                let cells = cells(&[8, 16, 16, 16, 8, 8])?;
                let [part, x, y, z, more @ ..] = &cells[..] else {
                    return Err("a motion has a part and three displacements".to_owned());
                };
                if more.iter().any(|cell| !["", "0"].contains(&&**cell)) {
                    let what = "in a local system, or of a set of parts,";
                    return Err(format!(
                        "a motion {what} is not read: write the moved nodes"
                    ));
                }
                let shift = [coordinate(x)?, coordinate(y)?, coordinate(z)?];
                let of = self.moves.entry(part_number(part)?).or_default();
                *of = [0, 1, 2].map(|a| of[a] + shift[a]);
            }
            Content::Parameters => {
                for pair in cells(&[10; 8])?.chunks_exact(2) {
                    // The first letter is the type.
                    let mut letters = pair[0].chars();
                    if pair[1].len() > LONGEST_VALUE {
                        return Err("the value of a parameter is too long".to_owned());
                    }
                    if letters.next().is_some() {
                        let name = letters.as_str().trim().to_lowercase();
                        self.parameters.insert(name, pair[1].to_string());
                    }
                }
            }
            Content::Include | Content::Keyword | Content::End | Content::Other => {}
        }
        Ok(())
    }

    /// The cells of a card: parted by commas, or of fixed widths, of which those of integers (8)
    /// are ten columns in a wide file; parameters are replaced by their values.
    fn cells<'l>(
        &self,
        line: &'l str,
        widths: &[usize],
        is_wide: bool,
    ) -> Result<Vec<Cow<'l, str>>, String> {
        if line.contains(',') {
            let cells = line.split(',').take(widths.len());
            return cells.map(|cell| self.value(cell.trim())).collect();
        }
        let mut rest = line;
        let cell = |&width: &usize| {
            let width = if is_wide && width == 8 { 10 } else { width };
            let end = rest.char_indices().nth(width);
            let (cell, after) = rest.split_at(end.map_or(rest.len(), |(n, _)| n));
            rest = after;
            self.value(cell.trim())
        };
        widths.iter().map(cell).collect()
    }

    /// A cell, or the value of the parameter that it names.
    fn value<'l>(&self, cell: &'l str) -> Result<Cow<'l, str>, String> {
        let (is_minus, name) = match cell.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, cell),
        };
        let Some(name) = name.strip_prefix('&') else {
            return Ok(cell.into());
        };
        let value = self.parameters.get(&name.to_lowercase());
        let value = value
            .ok_or_else(|| format!("no `*PARAMETER` before says what `&{}` is", shortened(name)))?;
        Ok(match (is_minus, value.strip_prefix('-')) {
            (false, _) => value.clone().into(),
            (true, Some(value)) => value.to_owned().into(),
            (true, None) => format!("-{value}").into(),
        })
    }

    /// A solid on one card, or on two of which the second has its nodes.
    fn solid(&mut self, numbers: &[u64]) -> Result<(), String> {
        if let Some((element, part)) = self.waiting.take() {
            return self.solid_of(element, part, numbers);
        }
        let &[element, part, ref nodes @ ..] = numbers else {
            return Err("an element has a number and a part".to_owned());
        };
        if nodes.iter().all(|&node| node == 0) {
            self.waiting = Some((element, part));
            return Ok(());
        }
        self.solid_of(element, part, nodes)
    }

    fn solid_of(&mut self, element: u64, part: u64, nodes: &[u64]) -> Result<(), String> {
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
        self.add(kind, element, part, &nodes)
    }

    fn add(&mut self, kind: Kind, element: u64, part: u64, nodes: &[u64]) -> Result<(), String> {
        let cell = Cell::new(kind, element, nodes);
        let cell = cell.ok_or_else(|| format!("element {element} has too few nodes"))?;
        let place = as_place(self.mesh.cells.len())?;
        self.mesh.cells.push(cell);
        let part = self.part(i64::try_from(part).unwrap_or(i64::MAX))?;
        self.mesh.parts[part].cells.push(place);
        Ok(())
    }

    /// Particles of nodes with the numbers from `first` to `last`.
    fn particles(&mut self, first: u64, last: u64, part: i64, mass: f64) -> Result<(), String> {
        let part = self.part(part)?;
        if last < first {
            return Err(format!(
                "its last node {last} comes before its first, {first}"
            ));
        }
        if last > first {
            self.ranges.push(Range {
                first,
                last,
                part,
                mass,
            });
            return Ok(());
        }
        self.point(part, Point { node: first, mass })
    }

    fn point(&mut self, part: usize, point: Point) -> Result<(), String> {
        let place = as_place(self.mesh.points.len())?;
        self.mesh.points.push(point);
        self.mesh.parts[part].points.push(place);
        Ok(())
    }

    /// The place of the part of a number.
    fn part(&mut self, number: i64) -> Result<usize, String> {
        let parts = &mut self.mesh.parts;
        let place = *self.places.entry(number).or_insert(parts.len());
        if place == MOST_PARTS {
            return Err(format!("it has more than {MOST_PARTS} parts"));
        }
        if place == parts.len() {
            parts.push(Part {
                name: PartName {
                    number: Some(number),
                    name: String::new(),
                },
                ..Part::default()
            });
        }
        Ok(place)
    }

    /// The mesh with the particles of ranges, and parts where they were moved to.
    fn finished(mut self) -> Result<Mesh, Fault> {
        self.mesh.sort_nodes()?;
        let mut ranges = std::mem::take(&mut self.ranges);
        ranges.sort_by_key(|range| range.first);
        let twice = ranges.windows(2).find(|pair| pair[1].first <= pair[0].last);
        if let Some([_, Range { first, .. }]) = twice {
            return Err(format!("node {first} is in two ranges of particles").into());
        }
        for Range {
            first,
            last,
            part,
            mass,
        } in ranges
        {
            let nodes = &self.mesh.nodes;
            let begin = nodes.partition_point(|(number, _)| *number < first);
            let end = nodes.partition_point(|(number, _)| *number <= last);
            if (end - begin) as u64 != last - first + 1 {
                let what = "names nodes that are not there";
                return Err(format!("a range of particles, {first} to {last}, {what}").into());
            }
            for node in first..=last {
                self.point(part, Point { node, mass })?;
            }
        }
        if !self.moves.is_empty() {
            self.shift()?;
        }
        Ok(self.mesh)
    }

    /// Moves the nodes of parts.
    fn shift(&mut self) -> Result<(), Fault> {
        let mesh = &mut self.mesh;
        let mut shifts: Vec<Option<[f64; 3]>> = vec![None; mesh.nodes.len()];
        for part in &mesh.parts {
            let shift = part.name.number.and_then(|number| self.moves.get(&number));
            let shift = shift.copied().unwrap_or_default();
            let cells = part.cells.iter().map(|&place| &mesh.cells[place as usize]);
            let corners = cells.flat_map(|cell| {
                let corners = &cell.corners[..cell.kind.corners()];
                corners
                    .iter()
                    .map(|&corner| (corner, "element", cell.number))
            });
            let points = part
                .points
                .iter()
                .map(|&place| mesh.points[place as usize].node);
            for (node, what, of) in corners.chain(points.map(|node| (node, "particle", node))) {
                let place = mesh.node(node, what, of)?;
                if *shifts[place].get_or_insert(shift) != shift {
                    let what = format!("node {node} is of two parts that `*PART_MOVE` parts");
                    return Err(format!("{what}: write the moved nodes").into());
                }
            }
        }
        for ((_, x), shift) in mesh.nodes.iter_mut().zip(shifts) {
            let shift = shift.unwrap_or_default();
            *x = [0, 1, 2].map(|a| x[a] + shift[a]);
        }
        Ok(())
    }
}

/// Whole numbers; what is blank is zero.
fn numbers(cells: &[Cow<str>]) -> Result<Vec<u64>, String> {
    let number = |cell: &Cow<str>| match &**cell {
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
    whole.map_err(|_| format!("`{}` is no number of a part", shortened(cell)))
}
