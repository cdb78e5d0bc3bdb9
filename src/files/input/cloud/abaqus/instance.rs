//! Parts in their places in an assembly.

use crate::input::cloud::Fault;
use crate::input::cloud::budget::Budget;
use crate::input::cloud::mesh::{Cell, Mesh, Part, as_place};
use crate::input::cloud::part::PartName;
use model::{Vec3, rotation};

/// A part in its place.
#[derive(Debug)]
pub struct Instance {
    pub name: String,
    pub part: String,
    pub shift: Vec3,
    /// Two points of an axis and an angle (rad).
    pub turn: Option<(Vec3, Vec3, f64)>,
    /// Lines of its place that were read.
    pub lines: usize,
}

impl Instance {
    /// A part of a name where it was written.
    pub fn new(name: &str, part: &str) -> Self {
        Self {
            name: name.to_owned(),
            part: part.to_owned(),
            shift: Vec3::zeros(),
            turn: None,
            lines: 0,
        }
    }

    /// Adds a part in its place, with numbers of nodes beyond `first`; gives the last number.
    ///
    /// # Errors
    /// If that is more than may be numbered, or than a file of its length may take.
    pub fn add(
        &self,
        part: &Mesh,
        first: u64,
        all: &mut Mesh,
        budget: &mut Budget,
    ) -> Result<u64, Fault> {
        // Lists have room for twice as much when they grow.
        budget.take(part.nodes.len(), 2 * size_of::<(u64, [f64; 3])>())?;
        budget.take(part.cells.len(), 2 * size_of::<Cell>() + size_of::<u32>())?;
        for set in &part.parts {
            budget.take(set.cells.len(), size_of::<u32>())?;
            let name = self.name.len() + set.name.name.len();
            budget.take(1, 2 * size_of::<Part>() + name)?;
        }
        let mut last = first;
        let mut beyond = |number: u64| {
            let number = first
                .checked_add(number)
                .ok_or("a number of a node is too large")?;
            last = last.max(number);
            Ok::<u64, Fault>(number)
        };
        let turn = self
            .turn
            .map(|(a, b, angle)| (a, rotation(&(b - a), angle)));
        for (number, x) in &part.nodes {
            let moved = Vec3::from(*x) + self.shift;
            let moved = turn.map_or(moved, |(about, turn)| about + turn * (moved - about));
            all.nodes.push((beyond(*number)?, moved.into()));
        }
        let before = as_place(all.cells.len())?;
        as_place(all.cells.len() + part.cells.len())?;
        for cell in &part.cells {
            let mut cell = *cell;
            for corner in &mut cell.corners[..cell.kind.corners()] {
                *corner = beyond(*corner)?;
            }
            all.cells.push(cell);
        }
        let cells = || (0..part.cells.len()).zip(before..).map(|(_, place)| place);
        let named = |name: String, cells: Vec<u32>, is_set: bool| Part {
            name: PartName { number: None, name },
            cells,
            is_set,
            ..Part::default()
        };
        all.parts
            .push(named(self.name.clone(), cells().collect(), false));
        for set in &part.parts {
            let cells = set.cells.iter().map(|place| before + place).collect();
            let name = format!("{}.{}", self.name, set.name.name);
            all.parts.push(named(name, cells, true));
        }
        Ok(last)
    }
}
