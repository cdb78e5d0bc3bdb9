//! Abaqus input files: nodes, elements and sets of parts, and their instances in the assembly.

mod instance;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use super::Fault;
use super::budget::Budget;
use super::deck::Deck;
use super::mesh::{Cell, Kind, Mesh, Part, as_place};
use super::part::{MOST_PARTS, PartName};
use super::text::{at, id, number, shortened};
use instance::Instance;
use model::Vec3;

/// Keywords that make or move nodes and elements, so that they cannot be passed over.
const REFUSED: &[(&str, &str)] = &[
    ("SYSTEM", "write nodes in the global system"),
    ("ADJUST", "write the moved nodes"),
    ("IMPERFECTION", "write the moved nodes"),
    ("IMPORT", "write the imported nodes and elements"),
    ("NGEN", "write out its nodes"),
    ("NFILL", "write out its nodes"),
    ("NCOPY", "write out its nodes"),
    ("NMAP", "write out its nodes"),
    ("ELGEN", "write out its elements"),
    ("ELCOPY", "write out its elements"),
    ("PARAMETER", "write numbers in place of parameters"),
];

/// Beginnings of types of elements that are matter, too: particles, thick shells, Eulerian and
/// cylindrical ones.
const OTHER_SOLIDS: &[&str] = &["PC3D", "PD3D", "SC6", "SC8", "CSS8", "EC3D", "CCL"];

/// A keyword with its parameters.
struct Keyword {
    name: String,
    parameters: Vec<(String, String)>,
}

impl Keyword {
    /// Of its line, or of several that are joined.
    fn of(line: &str) -> Self {
        let mut words = line.trim_start_matches('*').split(',').map(str::trim);
        let name = words.next().unwrap_or_default().to_uppercase();
        let parameter = |word: &str| {
            let (key, value) = word.split_once('=').unwrap_or((word, ""));
            let value = value.trim().trim_matches('"').to_owned();
            (key.trim().to_uppercase(), value)
        };
        Self {
            name: name.split_whitespace().collect::<Vec<_>>().join(" "),
            parameters: words
                .filter(|word| !word.is_empty())
                .map(parameter)
                .collect(),
        }
    }

    fn get(&self, key: &str) -> Option<&str> {
        let mut parameters = self.parameters.iter();
        let found = parameters.find(|(known, _)| known == key);
        found.map(|(_, value)| value.as_str())
    }
}

/// Nodes and elements with numbers of their own: a part, or all of a file without parts.
#[derive(Debug, Default)]
struct Block {
    name: String,
    mesh: Mesh,
    /// By the number of the element.
    places: BTreeMap<u64, u32>,
    /// Places of sets by their names in capitals, since large and small letters are the same.
    sets: BTreeMap<String, usize>,
}

/// Owner of the lines of data that follow.
#[derive(Debug, Clone)]
enum Section {
    Nodes,
    Elements(Kind, usize, Option<usize>),
    /// Elements that are no solids.
    Skipped,
    Set(usize, bool),
    Instance,
    Other,
}

#[derive(Debug)]
struct Reader {
    /// The first is what stands outside of parts.
    blocks: Vec<Block>,
    /// The one that is read.
    block: usize,
    instances: Vec<Instance>,
    section: Section,
    /// A keyword so far, whose line goes on.
    keyword: String,
    /// Numbers of an element so far, whose line goes on.
    begun: Vec<u64>,
    /// Places of parts in `blocks` by their names in capitals.
    parts: BTreeMap<String, usize>,
}

/// Reads an input file, with those that it names.
///
/// # Errors
/// The fault, with its line.
pub fn read(text: &str, deck: &mut Deck) -> Result<Mesh, Fault> {
    match lines(text).next() {
        Some((_, line)) if line.starts_with('*') => {}
        Some(_) => return Err("it is no Abaqus input: it does not begin with a keyword".into()),
        None => return Err("it is no Abaqus input: it has no keyword".into()),
    }
    let mut reader = Reader {
        blocks: vec![Block::default()],
        block: 0,
        instances: Vec::new(),
        section: Section::Other,
        keyword: String::new(),
        begun: Vec::new(),
        parts: BTreeMap::new(),
    };
    reader.file(text, deck)?;
    reader.finished(&mut deck.budget)
}

