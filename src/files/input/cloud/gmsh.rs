//! Gmsh meshes, ASCII of formats 2.2 and 4.1: elements by their physical groups.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::Fault;
use super::budget::Budget;
use super::mesh::{Cell, Kind, Mesh, Part, as_place};
use super::part::PartName;
use super::text::{Words, of, shortened};

/// Memory that an element of a group counts as (bytes): lists grow, and each takes time to be found.
const ENTRY: usize = 32;

/// Dimension and number of an entity or of a group.
type Key = (u8, i64);

#[derive(Debug, Default)]
struct Reader {
    mesh: Mesh,
    /// Names of groups.
    names: BTreeMap<Key, String>,
    /// Groups of entities.
    groups: BTreeMap<Key, Rc<[i64]>>,
    /// Elements of groups, and of entities of which none is in a group.
    of_group: BTreeMap<Key, Vec<u32>>,
    of_entity: BTreeMap<Key, Vec<u32>>,
    budget: Budget,
}

/// Reads a mesh.
///
/// # Errors
/// The fault, with its line.
pub fn read(bytes: &[u8]) -> Result<Mesh, Fault> {
    let head = of(&bytes[..bytes.len().min(200)]).into_owned();
    let mut first = Words::of(&head);
    if first.line() != Some("$MeshFormat") {
        return Err("it is no Gmsh mesh: it does not begin with `$MeshFormat`".into());
    }
    let version = first.number()?;
    if first.whole()? != 0 {
        let help = "save it as ASCII, in Gmsh with `Mesh.Binary = 0`";
        return Err(format!("it is a binary Gmsh mesh: {help}").into());
    }
    let is_new = version == 4.1;
    if !is_new && ![2.0, 2.1, 2.2].contains(&version) {
        let help = "save it as 4.1 or 2.2 (`Mesh.MshFileVersion`)";
        return Err(format!("Gmsh's format {version} is not read: {help}").into());
    }
    let text = of(bytes);
    let mut words = Words::of(&text);
    let mut reader = Reader {
        budget: Budget::of(bytes.len()),
        ..Reader::default()
    };
    let mut has_elements = false;
    while let Some(line) = words.line() {
        let read = match (line, is_new) {
            ("$PhysicalNames", _) => reader.physical_names(&mut words),
            ("$Entities", true) => reader.entities(&mut words),
            ("$Nodes", true) => reader.nodes_of_4(&mut words),
            ("$Nodes", false) => reader.nodes_of_2(&mut words),
            ("$Elements", true) => reader.elements_of_4(&mut words),
            ("$Elements", false) => reader.elements_of_2(&mut words),
            ("$PartitionedEntities", _) => {
                Err(words.wrong("a mesh in partitions is not read: save it as a whole"))
            }
            _ => Ok(()),
        };
        read?;
        has_elements |= line == "$Elements";
    }
    if !has_elements {
        return Err("it has no `$Elements`".into());
    }
    Ok(reader.finished())
}

impl Reader {
    fn physical_names(&mut self, words: &mut Words) -> Result<(), String> {
        for _ in 0..words.count()? {
            let dimension = dimension(words)?;
            let number = words.whole()?;
            let name = words.rest();
            let name = name.trim().trim_matches('"').to_owned();
            self.names.insert((dimension, number), name);
        }
        Ok(())
    }

