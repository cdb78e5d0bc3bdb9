//! Tables of fragments: `fragments.csv`, a row for each time, and one of all fragments at a time.

use std::path::Path;

use super::{Column, OutputError, Table, Value, binary_table, unit_of_model};
use engine::fragments::{Census, Fragment};

/// The columns of `fragments.csv` in a model of `dimension` dimensions.
#[must_use]
pub fn columns(dimension: usize) -> Vec<Column> {
    let column = |(name, unit): (&str, &str)| Column::new(name, unit_of_model(unit, dimension));
    let known = [
        ("step", ""),
        ("time", "s"),
        ("fragments", ""),
        ("largest_label", ""),
        ("largest_particles", ""),
        ("largest_mass", "kg"),
        ("largest_diameter", "m"),
        ("fragment_mass", "kg"),
        ("dust_particles", ""),
        ("dust_mass", "kg"),
        ("failed_mass", "kg"),
        ("total_mass", "kg"),
    ];
    known.map(column).to_vec()
}

/// The row of `fragments.csv` at a step and a time (s).
#[must_use]
pub fn row(step: u64, time: f64, census: &Census) -> Vec<Value<'static>> {
    let largest = census.fragments.first();
    let count = |value: Option<u64>| value.map_or(Value::Word(""), Value::Count);
    vec![
        Value::Count(step),
        Value::Real(time),
        Value::Count(census.count()),
        count(largest.map(|f| f.label)),
        count(largest.map(|f| f.particles)),
        Value::Real(largest.map_or(0.0, |f| f.mass)),
        Value::Real(largest.map_or(0.0, Fragment::diameter)),
        Value::Real(census.in_fragments.mass),
        Value::Count(census.dust.particles),
        Value::Real(census.dust.mass),
        Value::Real(census.excluded.mass),
        Value::Real(census.total.mass),
    ]
}

/// The table of all fragments of a model: the heaviest first.
#[derive(Debug)]
pub struct FragmentTable {
    columns: Vec<Column>,
    rows: Vec<Vec<Value<'static>>>,
}

impl FragmentTable {
    /// Of a model with some bodies.
    #[must_use]
    pub fn new(census: &Census, bodies: &[&str], dimension: usize) -> Self {
        let by_size = ranks_by_size(&census.fragments);
        let mut before = 0;
        let rows = census.fragments.iter().zip(by_size);
        let rows = rows.map(|(fragment, by_size)| {
            before += fragment.copies;
            cells(fragment, [before, by_size])
        });
        Self {
            rows: rows.collect(),
            columns: columns_of_all(bodies, dimension),
        }
    }

    /// The content of its text file.
    #[must_use]
    pub fn text(&self) -> Vec<u8> {
        Table::whole(&self.columns, &self.rows)
    }

    /// Writes it as HDF5, with the columns of the text.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Hdf5`].
    pub fn write_hdf5(&self, path: &Path) -> Result<(), OutputError> {
        let cells = binary_table::by_column(self.columns.len(), self.rows.iter().cloned());
        binary_table::write(path, &self.columns, &cells, &[])
    }
}

fn columns_of_all(bodies: &[&str], dimension: usize) -> Vec<Column> {
    let mut all = Vec::new();
    let mut add = |name: &str, unit: &str| {
        all.push(Column::new(name, unit_of_model(unit, dimension)));
    };
    for (name, unit) in [
        ("label", ""),
        ("copies", ""),
        ("particles", ""),
        ("mass", "kg"),
    ] {
        add(name, unit);
    }
    for (name, unit) in [("centre", "m"), ("velocity", "m/s"), ("spin", "rad/s")] {
        for axis in ["x", "y", "z"] {
            add(&format!("{name}_{axis}"), unit);
        }
    }
    add("diameter", "m");
    for k in 1..=3 {
        add(&format!("size_{k}"), "m");
    }
    for (name, unit) in [
        ("temperature", "K"),
        ("plastic_strain", ""),
        ("number_by_mass", ""),
        ("number_by_size", ""),
    ] {
        add(name, unit);
    }
    for body in bodies {
        add(&format!("mass_{body}"), "kg");
    }
    all
}

fn cells(fragment: &Fragment, numbers: [u64; 2]) -> Vec<Value<'static>> {
    let counts = [fragment.label, fragment.copies, fragment.particles];
    let mut row: Vec<Value> = counts.map(Value::Count).to_vec();
    row.push(Value::Real(fragment.mass));
    for vector in [&fragment.centre, &fragment.velocity, &fragment.spin] {
        row.extend(vector.map(Value::Real));
    }
    row.push(Value::Real(fragment.diameter()));
    row.extend(fragment.sizes.map(Value::Real));
    row.push(Value::Real(fragment.temperature));
    row.push(Value::Real(fragment.plastic_strain));
    row.extend(numbers.map(Value::Count));
    row.extend(fragment.mass_of.iter().copied().map(Value::Real));
    row
}

/// Number of fragments at least as large as each, itself included, by diameter.
fn ranks_by_size(fragments: &[Fragment]) -> Vec<u64> {
    let mut order: Vec<usize> = (0..fragments.len()).collect();
    let diameters: Vec<f64> = fragments.iter().map(Fragment::diameter).collect();
    order.sort_by(|&a, &b| diameters[b].total_cmp(&diameters[a]).then(a.cmp(&b)));
    let mut ranks = vec![0; fragments.len()];
    let mut count = 0;
    for k in order {
        count += fragments[k].copies;
        ranks[k] = count;
    }
    ranks
}