/// Lines that are no comments, with their numbers.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text.lines().map(str::trim).enumerate();
    lines.filter(|(_, line)| !line.is_empty() && !line.starts_with("**"))
}

impl Reader {
    /// Reads a file: keywords and data, or data of the keyword before.
    fn file(&mut self, text: &str, deck: &mut Deck) -> Result<(), String> {
        for (n, line) in lines(text) {
            if !self.keyword.is_empty() || line.starts_with('*') {
                self.keyword.push_str(line);
                if !line.ends_with(',') {
                    let keyword = Keyword::of(&std::mem::take(&mut self.keyword));
                    self.begin(&keyword, deck).map_err(|what| at(n, what))?;
                }
                continue;
            }
            self.data(line, &mut deck.budget)
                .map_err(|what| at(n, what))?;
        }
        if self.keyword.is_empty() {
            Ok(())
        } else {
            Err("its last keyword ends with a comma".to_owned())
        }
    }

    /// Begins a keyword, and reads the data that it has in a file.
    fn begin(&mut self, keyword: &Keyword, deck: &mut Deck) -> Result<(), String> {
        if keyword.name != "INCLUDE" {
            self.section(keyword)?;
        }
        let is_read = !matches!(self.section, Section::Skipped | Section::Other);
        match keyword.get("INPUT") {
            Some(name) if is_read || keyword.name == "INCLUDE" => {
                deck.include(name, |deck, text| self.file(text, deck))
            }
            None if keyword.name == "INCLUDE" => Err("`*INCLUDE` names no file".to_owned()),
            _ => Ok(()),
        }
    }

    fn section(&mut self, keyword: &Keyword) -> Result<(), String> {
        if !self.begun.is_empty() {
            return Err("the element before has too few nodes".to_owned());
        }
        let refused = REFUSED.iter().find(|(name, _)| keyword.name == *name);
        if let Some((name, help)) = refused {
            return Err(format!("`*{name}` is not read: {help}"));
        }
        self.section = match keyword.name.as_str() {
            "PART" => {
                let name = keyword.get("NAME").ok_or("a part has no name")?;
                let place = self.blocks.len();
                if self.parts.insert(name.to_uppercase(), place).is_some() {
                    return Err(format!("two parts have the name `{}`", shortened(name)));
                }
                self.blocks.push(Block {
                    name: name.to_owned(),
                    ..Block::default()
                });
                self.block = self.blocks.len() - 1;
                Section::Other
            }
            "END PART" | "ASSEMBLY" => {
                self.block = 0;
                Section::Other
            }
            "INSTANCE" => {
                let name = keyword.get("NAME").ok_or("an instance has no name")?;
                let part = keyword.get("PART").ok_or("an instance has no part")?;
                self.instances.push(Instance::new(name, part));
                Section::Instance
            }
            "NODE" if matches!(self.section, Section::Instance) => {
                return Err("an instance with nodes of its own is not read".to_owned());
            }
            "NODE"
                if keyword
                    .get("SYSTEM")
                    .is_some_and(|s| !s.eq_ignore_ascii_case("R")) =>
            {
                return Err("nodes of a cylindrical or spherical system are not read".to_owned());
            }
            "NODE" => Section::Nodes,
            "ELEMENT" => self.elements(keyword)?,
            // Sets of the assembly are of instances.
            "ELSET" if keyword.get("INSTANCE").is_none() => {
                let name = keyword.get("ELSET").ok_or("a set has no name")?.to_owned();
                let set = self.blocks[self.block].set(&name, true)?;
                Section::Set(set, keyword.get("GENERATE").is_some())
            }
            _ => Section::Other,
        };
        Ok(())
    }