    fn entities(&mut self, words: &mut Words) -> Result<(), String> {
        let counts = [
            words.count()?,
            words.count()?,
            words.count()?,
            words.count()?,
        ];
        for (dimension, count) in (0_u8..).zip(counts) {
            for _ in 0..count {
                let number = words.whole()?;
                // A point, or the corners of a box.
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    words.number()?;
                }
                let mut groups = Vec::new();
                for _ in 0..words.count()? {
                    groups.push(words.whole()?.saturating_abs());
                }
                if dimension > 0 {
                    for _ in 0..words.count()? {
                        words.whole()?;
                    }
                }
                self.groups.insert((dimension, number), groups.into());
            }
        }
        Ok(())
    }

    fn nodes_of_2(&mut self, words: &mut Words) -> Result<(), String> {
        for _ in 0..words.count()? {
            let node = words.id()?;
            let place = [words.number()?, words.number()?, words.number()?];
            self.mesh.nodes.push((node, place));
        }
        Ok(())
    }

    fn nodes_of_4(&mut self, words: &mut Words) -> Result<(), String> {
        let blocks = words.count()?;
        for _ in 0..3 {
            words.whole()?;
        }
        let mut numbers = Vec::new();
        for _ in 0..blocks {
            let dimension = dimension(words)?;
            words.whole()?;
            let parameters = if words.whole()? == 0 { 0 } else { dimension };
            numbers.clear();
            for _ in 0..words.count()? {
                numbers.push(words.id()?);
            }
            for &node in &numbers {
                let place = [words.number()?, words.number()?, words.number()?];
                for _ in 0..parameters {
                    words.number()?;
                }
                self.mesh.nodes.push((node, place));
            }
        }
        Ok(())
    }

    fn elements_of_2(&mut self, words: &mut Words) -> Result<(), String> {
        for _ in 0..words.count()? {
            let number = words.id()?;
            let kind = words.whole()?;
            let mut tags = Vec::new();
            for _ in 0..words.count()? {
                tags.push(words.whole()?);
            }
            let Some((place, dimension)) = self.element(words, number, kind)? else {
                continue;
            };
            let group = tags.first().copied().filter(|group| *group != 0);
            let entity = tags.get(1).copied().unwrap_or(0);
            self.book(place, (dimension, entity), group.as_slice())?;
        }
        Ok(())
    }

    fn elements_of_4(&mut self, words: &mut Words) -> Result<(), String> {
        let blocks = words.count()?;
        for _ in 0..3 {
            words.whole()?;
        }
        for _ in 0..blocks {
            let key = (dimension(words)?, words.whole()?);
            let kind = words.whole()?;
            let groups = self.groups.get(&key).cloned().unwrap_or_default();
            for _ in 0..words.count()? {
                let number = words.id()?;
                if let Some((place, dimension)) = self.element(words, number, kind)? {
                    self.book(place, (dimension, key.1), &groups)?;
                }
            }
        }
        Ok(())
    }

    /// The nodes of an element; its place and dimension if it is a solid or of a plane.
    fn element(
        &mut self,
        words: &mut Words,
        number: u64,
        kind: i64,
    ) -> Result<Option<(u32, u8)>, String> {
        let (form, count) = form_of(kind)
            .ok_or_else(|| words.wrong(format!("elements of type {kind} are not read")))?;
        let mut nodes = [0; 27];
        let nodes = &mut nodes[..count];
        for node in &mut *nodes {
            *node = words.id()?;
        }
        let Some(form) = form else {
            return Ok(None);
        };
        let cell = Cell::new(form, number, nodes);
        let cell = cell.ok_or_else(|| words.wrong("an element has too few nodes"))?;
        let place = as_place(self.mesh.cells.len())?;
        self.mesh.cells.push(cell);
        let is_flat = matches!(form, Kind::Triangle | Kind::Quadrilateral);
        Ok(Some((place, if is_flat { 2 } else { 3 })))
    }

    fn book(&mut self, place: u32, entity: Key, groups: &[i64]) -> Result<(), String> {
        self.budget.take(groups.len(), ENTRY)?;
        for group in groups {
            let of_group = self.of_group.entry((entity.0, *group)).or_default();
            of_group.push(place);
        }
        if groups.is_empty() {
            self.of_entity.entry(entity).or_default().push(place);
        }
        Ok(())
    }

    /// Parts are the groups, of a mesh without any its entities.
    fn finished(mut self) -> Mesh {
        let parts = if self.of_group.is_empty() {
            std::mem::take(&mut self.of_entity)
        } else {
            std::mem::take(&mut self.of_group)
        };
        for ((dimension, number), cells) in parts {
            let name = self.names.get(&(dimension, number)).cloned();
            self.mesh.parts.push(Part {
                name: PartName {
                    number: Some(number),
                    name: name.unwrap_or_default(),
                },
                cells,
                ..Part::default()
            });
        }
        self.mesh
    }
}

