//! Comma-separated values: a particle in each row, units in a line `# units: mm,mm,mm,g` as in the
//! tables of this program, in the names of the columns (`x (mm)`), or stated in the input.

use std::collections::BTreeMap;

use csv::{ByteRecord, ReaderBuilder, Trim};

use super::names::of_column;
use super::part::{MOST_PARTS, PartName, choose};
use super::table::no_column;
use super::text::{at, number, shortened};
use super::{Fault, Request, Table};
use model::Quantity;
use model::units;

/// Beginning of a line with the units of the columns.
const UNITS: &str = "# units:";
/// Most columns.
const MOST_COLUMNS: usize = 10_000;

/// A column that is read: its place in the rows, of which quantity and component it is, and one of
/// its unit in SI units.
struct Column {
    place: usize,
    quantity: Quantity,
    component: usize,
    factor: f64,
}

/// The head of a table.
struct Head {
    names: Vec<String>,
    units: Vec<Option<String>>,
}

/// Reads a table of particles.
///
/// # Errors
/// The fault, with its line.
pub fn read(bytes: &[u8], request: &Request) -> Result<Table, Fault> {
    let delimiter = delimiter(bytes);
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .delimiter(delimiter)
        .trim(Trim::All)
        .from_reader(bytes);
    let mut record = ByteRecord::new();
    let mut next = |record: &mut ByteRecord| match reader.read_byte_record(record) {
        Ok(more) => Ok(more),
        Err(cause) => Err(Fault::from(cause.to_string())),
    };
    if !next(&mut record)? {
        return Err("it is empty".into());
    }
    let head = head(&record, units_line(bytes), delimiter)?;
    let columns = columns(&head, request)?;
    let part = part_column(&head, request)?;
    let mut table = empty(&columns);
    let mut parts = Parts::default();
    while next(&mut record)? {
        let line = record.position().map_or(0, csv::Position::line);
        let line = usize::try_from(line)
            .unwrap_or(usize::MAX)
            .saturating_sub(1);
        if record.len() != head.names.len() {
            let (found, wanted) = (record.len(), head.names.len());
            return Err(at(line, format!("{found} values, and {wanted} columns")).into());
        }
        let read = row(&record, &columns, &mut table);
        read.map_err(|what| at(line, what))?;
        if let Some(place) = part {
            let word = word(&record, place).map_err(|what| at(line, what))?;
            parts.add(word).map_err(|what| at(line, what))?;
        }
    }
    if part.is_some() || !request.parts.is_empty() {
        let wanted = choose(&parts.names, &request.parts)?;
        let kept: Vec<bool> = parts
            .of_row
            .iter()
            .map(|&part| wanted[part as usize])
            .collect();
        table.keep(&kept);
    }
    Ok(table)
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

/// Adds a row; components that no column tells are zero.
fn row(record: &ByteRecord, columns: &[Column], table: &mut Table) -> Result<(), String> {
    let mut columns = columns.iter().peekable();
    for (quantity, values) in &mut table.columns {
        let first = values.len();
        values.resize(first + quantity.components(), 0.0);
        while let Some(column) = columns.next_if(|column| column.quantity == *quantity) {
            let value = number(word(record, column.place)?)?;
            values[first + column.component] = value * column.factor;
        }
    }
    Ok(())
}

fn word(record: &ByteRecord, place: usize) -> Result<&str, String> {
    let bytes = record.get(place).unwrap_or_default();
    std::str::from_utf8(bytes).map_err(|_| "a value is no UTF-8 text".to_owned())
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

/// Delimiter of the values of the first line that is no comment.
fn delimiter(bytes: &[u8]) -> u8 {
    let mut lines = bytes.split(|&b| b == b'\n').take(1000);
    let is_head = |line: &&[u8]| !line.starts_with(b"#") && !line.trim_ascii().is_empty();
    let head = lines.find(is_head).unwrap_or_default();
    let count = |d: u8| head.split(|&b| b == d).count();
    // Of those that are as frequent the last one.
    [b'\t', b';', b',']
        .into_iter()
        .max_by_key(|&d| count(d))
        .unwrap_or(b',')
}

/// The line of units, if there is one before the first row.
fn units_line(bytes: &[u8]) -> Option<&str> {
    let comments = bytes
        .split(|&b| b == b'\n')
        .take_while(|line| line.starts_with(b"#"));
    let mut texts = comments.filter_map(|line| std::str::from_utf8(line).ok());
    texts.find_map(|line| line.strip_prefix(UNITS))
}

fn head(record: &ByteRecord, units: Option<&str>, delimiter: u8) -> Result<Head, Fault> {
    if record.len() > MOST_COLUMNS {
        return Err(format!("it has more than {MOST_COLUMNS} columns").into());
    }
    let mut head = Head {
        names: Vec::new(),
        units: Vec::new(),
    };
    let mut stated = units
        .into_iter()
        .flat_map(|line| line.split(char::from(delimiter)));
    for place in 0..record.len() {
        let cell = word(record, place)
            .map_err(|what| at(0, what))?
            .trim_start_matches('\u{feff}');
        let own = cell
            .strip_suffix([')', ']'])
            .and_then(|rest| rest.rsplit_once(['(', '[']));
        let (name, own) = own.map_or((cell, None), |(name, unit)| (name.trim(), Some(unit)));
        let unit = stated
            .next()
            .or(own)
            .map(|unit| unit.trim().trim_matches('"'));
        let unit = unit.filter(|unit| !["", "-", "1"].contains(unit));
        head.names.push(name.to_owned());
        head.units.push(unit.map(str::to_owned));
    }
    let first = head.names.first().map_or("", String::as_str);
    if number(first).is_ok() {
        return Err("its first line has numbers, and must name the columns".into());
    }
    Ok(head)
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

/// The column that names parts, if there is one.
fn part_column(head: &Head, request: &Request) -> Result<Option<usize>, Fault> {
    let names = request.columns.part_names();
    let found = names.iter().find_map(|name| head.place(name));
    match (found, &request.columns.part) {
        (None, Some(name)) => Err(no_column("column", name, &head.there())),
        _ => Ok(found),
    }
}
