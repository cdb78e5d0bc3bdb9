//! Nodes and elements of a mesh, and the particles that are made of them.

#[cfg(test)]
mod tests;

use super::part::{PartName, choose};
use super::table::Table;
use super::{Fault, Request, TakeName};
use model::{Quantity, Vec3};

/// An element with less of its size to this power is flat.
const FLAT: f64 = 1e-12;

/// Corners of an element at most.
pub const CORNERS: usize = 8;

/// Forms of elements, by their corners; what has nodes on its edges too is taken for straight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Of a plane.
    Triangle,
    /// Of a plane.
    Quadrilateral,
    /// Four corners.
    Tetrahedron,
    /// Four corners and a tip.
    Pyramid,
    /// Two triangles.
    Wedge,
    /// Two quadrilaterals.
    Hexahedron,
}

impl Kind {
    /// Number of its corners.
    pub fn corners(self) -> usize {
        match self {
            Self::Triangle => 3,
            Self::Quadrilateral | Self::Tetrahedron => 4,
            Self::Pyramid => 5,
            Self::Wedge => 6,
            Self::Hexahedron => 8,
        }
    }

    fn dimension(self) -> usize {
        match self {
            Self::Triangle | Self::Quadrilateral => 2,
            _ => 3,
        }
    }

    /// Its faces by the numbers of their corners, all seen from one side; of a plane itself.
    fn faces(self) -> &'static [&'static [usize]] {
        match self {
            Self::Triangle => &[&[0, 1, 2]],
            Self::Quadrilateral => &[&[0, 1, 2, 3]],
            Self::Tetrahedron => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
            Self::Pyramid => &[
                &[0, 3, 2, 1],
                &[0, 1, 4],
                &[1, 2, 4],
                &[2, 3, 4],
                &[3, 0, 4],
            ],
            Self::Wedge => &[
                &[0, 2, 1],
                &[3, 4, 5],
                &[0, 1, 4, 3],
                &[1, 2, 5, 4],
                &[2, 0, 3, 5],
            ],
            Self::Hexahedron => &[
                &[0, 3, 2, 1],
                &[4, 5, 6, 7],
                &[0, 1, 5, 4],
                &[1, 2, 6, 5],
                &[2, 3, 7, 6],
                &[3, 0, 4, 7],
            ],
        }
    }
}

/// An element with the numbers of its nodes.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// Form.
    pub kind: Kind,
    /// Its number in the file.
    pub number: u64,
    /// Numbers of its nodes; the rest is zero.
    pub corners: [u64; CORNERS],
}

impl Cell {
    /// Of the first corners of a list of nodes.
    pub fn new(kind: Kind, number: u64, nodes: &[u64]) -> Option<Self> {
        let mut corners = [0; CORNERS];
        let own = nodes.get(..kind.corners())?;
        corners[..own.len()].copy_from_slice(own);
        Some(Self {
            kind,
            number,
            corners,
        })
    }
}

/// A node that is a particle: its mass, or minus its volume, in units of the file.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Number of the node.
    pub node: u64,
    /// Mass, or minus its volume.
    pub mass: f64,
}

/// A part with the places of its elements and particles in [`Mesh`].
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// Its name.
    pub name: PartName,
    /// Elements.
    pub cells: Vec<u32>,
    /// Particles.
    pub points: Vec<u32>,
    /// True if it is a set of what belongs to other parts too: nothing that a file is divided into.
    pub is_set: bool,
}

/// A mesh in units of its file.
#[derive(Debug, Default)]
pub struct Mesh {
    /// Numbers and places of nodes.
    pub nodes: Vec<(u64, [f64; 3])>,
    /// Elements.
    pub cells: Vec<Cell>,
    /// Nodes that are particles.
    pub points: Vec<Point>,
    /// Parts.
    pub parts: Vec<Part>,
}

/// Particles of a mesh in units of its file.
#[derive(Debug, Default)]
pub struct Picked {
    /// Places.
    pub positions: Vec<[f64; 3]>,
    /// Volumes, or areas in two dimensions.
    pub volumes: Vec<f64>,
    /// Elements or nodes that they are, by their place in the mesh.
    pub of: Vec<usize>,
}

/// The place of something, if it can be numbered.
pub fn as_place(place: usize) -> Result<u32, String> {
    u32::try_from(place).map_err(|_| "it has too many elements".to_owned())
}

