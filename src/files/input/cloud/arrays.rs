//! Arrays of numbers that files tell of particles, by their names.

use super::names::{from_vtk, of_array};
use super::part::{PartName, choose};
use super::table::no_column;
use super::text::shortened;
use super::{Fault, Request, Table};
use model::Quantity;

/// An array with its name.
#[derive(Debug, Clone)]
pub struct Array {
    /// Its name.
    pub name: String,
    /// Numbers in a row.
    pub components: usize,
    /// Row after row.
    pub values: Vec<f64>,
}

/// Names that arrays must have to be read.
pub fn asked(request: &Request) -> Vec<&str> {
    let of = |&quantity: &Quantity| -> Vec<&str> {
        match request.columns.stated(quantity) {
            Some(names) => names.iter().map(String::as_str).collect(),
            None => of_array(quantity).to_vec(),
        }
    };
    let mut names: Vec<&str> = Quantity::ALL.iter().flat_map(of).collect();
    names.extend(request.columns.part_names());
    names
}

/// Adds what arrays tell to the rows of a table, and leaves those of the parts that are wanted.
pub fn with_arrays(
    mut table: Table,
    arrays: &[Array],
    rows: &[usize],
    request: &Request,
) -> Result<Table, Fault> {
    let there: Vec<&str> = arrays.iter().map(|array| array.name.as_str()).collect();
    let find = |name: &str| arrays.iter().find(|array| array.name == name);
    for &quantity in Quantity::ALL {
        let is_known = table.columns.iter().any(|(held, _)| *held == quantity);
        if is_known {
            continue;
        }
        let array = match request.columns.stated(quantity) {
            Some([name]) => Some(find(name).ok_or_else(|| no_column("array", name, &there))?),
            Some(_) => return Err(Fault::of("columns", "an array has one name")),
            None => of_array(quantity).iter().find_map(|name| find(name)),
        };
        let Some(array) = array else {
            continue;
        };
        let n = quantity.components();
        if array.components != n {
            let (name, found) = (shortened(&array.name), array.components);
            return Err(format!("its array `{name}` has {found} components, not {n}").into());
        }
        let factor = request.units.factor(quantity, request.dimension)?;
        let of_row = |&row: &usize| array.values[row * n..(row + 1) * n].iter();
        let mut values: Vec<f64> = rows.iter().flat_map(of_row).map(|x| x * factor).collect();
        from_vtk(quantity, &mut values);
        table.columns.push((quantity, values));
    }
    let names = request.columns.part_names();
    let part = names
        .iter()
        .find_map(|name| find(name))
        .filter(|array| array.components == 1);
    if let (None, Some(name)) = (part, &request.columns.part) {
        return Err(no_column("array", name, &there));
    }
    let of_row = part.map(|array| {
        rows.iter()
            .map(|&row| array.values[row])
            .collect::<Vec<f64>>()
    });
    keep_parts(&mut table, of_row.as_deref(), request)?;
    Ok(table)
}

/// Leaves the rows of parts that are wanted, given the number of the part of each.
fn keep_parts(table: &mut Table, of_row: Option<&[f64]>, request: &Request) -> Result<(), Fault> {
    let mut numbers: Vec<f64> = of_row.unwrap_or_default().to_vec();
    numbers.sort_unstable_by(f64::total_cmp);
    numbers.dedup();
    if numbers
        .iter()
        .any(|number| number.fract() != 0.0 || number.abs() > 9e15)
    {
        return Err("the number of a part is no whole number".into());
    }
    #[allow(clippy::cast_possible_truncation)] // as checked
    let name = |number: &f64| PartName {
        number: Some(*number as i64),
        name: String::new(),
    };
    let names: Vec<PartName> = numbers.iter().map(name).collect();
    let wanted = choose(&names, &request.parts)?;
    if let Some(of_row) = of_row {
        let place = |number: &f64| numbers.binary_search_by(|other| other.total_cmp(number));
        let kept = of_row
            .iter()
            .map(|number| place(number).is_ok_and(|place| wanted[place]));
        table.keep(&kept.collect::<Vec<bool>>());
    }
    Ok(())
}
