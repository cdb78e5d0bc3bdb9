//! Columns of words that tell quantities of particles: of tables, dumps and the like.

use std::collections::BTreeMap;

use super::names::of_column;
use super::part::{MOST_PARTS, PartName, choose};
use super::table::no_column;
use super::text::{number, shortened};
use super::{Fault, Request, Table};
use model::Quantity;
use model::units;

/// Most columns.
pub const MOST_COLUMNS: usize = 10_000;

/// A column that is read: its place in the rows, of which quantity and component it is, and one of
/// its unit in SI units.
struct Column {
    place: usize,
    quantity: Quantity,
    component: usize,
    factor: f64,
}

/// The head of a table.
#[derive(Debug, Default)]
pub struct Head {
    /// Names of its columns.
    pub names: Vec<String>,
    /// Their units, as far as the file tells them.
    pub units: Vec<Option<String>>,
}

/// The rows of a table, one after the other.
pub struct Rows<'a> {
    request: &'a Request,
    columns: Vec<Column>,
    /// The column that names parts.
    part: Option<usize>,
    parts: Parts,
    table: Table,
}

impl<'a> Rows<'a> {
    /// No rows yet, of the columns of a head; parts may stand in columns of other names, which go before the usual ones.
    ///
    /// # Errors
    /// If columns are missing, or have units of other quantities.
    pub fn of(head: &Head, request: &'a Request, parts: &[&str]) -> Result<Self, Fault> {
        let columns = columns(head, request)?;
        Ok(Self {
            request,
            part: part_column(head, request, parts)?,
            parts: Parts::default(),
            table: empty(&columns),
            columns,
        })
    }

    /// Adds a row, by the word of each column; components that no column tells are zero.
    ///
    /// # Errors
    /// If a word is no number, or there are too many parts.
    pub fn add<'w>(
        &mut self,
        word: impl Fn(usize) -> Result<&'w str, String>,
    ) -> Result<(), String> {
        let mut columns = self.columns.iter().peekable();
        for (quantity, values) in &mut self.table.columns {
            let first = values.len();
            values.resize(first + quantity.components(), 0.0);
            while let Some(column) = columns.next_if(|column| column.quantity == *quantity) {
                let value = number(word(column.place)?)?;
                values[first + column.component] = value * column.factor;
            }
        }
        self.part.map_or(Ok(()), |part| self.parts.add(word(part)?))
    }

    /// The rows of the parts that are wanted.
    ///
    /// # Errors
    /// If they are not there, or none is named where there are several.
    pub fn table(mut self) -> Result<Table, Fault> {
        let request = self.request;
        if self.part.is_some() || !request.parts.is_empty() {
            let wanted = choose(&self.parts.names, &request.parts)?;
            let kept = self.parts.of_row.iter().map(|&part| wanted[part as usize]);
            self.table.keep(&kept.collect::<Vec<bool>>());
        }
        Ok(self.table)
    }
}

/// Columns of no rows, with as many components as the quantities have.
fn empty(columns: &[Column]) -> Table {
    let mut table = Table::default();
    for column in columns {
        if table
            .columns
            .last()
            .is_none_or(|(last, _)| *last != column.quantity)
        {
            table.columns.push((column.quantity, Vec::new()));
        }
    }
    table
}

/// The parts that rows name.
#[derive(Default)]
struct Parts {
    names: Vec<PartName>,
    numbers: BTreeMap<String, u32>,
    of_row: Vec<u32>,
}

impl Parts {
    fn add(&mut self, word: &str) -> Result<(), String> {
        let part = if let Some(&part) = self.numbers.get(word) {
            part
        } else {
            if self.names.len() == MOST_PARTS {
                return Err(format!("more than {MOST_PARTS} parts"));
            }
            let number = word
                .parse::<f64>()
                .ok()
                .filter(|n| n.fract() == 0.0 && n.abs() < 9e15);
            #[allow(clippy::cast_possible_truncation)] // whole and small
            self.names.push(match number {
                Some(number) => PartName {
                    number: Some(number as i64),
                    name: String::new(),
                },
                None => PartName {
                    number: None,
                    name: word.to_owned(),
                },
            });
            let part = u32::try_from(self.names.len() - 1).unwrap_or(u32::MAX);
            self.numbers.insert(word.to_owned(), part);
            part
        };
        self.of_row.push(part);
        Ok(())
    }
}