impl Mesh {
    /// The particles of a mesh.
    ///
    /// # Errors
    /// A fault of the mesh, or of what is asked of it.
    pub fn table(mut self, request: &Request) -> Result<Table, Fault> {
        self.sort_nodes()?;
        let (cells, points) = self.chosen(request)?;
        let metre = request.units.metre()?;
        if points.is_empty() {
            let picked = self.picked(&cells, request)?;
            return Ok(picked.table(metre, request.dimension));
        }
        if !cells.is_empty() {
            return Err("the part has particles and elements: name parts of either".into());
        }
        self.particles(&points, request)
    }

    /// Sorts nodes by their numbers, of which each must be there once.
    ///
    /// # Errors
    /// If one is there twice.
    pub fn sort_nodes(&mut self) -> Result<(), Fault> {
        self.nodes.sort_by_key(|(number, _)| *number);
        let twice = self.nodes.windows(2).find(|pair| pair[0].0 == pair[1].0);
        match twice {
            Some(pair) => Err(format!("two nodes have the number {}", pair[0].0).into()),
            None => Ok(()),
        }
    }

    /// Elements of the dimension of the case and particles, of the parts that are wanted.
    ///
    /// # Errors
    /// If there are none, or none such part.
    pub fn chosen(&self, request: &Request) -> Result<(Vec<usize>, Vec<usize>), Fault> {
        let fits = |cell: usize| self.cells[cell].kind.dimension() == request.dimension;
        let has_any = |part: &&Part| {
            !part.points.is_empty() || part.cells.iter().any(|&cell| fits(cell as usize))
        };
        let parts: Vec<&Part> = self.parts.iter().filter(has_any).collect();
        let (mut cells, mut points): (Vec<usize>, Vec<usize>);
        if request.parts.is_empty() {
            let whole = parts.iter().filter(|part| !part.is_set);
            let names: Vec<PartName> = whole.map(|part| part.name.clone()).collect();
            choose(&names, &[])?;
            (cells, points) = (
                (0..self.cells.len()).collect(),
                (0..self.points.len()).collect(),
            );
        } else {
            let names: Vec<PartName> = parts.iter().map(|part| part.name.clone()).collect();
            let wanted = choose(&names, &request.parts)?;
            let wanted = parts.iter().zip(&wanted).filter(|(_, wanted)| **wanted);
            let wanted: Vec<&&Part> = wanted.map(|(part, _)| part).collect();
            let each = |of: fn(&Part) -> &Vec<u32>| {
                let all = wanted.iter().flat_map(|part| of(part).iter());
                let mut all: Vec<usize> = all.map(|&place| place as usize).collect();
                all.sort_unstable();
                all.dedup();
                all
            };
            (cells, points) = (each(|part| &part.cells), each(|part| &part.points));
        }
        cells.retain(|&cell| fits(cell));
        if cells.is_empty() && points.is_empty() {
            let d = request.dimension;
            return Err(format!("it has no elements of {d} dimensions and no particles").into());
        }
        points.shrink_to_fit();
        Ok((cells, points))
    }

    /// Particles of some elements, or of the nodes about them.
    ///
    /// # Errors
    /// If an element has no volume, or a node that is not there.
    pub fn picked(&self, cells: &[usize], request: &Request) -> Result<Picked, Fault> {
        let mut picked = Picked::default();
        let mut lumped = match request.take {
            TakeName::Nodes => vec![0.0; self.nodes.len()],
            TakeName::Elements => Vec::new(),
        };
        for &place in cells {
            let cell = &self.cells[place];
            let corners = &cell.corners[..cell.kind.corners()];
            let mut nodes = [0; CORNERS];
            for (node, number) in nodes.iter_mut().zip(corners) {
                *node = self.node(*number, "element", cell.number)?;
            }
            let nodes = &nodes[..corners.len()];
            let mut x = [[0.0; 3]; CORNERS];
            for (x, node) in x.iter_mut().zip(nodes) {
                *x = self.nodes[*node].1;
            }
            let Some((volume, middle)) = measure(cell.kind, &x[..corners.len()]) else {
                return Err(format!("element {} has no volume", cell.number).into());
            };
            if request.take == TakeName::Elements {
                picked.positions.push(middle);
                picked.volumes.push(volume);
                picked.of.push(place);
                continue;
            }
            // An element may name a node several times to have fewer corners.
            let is_first = |k: &usize| !nodes[..*k].contains(&nodes[*k]);
            let distinct = (0..nodes.len()).filter(is_first);
            #[allow(clippy::cast_precision_loss)] // eight at most
            let share = volume / distinct.clone().count() as f64;
            for k in distinct {
                lumped[nodes[k]] += share;
            }
        }
        for (node, volume) in lumped.into_iter().enumerate() {
            if volume > 0.0 {
                picked.positions.push(self.nodes[node].1);
                picked.volumes.push(volume);
                picked.of.push(node);
            }
        }
        Ok(picked)
    }