    fn elements(&mut self, keyword: &Keyword) -> Result<Section, String> {
        let word = keyword
            .get("TYPE")
            .ok_or("elements have no type")?
            .to_uppercase();
        let Some((kind, nodes)) = kind_of(&word)? else {
            return Ok(Section::Skipped);
        };
        let block = &mut self.blocks[self.block];
        let mut set = None;
        if let Some(name) = keyword.get("ELSET") {
            let place = block.set(name, false)?;
            block.mesh.parts[place].is_set = false;
            set = Some(place);
        }
        Ok(Section::Elements(kind, nodes, set))
    }

    fn data(&mut self, line: &str, budget: &mut Budget) -> Result<(), String> {
        let cells = || line.split(',').map(str::trim);
        match self.section.clone() {
            Section::Nodes => {
                let cells: Vec<&str> = cells().collect();
                let [node, places @ ..] = &cells[..] else {
                    return Err("a node has a number and coordinates".to_owned());
                };
                let mut x = [0.0; 3];
                for (x, cell) in x.iter_mut().zip(places) {
                    *x = if cell.is_empty() { 0.0 } else { number(cell)? };
                }
                self.blocks[self.block].mesh.nodes.push((id(node)?, x));
            }
            Section::Elements(kind, nodes, set) => {
                for cell in cells().filter(|cell| !cell.is_empty()) {
                    self.begun.push(id(cell)?);
                }
                if self.begun.len() > nodes + 1 {
                    return Err(format!("an element of {nodes} nodes has more than that"));
                }
                if self.begun.len() == nodes + 1 {
                    let begun = std::mem::take(&mut self.begun);
                    self.element(kind, &begun, set)?;
                }
            }
            Section::Set(set, is_range) => {
                let cells: Vec<&str> = cells().filter(|cell| !cell.is_empty()).collect();
                self.blocks[self.block].extend(set, is_range, &cells, budget)?;
            }
            Section::Instance => {
                let numbers: Result<Vec<f64>, String> = cells().map(number).collect();
                let numbers = numbers?;
                let instance = self.instances.last_mut().ok_or("no instance")?;
                instance.lines += 1;
                match (instance.lines, &numbers[..]) {
                    (1, &[x, y, z]) => instance.shift = Vec3::new(x, y, z),
                    (2, &[a, b, c, d, e, f, angle]) => {
                        let ends = (Vec3::new(a, b, c), Vec3::new(d, e, f));
                        instance.turn = Some((ends.0, ends.1, angle.to_radians()));
                    }
                    _ => return Err("an instance has a shift of 3 numbers and a turn of 7".into()),
                }
            }
            Section::Skipped | Section::Other => {}
        }
        Ok(())
    }

    fn element(&mut self, kind: Kind, of: &[u64], set: Option<usize>) -> Result<(), String> {
        let block = &mut self.blocks[self.block];
        let place = as_place(block.mesh.cells.len())?;
        let cell = Cell::new(kind, of[0], &of[1..]).ok_or("an element has too few nodes")?;
        block.mesh.cells.push(cell);
        if block.places.insert(of[0], place).is_some() {
            return Err(format!("two elements have the number {}", of[0]));
        }
        if let Some(set) = set {
            block.mesh.parts[set].cells.push(place);
        }
        Ok(())
    }

    /// All blocks, or all instances of them, as one mesh.
    fn finished(mut self, budget: &mut Budget) -> Result<Mesh, Fault> {
        if !self.begun.is_empty() {
            return Err("the last element has too few nodes".into());
        }
        if self.blocks.len() == 1 && self.instances.is_empty() {
            return Ok(self.blocks.remove(0).mesh);
        }
        let mut all = Mesh::default();
        let mut first = 0;
        if self.instances.is_empty() {
            self.instances = self.blocks[1..]
                .iter()
                .map(|b| Instance::new(&b.name, &b.name))
                .collect();
        }
        for instance in &self.instances {
            let place = self.parts.get(&instance.part.to_uppercase());
            let block = place.map(|&place| &self.blocks[place]).ok_or_else(|| {
                let (name, part) = (shortened(&instance.name), shortened(&instance.part));
                format!("the instance `{name}` is of a part `{part}` that is not there")
            })?;
            first = instance.add(&block.mesh, first, &mut all, budget)?;
        }
        Ok(all)
    }
}