impl Head {
    fn place(&self, name: &str) -> Option<usize> {
        let exact = self.names.iter().position(|known| known == name);
        exact.or_else(|| {
            self.names
                .iter()
                .position(|known| known.eq_ignore_ascii_case(name))
        })
    }

    fn there(&self) -> Vec<&str> {
        self.names.iter().map(String::as_str).collect()
    }
}

/// The columns of all quantities that the table tells, in the order of [`Quantity::ALL`].
fn columns(head: &Head, request: &Request) -> Result<Vec<Column>, Fault> {
    let mut columns = Vec::new();
    for &quantity in Quantity::ALL {
        let stated = request.columns.stated(quantity);
        let places = places(head, quantity, stated)?;
        if places.iter().all(Option::is_none) {
            if quantity == Quantity::Position {
                let help = "call them x, y, z or name them in `columns`";
                return Err(format!("it has no columns of places: {help}").into());
            }
            continue;
        }
        // Along axes that the case has not nothing need be told.
        let needed = if quantity.components() == 3 {
            request.dimension
        } else {
            places.len()
        };
        if let Some(lacking) = places[..needed].iter().position(Option::is_none) {
            let name = quantity.name();
            let names = of_column(quantity, lacking, None);
            return Err(format!("of its {name} there is no column `{}`", names[0]).into());
        }
        for (component, place) in places.into_iter().enumerate() {
            if let Some(place) = place {
                columns.push(Column {
                    place,
                    quantity,
                    component,
                    factor: factor(head, place, quantity, request)?,
                });
            }
        }
    }
    Ok(columns)
}

/// Columns of the components of a quantity.
fn places(
    head: &Head,
    quantity: Quantity,
    stated: Option<&[String]>,
) -> Result<Vec<Option<usize>>, Fault> {
    let find = |names: Vec<String>| names.iter().find_map(|name| head.place(name));
    let all = 0..quantity.components();
    let Some(stated) = stated else {
        return Ok(all.map(|c| find(of_column(quantity, c, None))).collect());
    };
    let lacking = |name: &str| no_column("column", name, &head.there());
    if let ([base], true) = (stated, quantity.components() > 1) {
        let found: Vec<_> = all
            .map(|c| find(of_column(quantity, c, Some(base))))
            .collect();
        if found.iter().all(Option::is_none) {
            return Err(lacking(base));
        }
        return Ok(found);
    }
    if stated.len() > quantity.components() {
        let (name, most) = (quantity.name(), quantity.components());
        let words = format!(
            "`{name}` has {most} columns at most, found {}",
            stated.len()
        );
        return Err(Fault::of("columns", words));
    }
    let mut found = vec![None; quantity.components()];
    for (place, name) in found.iter_mut().zip(stated) {
        *place = Some(head.place(name).ok_or_else(|| lacking(name))?);
    }
    Ok(found)
}

/// One of the unit of a column in SI units.
fn factor(head: &Head, place: usize, quantity: Quantity, request: &Request) -> Result<f64, Fault> {
    let powers = quantity.powers_in(request.dimension);
    let Some(unit) = &head.units[place] else {
        return request.units.factor(quantity, request.dimension);
    };
    let (name, unit) = (shortened(&head.names[place]), shortened(unit));
    let read = |number: &str| units::parse(&format!("{number} {unit}"));
    let wrong =
        |why: String| Fault::from(format!("the unit `{unit}` of its column `{name}`: {why}"));
    let (factor, found) = read("1").map_err(wrong)?;
    let (zero, _) = read("0").map_err(wrong)?;
    if found != powers {
        return Err(wrong(format!("it is none of a {}", quantity.name())));
    }
    if zero != 0.0 {
        return Err(wrong("temperatures are read in K".to_owned()));
    }
    Ok(factor)
}

/// The column that names parts, if there is one, of other names or the usual ones.
fn part_column(head: &Head, request: &Request, others: &[&str]) -> Result<Option<usize>, Fault> {
    let mut names = request.columns.part_names();
    if request.columns.part.is_none() {
        names.splice(..0, others.iter().copied());
    }
    let found = names.iter().find_map(|name| head.place(name));
    match (found, &request.columns.part) {
        (None, Some(name)) => Err(no_column("column", name, &head.there())),
        _ => Ok(found),
    }
}
