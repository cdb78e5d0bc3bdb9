//! Arrays of any HDF5 file: a row for each particle.

use std::path::Path;

use super::arrays::{Array, with_arrays};
use super::names::of_array;
use super::text::shortened;
use super::{Fault, Request, Table};
use crate::model::Quantity;
use crate::output::h5::arrays::ArrayFile;

/// Reads the arrays that the input names, and those of the first group that are called as usual.
///
/// # Errors
/// What is wrong with the file, or with what is asked of it.
pub fn read(path: &Path, request: &Request) -> Result<Table, Fault> {
    let file = ArrayFile::open(path).map_err(|cause| cause.to_string())?;
    let there = file.names()?;
    let mut wanted: Vec<&str> = Vec::new();
    for &quantity in Quantity::ALL {
        match request.columns.stated(quantity) {
            Some(names) => wanted.extend(names.iter().map(String::as_str)),
            None => wanted.extend(of_array(quantity).iter().filter(|name| has(&there, name))),
        }
    }
    match &request.columns.part {
        Some(name) => wanted.push(name),
        None => wanted.extend(
            request
                .columns
                .part_names()
                .iter()
                .filter(|name| has(&there, name)),
        ),
    }
    let mut arrays = Vec::new();
    for name in wanted {
        let (components, values) = file
            .values(name)
            .map_err(|what| format!("its array `{}`: {what}", shortened(name)))?;
        arrays.push(Array {
            name: name.to_owned(),
            components,
            values,
        });
    }
    let position = match request.columns.stated(Quantity::Position) {
        Some([name]) => arrays.iter().position(|array| array.name == *name),
        Some(_) => return Err(Fault::of("columns", "an array has one name")),
        None => arrays
            .iter()
            .position(|array| of_array(Quantity::Position).contains(&array.name.as_str())),
    };
    let Some(position) = position else {
        let help = "name it in `columns`, as in `columns.position = \"/group/x\"`";
        return Err(format!("it has no array `position`: {help}").into());
    };
    let Array {
        components, values, ..
    } = arrays.swap_remove(position);
    if !(request.dimension..=3).contains(&components) {
        return Err(format!("its positions have {components} components").into());
    }
    let metre = request.units.metre()?;
    let mut positions = Vec::with_capacity(values.len() / components * 3);
    for row in values.chunks_exact(components) {
        let x = |a: usize| row.get(a).map_or(0.0, |x| x * metre);
        positions.extend([x(0), x(1), x(2)]);
    }
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

fn has(there: &[String], name: &str) -> bool {
    there.iter().any(|known| known == name)
}
