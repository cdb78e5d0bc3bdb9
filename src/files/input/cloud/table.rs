//! Particles in rows: what every format comes down to.

use super::Fault;
use crate::input::source::nearest;
use model::Quantity;

/// Names of the columns of a file, where the input states them.
#[derive(Debug, Default, Clone)]
pub struct Columns {
    /// Names of the components, or one of all, of quantities.
    pub of: Vec<(Quantity, Vec<String>)>,
    /// Of the parts.
    pub part: Option<String>,
}

impl Columns {
    /// The names that the input states for a quantity.
    pub fn stated(&self, quantity: Quantity) -> Option<&[String]> {
        let mut of = self.of.iter();
        of.find(|(stated, _)| *stated == quantity)
            .map(|(_, names)| names.as_slice())
    }

    /// Names of an array that holds parts, the likely first.
    pub fn part_names(&self) -> Vec<&str> {
        match &self.part {
            Some(name) => vec![name],
            // In files of this program parts are pieces of bodies.
            None => vec!["body", "part", "part_id", "PartId"],
        }
    }
}

/// That a column or an array which the input names is not there.
pub fn no_column(what: &str, name: &str, there: &[&str]) -> Fault {
    let guess = match nearest(name, there) {
        Some(other) => format!("; did you mean `{other}`?"),
        None => String::new(),
    };
    Fault::of("columns", format!("it has no {what} `{name}`{guess}"))
}

/// Particles: quantities, each of as many rows, row after row, in SI units.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Table {
    /// The first is the position.
    pub columns: Vec<(Quantity, Vec<f64>)>,
}

impl Table {
    /// Takes a quantity out.
    pub fn take(&mut self, quantity: Quantity) -> Option<Vec<f64>> {
        let at = self
            .columns
            .iter()
            .position(|(held, _)| *held == quantity)?;
        Some(self.columns.remove(at).1)
    }

    /// The values of a quantity, if they are told.
    pub fn get(&self, quantity: Quantity) -> Option<&[f64]> {
        let mut columns = self.columns.iter();
        let found = columns.find(|(held, _)| *held == quantity);
        found.map(|(_, values)| values.as_slice())
    }

    /// Leaves the rows that are kept.
    pub fn keep(&mut self, kept: &[bool]) {
        for (quantity, values) in &mut self.columns {
            let n = quantity.components();
            let mut place = 0;
            values.retain(|_| {
                place += 1;
                kept.get((place - 1) / n).copied().unwrap_or(false)
            });
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        let first = self.columns.first();
        first.map_or(0, |(quantity, values)| values.len() / quantity.components())
    }

    /// True if all is there, finite and in range.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self, dimension: usize) -> Result<(), Fault> {
        let rows = self.rows();
        if rows == 0 {
            return Err("it has no particles".into());
        }
        if rows > super::MOST {
            return Err(format!("it has {rows} particles, more than {}", super::MOST).into());
        }
        for (quantity, values) in &self.columns {
            let n = quantity.components();
            if values.len() != rows * n {
                let found = values.len() / n;
                let name = quantity.name();
                return Err(format!("{rows} particles but {found} rows of `{name}`").into());
            }
            let is_bad = |row: &&[f64]| !row.iter().all(|x| is_sound(*quantity, *x));
            if let Some(bad) = values.chunks_exact(n).position(|row| is_bad(&row)) {
                let (name, value) = (quantity.name(), &values[bad * n..(bad + 1) * n]);
                return Err(format!(
                    "the {name} of particle {} of {rows} is {value:?} in SI units, {}",
                    bad + 1,
                    range(*quantity)
                )
                .into());
            }
        }
        self.is_flat(dimension)
    }

    /// Coordinates beyond the dimension of the case must be the same for all.
    fn is_flat(&self, dimension: usize) -> Result<(), Fault> {
        let Some((Quantity::Position, positions)) = self.columns.first() else {
            return Err("it has no places".into());
        };
        let (points, _) = positions.as_chunks::<3>();
        let ends = |a: usize| {
            let along = points.iter().map(|x| x[a]);
            along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            })
        };
        let ends = [0, 1, 2].map(ends);
        let size = ends
            .iter()
            .fold(0.0, |most: f64, [low, high]| most.max(high - low));
        let is_thick = |a: &usize| ends[*a][1] - ends[*a][0] > 1e-9 * size;
        if let Some(axis) = (dimension..3).find(is_thick) {
            let axis = ["x", "y", "z"][axis];
            return Err(format!(
                "its particles differ in {axis}, which a {dimension}-dimensional case has not"
            )
            .into());
        }
        Ok(())
    }
}

/// True if nature knows a value (SI).
fn is_sound(quantity: Quantity, x: f64) -> bool {
    x.is_finite()
        && match quantity {
            Quantity::Mass | Quantity::Volume | Quantity::Density => x > 0.0 && x < 1e30,
            Quantity::Temperature => x > 0.0 && x < 1e9,
            Quantity::PlasticStrain | Quantity::Damage | Quantity::FailureEnergy => {
                (0.0..9e16).contains(&x)
            }
            Quantity::Compaction | Quantity::Burn => (0.0..=1.0).contains(&x),
            Quantity::Velocity => x.abs() < 1.7e8,
            Quantity::Position | Quantity::HourglassDisplacement => x.abs() < 1e9,
            Quantity::SpecificEnergy => x.abs() < 9e16,
            Quantity::DeviatoricStress => x.abs() < 1e17,
        }
}

fn range(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Mass | Quantity::Volume | Quantity::Density | Quantity::Temperature => {
            "and must be a positive number that nature knows"
        }
        Quantity::Compaction | Quantity::Burn => "and must be between 0 and 1",
        _ => "and must be a number that nature knows",
    }
}