impl Block {
    /// The set of a name.
    fn set(&mut self, name: &str, is_set: bool) -> Result<usize, String> {
        let parts = &mut self.mesh.parts;
        let place = *self.sets.entry(name.to_uppercase()).or_insert(parts.len());
        if place == MOST_PARTS {
            return Err(format!("it has more than {MOST_PARTS} sets"));
        }
        if place == parts.len() {
            parts.push(Part {
                name: PartName {
                    number: None,
                    name: name.to_owned(),
                },
                is_set,
                ..Part::default()
            });
        }
        Ok(place)
    }

    /// Adds elements to a set: numbers and names of sets, or a range.
    fn extend(
        &mut self,
        set: usize,
        is_range: bool,
        cells: &[&str],
        budget: &mut Budget,
    ) -> Result<(), String> {
        let parts = &mut self.mesh.parts;
        if is_range {
            let (first, last, step) = match cells {
                [first, last] => (id(first)?, id(last)?, 1),
                [first, last, step] => (id(first)?, id(last)?, id(step)?),
                _ => return Err("a range has a first, a last and perhaps a step".to_owned()),
            };
            for (number, &place) in self.places.range(first..=last.max(first)) {
                budget.take(1, 2 * size_of::<u32>())?;
                if (number - first).is_multiple_of(step) {
                    parts[set].cells.push(place);
                }
            }
            return Ok(());
        }
        for cell in cells {
            if let Ok(element) = id(cell) {
                // Others are of elements that are no solids.
                if let Some(place) = self.places.get(&element) {
                    parts[set].cells.push(*place);
                }
                continue;
            }
            let name = cell.trim_matches('"');
            let other = self.sets.get(&name.to_uppercase());
            let other =
                *other.ok_or_else(|| format!("no set `{}` comes before", shortened(name)))?;
            if other != set {
                budget.take(parts[other].cells.len(), 2 * size_of::<u32>())?;
                let cells = parts[other].cells.clone();
                parts[set].cells.extend(cells);
            }
        }
        Ok(())
    }
}

/// Form and number of nodes of a type of elements; nothing of those that are no solids.
fn kind_of(word: &str) -> Result<Option<(Kind, usize)>, String> {
    let (family, rest) = match word {
        _ if word.starts_with("C3D") => ("C3D", &word[3..]),
        _ if word.starts_with("CPE") | word.starts_with("CPS") => ("CP", &word[3..]),
        _ if word.starts_with("CAX") | word.starts_with("CGAX") => {
            return Err(format!(
                "axisymmetric elements `{}` are not read",
                shortened(word)
            ));
        }
        _ if OTHER_SOLIDS.iter().any(|other| word.starts_with(other)) => {
            return Err(format!("elements `{}` are not read", shortened(word)));
        }
        _ => return Ok(None),
    };
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    let nodes: usize = digits.parse().unwrap_or(0);
    let kind = match (family, nodes) {
        ("C3D", 4 | 10) => Kind::Tetrahedron,
        ("C3D", 5 | 13) => Kind::Pyramid,
        ("C3D", 6 | 15) => Kind::Wedge,
        ("C3D", 8 | 20) => Kind::Hexahedron,
        ("CP", 3 | 6) => Kind::Triangle,
        ("CP", 4 | 8) => Kind::Quadrilateral,
        _ => return Err(format!("elements `{}` are not read", shortened(word))),
    };
    Ok(Some((kind, nodes)))
}
