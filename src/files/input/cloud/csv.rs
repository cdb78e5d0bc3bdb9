//! Comma-separated values: a particle in each row, units in a line `# units: mm,mm,mm,g` as in the
//! tables of this program, in the names of the columns (`x (mm)`), or stated in the input.

use csv::{ByteRecord, ReaderBuilder, Trim};

use super::columns::{Head, MOST_COLUMNS, Rows};
use super::text::{at, number};
use super::{Fault, Request, Table};

/// Beginning of a line with the units of the columns.
const UNITS: &str = "# units:";

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
    let mut rows = Rows::of(&head, request, &[])?;
    while next(&mut record)? {
        let line = record.position().map_or(0, csv::Position::line);
        let line = usize::try_from(line)
            .unwrap_or(usize::MAX)
            .saturating_sub(1);
        if record.len() != head.names.len() {
            let (found, wanted) = (record.len(), head.names.len());
            return Err(at(line, format!("{found} values, and {wanted} columns")).into());
        }
        rows.add(|place| word(&record, place))
            .map_err(|what| at(line, what))?;
    }
    rows.table()
}

fn word(record: &ByteRecord, place: usize) -> Result<&str, String> {
    let bytes = record.get(place).unwrap_or_default();
    std::str::from_utf8(bytes).map_err(|_| "a value is no UTF-8 text".to_owned())
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
