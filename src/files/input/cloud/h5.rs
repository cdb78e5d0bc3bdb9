//! Arrays of any HDF5 file: a row for each particle.

use std::path::Path;

use super::arrays::{Array, with_arrays};
use super::names::of_array;
use super::text::shortened;
use super::{Fault, Request, Table};
use crate::output::h5::arrays::ArrayFile;
use model::Quantity;

/// Reads the arrays that the input names, and those of the first group with the default names.
///
/// # Errors
/// A fault of the file, or of what is asked of it.
pub fn read(path: &Path, request: &Request) -> Result<Table, Fault> {
    let file = ArrayFile::open(path).map_err(|cause| cause.to_string())?;
    let mut arrays = Vec::new();
    for name in wanted(&file.names()?, request)? {
        let (components, values) = file
            .values(&name)
            .map_err(|what| format!("its array `{}`: {what}", shortened(&name)))?;
        arrays.push(Array {
            name,
            components,
            values,
        });
    }
    let is_position = |array: &Array| match request.columns.stated(Quantity::Position) {
        Some(names) => names.contains(&array.name),
        None => of_array(Quantity::Position).contains(&array.name.as_str()),
    };
    let Some(position) = arrays.iter().position(is_position) else {
        let help = "name it in `columns`, as in `columns.position = \"/group/x\"`";
        return Err(format!("it has no array `position`: {help}").into());
    };
    let positions = positions(&arrays.swap_remove(position), request)?;
    let rows: Vec<usize> = (0..positions.len() / 3).collect();
    for array in &arrays {
        if array.values.len() != rows.len() * array.components {
            let (name, found) = (
                shortened(&array.name),
                array.values.len() / array.components,
            );
            return Err(format!("its array `{name}` has {found} rows of {}", rows.len()).into());
        }
    }
    let columns = vec![(Quantity::Position, positions)];
    with_arrays(Table { columns }, &arrays, &rows, request)
}

/// Names of the arrays that are read, of those that are there.
fn wanted(there: &[String], request: &Request) -> Result<Vec<String>, Fault> {
    let default = |names: &[&str]| -> Vec<String> {
        let found = names.iter().filter(|name| has(there, name));
        found.map(|name| (*name).to_owned()).collect()
    };
    let mut wanted = Vec::new();
    for &quantity in Quantity::ALL {
        match request.columns.stated(quantity) {
            Some([name]) => wanted.push(name.clone()),
            Some(_) => return Err(Fault::of("columns", "an array has one name")),
            None => wanted.extend(default(of_array(quantity))),
        }
    }
    match &request.columns.part {
        Some(name) => wanted.push(name.clone()),
        None => wanted.extend(default(&request.columns.part_names())),
    }
    Ok(wanted)
}

/// Positions (m) of three components.
fn positions(array: &Array, request: &Request) -> Result<Vec<f64>, Fault> {
    let n = array.components;
    if !(request.dimension..=3).contains(&n) {
        return Err(format!("its positions have {n} components").into());
    }
    let metre = request.units.metre()?;
    let mut positions = Vec::with_capacity(array.values.len() / n * 3);
    for row in array.values.chunks_exact(n) {
        let x = |a: usize| row.get(a).map_or(0.0, |x| x * metre);
        positions.extend([x(0), x(1), x(2)]);
    }
    Ok(positions)
}

fn has(there: &[String], name: &str) -> bool {
    there.iter().any(|known| known == name)
}