fn dimension(words: &mut Words) -> Result<u8, String> {
    let word = words.next()?;
    let found = word.parse::<u8>().ok().filter(|d| *d <= 3);
    found.ok_or_else(|| words.wrong(format!("`{}` is no dimension", shortened(word))))
}

/// Form of a type of elements, nothing of points and lines, and number of its nodes.
fn form_of(kind: i64) -> Option<(Option<Kind>, usize)> {
    Some(match kind {
        15 => (None, 1),
        1 => (None, 2),
        8 => (None, 3),
        26 => (None, 4),
        2 => (Some(Kind::Triangle), 3),
        9 => (Some(Kind::Triangle), 6),
        3 => (Some(Kind::Quadrilateral), 4),
        16 => (Some(Kind::Quadrilateral), 8),
        10 => (Some(Kind::Quadrilateral), 9),
        4 => (Some(Kind::Tetrahedron), 4),
        11 => (Some(Kind::Tetrahedron), 10),
        7 => (Some(Kind::Pyramid), 5),
        19 => (Some(Kind::Pyramid), 13),
        14 => (Some(Kind::Pyramid), 14),
        6 => (Some(Kind::Wedge), 6),
        18 => (Some(Kind::Wedge), 15),
        13 => (Some(Kind::Wedge), 18),
        5 => (Some(Kind::Hexahedron), 8),
        17 => (Some(Kind::Hexahedron), 20),
        12 => (Some(Kind::Hexahedron), 27),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEW: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 5 \"the ball\"\n\
        $EndPhysicalNames\n$Entities\n0 0 1 1\n3 0 0 0 1 1 0 0 0\n7 0 0 0 1 1 1 1 5 1 3\n\
        $EndEntities\n$Nodes\n1 4 1 4\n3 7 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\
        $EndNodes\n$Elements\n2 2 1 2\n2 3 2 1\n1 1 2 3\n3 7 4 1\n2 1 2 3 4\n$EndElements\n";
    const OLD: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n\
        4 0 0 1\n$EndNodes\n$Elements\n2\n1 2 2 4 3 1 2 3\n2 4 2 5 7 1 2 3 4\n$EndElements\n";

    #[test]
    fn both_formats_are_read() {
        for text in [NEW, OLD] {
            let mesh = read(text.as_bytes()).unwrap();
            assert_eq!(mesh.nodes.len(), 4);
            assert_eq!(mesh.nodes[3], (4, [0.0, 0.0, 1.0]));
            assert_eq!(mesh.cells.len(), 2);
            let solid = mesh.parts.iter().find(|part| part.name.number == Some(5));
            assert_eq!(solid.unwrap().cells, [1]);
        }
        let mesh = read(NEW.as_bytes()).unwrap();
        assert_eq!(mesh.parts[0].name.name, "the ball");
    }

    #[test]
    fn what_cannot_be_read_is_told_with_its_line() {
        let of = |from: &str, to: &str| NEW.replacen(from, to, 1);
        for (text, said) in [
            (String::new(), "no Gmsh mesh"),
            ("solid".to_owned(), "no Gmsh mesh"),
            (
                of("4.1 0 8", "4.1 1 8"),
                "a binary Gmsh mesh: save it as ASCII",
            ),
            (of("4.1 0 8", "3 0 8"), "format 3 is not read"),
            (of("0 0 1 1", "0 0 1 1e9"), "`1e9` is no number of things"),
            (of("0 0 1 1", "0 0 1 99999999999"), "no number of things"),
            (of("0 1 0\n", "0 nan 0\n"), "line 22: `nan` is no number"),
            (
                of("3 7 4 1\n", "3 7 99 1\n"),
                "elements of type 99 are not read",
            ),
            (
                of("2 1 2 3 4\n", "2 1 2 3 0\n"),
                "line 30: `0` is no number of a node",
            ),
            (
                of("2 1 2 3 4\n$EndElements\n", "2 1 2"),
                "the file ends too early",
            ),
            (
                NEW.split("$Elements").next().unwrap().to_owned(),
                "no `$Elements`",
            ),
        ] {
            let words = read(text.as_bytes()).unwrap_err().words;
            assert!(words.contains(said), "{said}: {words}");
        }
    }
}