    /// Nodes that are particles.
    fn particles(&self, points: &[usize], request: &Request) -> Result<Table, Fault> {
        let metre = request.units.metre()?;
        let has_mass = points.iter().all(|&p| self.points[p].mass > 0.0);
        let has_volume = points.iter().all(|&p| self.points[p].mass < 0.0);
        let (quantity, sign) = match (has_mass, has_volume) {
            (true, _) => (Quantity::Mass, 1.0),
            (_, true) => (Quantity::Volume, -1.0),
            _ => return Err("some of its particles have no mass".into()),
        };
        let unit = sign * request.units.factor(quantity, request.dimension)?;
        let (mut positions, mut masses) = (Vec::new(), Vec::new());
        for &p in points {
            let Point { node, mass } = self.points[p];
            let node = self.node(node, "particle", node)?;
            positions.extend(self.nodes[node].1.map(|x| x * metre));
            masses.push(mass * unit);
        }
        let columns = vec![(Quantity::Position, positions), (quantity, masses)];
        Ok(Table { columns })
    }

    /// The place of a node, whose number one of something names, in sorted nodes.
    ///
    /// # Errors
    /// If it is not there.
    pub fn node(&self, number: u64, what: &str, of: u64) -> Result<usize, Fault> {
        let found = self.nodes.binary_search_by_key(&number, |(n, _)| *n);
        found.map_err(|_| format!("{what} {of} names a node {number} that is not there").into())
    }
}

impl Picked {
    /// Their table, for so many metres of a unit.
    pub fn table(&self, metre: f64, dimension: usize) -> Table {
        let cube = (1..dimension).fold(metre, |cube, _| cube * metre);
        let positions = self.positions.iter().flat_map(|x| x.map(|x| x * metre));
        let volumes = self.volumes.iter().map(|volume| volume * cube);
        Table {
            columns: vec![
                (Quantity::Position, positions.collect()),
                (Quantity::Volume, volumes.collect()),
            ],
        }
    }
}

/// Volume and middle of an element, or area and middle of one in a plane; nothing of a flat one.
///
/// Faces are fans about their middles, so that elements that share one share its surface.
fn measure(kind: Kind, corners: &[[f64; 3]]) -> Option<(f64, [f64; 3])> {
    let at = |k: usize| Vec3::from(corners[k]);
    #[allow(clippy::cast_precision_loss)] // eight at most
    let mean = |of: &[usize]| of.iter().fold(Vec3::zeros(), |s, &k| s + at(k)) / of.len() as f64;
    let all: Vec<usize> = (0..corners.len()).collect();
    let centre = mean(&all);
    let size = all
        .iter()
        .fold(0.0, |most: f64, &k| most.max((at(k) - centre).amax()));
    let is_flat = kind.dimension() == 2;
    let (mut volume, mut moment) = (0.0, Vec3::zeros());
    for face in kind.faces() {
        let middle = mean(face);
        for k in 0..face.len() {
            let [a, b] = [face[k], face[(k + 1) % face.len()]].map(|k| at(k) - centre);
            let c = middle - centre;
            let (piece, arm) = if is_flat {
                // The triangle of an edge and the centre.
                (0.5 * (a.x * b.y - a.y * b.x), (a + b) / 3.0)
            } else {
                (a.cross(&b).dot(&c) / 6.0, (a + b + c) / 4.0)
            };
            volume += piece;
            moment += arm * piece;
        }
    }
    let least = FLAT * (0..kind.dimension()).fold(1.0, |v, _| v * size);
    if !(volume.abs() > least && volume.is_finite()) {
        return None;
    }
    let middle = centre + moment / volume;
    Some((volume.abs(), middle.into()))
}
