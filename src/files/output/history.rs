//! Tables of a run over time, as comma-separated values.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use csv::ByteRecord;
use sha2::{Digest, Sha256};

use super::extents::TableExtent;
use super::{OutputError, sheet, write_atomically};

/// One value of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value<'a> {
    /// A number, written with the fewest digits that give the same bits back.
    Real(f64),
    /// A count.
    Count(u64),
    /// A name or another word.
    Word(&'a str),
}

/// A column's name and SI unit (empty for none).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Name, as in the header.
    pub name: String,
    /// SI unit; empty for none.
    pub unit: String,
}

impl Column {
    /// A column.
    #[must_use]
    pub fn new(name: &str, unit: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
        }
    }
}

/// The SI unit of a sum over a model of 1, 2 or 3 dimensions: by area in one dimension, by length
/// in two. Other units stay.
#[must_use]
pub fn unit_of_model(unit: &str, dimension: usize) -> &str {
    match (unit, dimension) {
        ("J", 1) => "J/m^2",
        ("J", 2) => "J/m",
        ("N", 1) => "N/m^2",
        ("N", 2) => "N/m",
        ("N s", 1) => "N s/m^2",
        ("N s", 2) | ("N m s", 1) => "N s/m",
        ("kg", 1) => "kg/m^2",
        ("kg", 2) => "kg/m",
        ("kg m/s", 1) => "kg/(m s)",
        ("kg m/s", 2) | ("kg m^2/s", 1) => "kg/s",
        ("kg m^2/s", 2) => "kg m/s",
        ("N m s", 2) => "N s",
        _ => unit,
    }
}

/// A table being written; rank 0's alone. Each row goes out in one call at once.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    file: File,
    columns: usize,
    is_of_whole: bool,
    rows: u64,
    /// Of all that is in the file.
    bytes: u64,
    digest: Sha256,
}

impl Table {
    /// Starts a table, replacing any old one: a comment with the units, one with the share that is computed of a
    /// model of several `copies` of that, then the names.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn create(path: &Path, columns: &[Column], copies: u32) -> Result<Self, OutputError> {
        let header = header(columns, copies);
        write_atomically(path, &header)?;
        Self::append(path, columns.len(), true, &header, 0)
    }

    /// Continues a table after a restart: keeps the rows whose value in `column` is at most
    /// `last` and drops later ones, and a half-written last line. A missing table is started. One
    /// that lacks the last columns gets them as zero: their counts begin now. One without the share that is computed goes on
    /// without it.
    ///
    /// # Errors
    /// [`OutputError::Io`]; [`OutputError::Damaged`] if the table has other columns or a row that
    /// cannot be read.
    pub fn resume(
        path: &Path,
        columns: &[Column],
        copies: u32,
        column: &str,
        last: f64,
    ) -> Result<Self, OutputError> {
        if !path.exists() {
            return Self::create(path, columns, copies);
        }
        let content = fs::read(path).map_err(OutputError::io("read", path))?;
        let known = |count: usize| {
            [copies, 1].into_iter().find_map(|copies| {
                let rows = content.strip_prefix(&header(&columns[..count], copies)[..]);
                rows.map(|rows| (rows, count, copies))
            })
        };
        let Some((rows, count, stated)) = (1..=columns.len()).rev().find_map(known) else {
            let what = "its columns are not those that this run writes; move it away";
            return Err(OutputError::damaged(path, what));
        };
        let Some(key) = columns.iter().position(|c| c.name == column) else {
            let what = format!("it has no column {column}");
            return Err(OutputError::damaged(path, what));
        };
        let kept = keep(rows, count, columns.len(), key, last);
        let (kept, rows) = kept.map_err(|number| {
            let what =
                format!("row {number} has not {count} values with a number in column {column}");
            OutputError::damaged(path, what)
        })?;
        let content = [header(columns, stated), kept].concat();
        write_atomically(path, &content)?;
        Self::append(path, columns.len(), stated == copies, &content, rows)
    }

    /// Opens a table of this content.
    fn append(
        path: &Path,
        columns: usize,
        is_of_whole: bool,
        content: &[u8],
        rows: u64,
    ) -> Result<Self, OutputError> {
        let file = File::options().append(true).open(path);
        Ok(Self {
            path: path.to_owned(),
            file: file.map_err(OutputError::io("open", path))?,
            columns,
            is_of_whole,
            rows,
            bytes: content.len() as u64,
            digest: Sha256::new_with_prefix(content),
        })
    }

    /// True if rows are to be of the whole model, false of what is computed: the table began so.
    #[must_use]
    pub fn is_of_whole(&self) -> bool {
        self.is_of_whole
    }

    /// What the table holds so far.
    #[must_use]
    pub fn extent(&self) -> TableExtent {
        let name = self.path.file_name().unwrap_or_default();
        TableExtent {
            name: name.to_string_lossy().into_owned(),
            rows: self.rows,
            bytes: self.bytes,
            sha256: format!("{:x}", self.digest.clone().finalize()),
        }
    }

    /// A whole table, as its file holds it.
    ///
    /// # Panics
    /// If a row has not one value for each column.
    #[must_use]
    pub fn whole(columns: &[Column], rows: &[Vec<Value>]) -> Vec<u8> {
        let mut content = header(columns, 1);
        for row in rows {
            assert_eq!(row.len(), columns.len(), "a row of the wrong length");
            content.extend(sheet::line(cells(row)));
        }
        content
    }

    /// Writes a row.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    ///
    /// # Panics
    /// If the row has not one value for each column.
    pub fn row(&mut self, values: &[Value]) -> Result<(), OutputError> {
        self.rows([values])
    }

    /// Writes rows, all in one call.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    ///
    /// # Panics
    /// If a row has not one value for each column.
    pub fn rows<'a>(
        &mut self,
        rows: impl IntoIterator<Item = impl AsRef<[Value<'a>]>>,
    ) -> Result<(), OutputError> {
        let (columns, mut count) = (self.columns, 0);
        let lines = sheet::lines(rows.into_iter().map(|row| {
            let row = row.as_ref();
            assert_eq!(row.len(), columns, "a row of the wrong length");
            count += 1;
            cells(row)
        }));
        let written = self.file.write_all(&lines);
        written.map_err(OutputError::io("write", &self.path))?;
        self.rows += count;
        self.bytes += lines.len() as u64;
        self.digest.update(&lines);
        Ok(())
    }

    /// Syncs the rows written so far to the disk.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub fn sync(&self) -> Result<(), OutputError> {
        let synced = self.file.sync_all();
        synced.map_err(OutputError::io("sync", &self.path))
    }
}

fn cells(values: &[Value]) -> Vec<String> {
    let cell = |value: &Value| match value {
        // `Debug` uses an exponent where it is shorter; both round-trip.
        Value::Real(number) => format!("{number:?}"),
        Value::Count(count) => count.to_string(),
        Value::Word(word) => (*word).to_owned(),
    };
    values.iter().map(cell).collect()
}

/// The bytes of those `rows` of `columns` values whose number in column `key` is at most `last`, filled
/// with zeros to `wanted` columns, and their number; or the number of the first damaged row that has such a row after it.
/// Damaged rows at the end were half written, or are left by a power cut.
fn keep(
    rows: &[u8],
    columns: usize,
    wanted: usize,
    key: usize,
    last: f64,
) -> Result<(Vec<u8>, u64), usize> {
    let (mut kept, mut count) = (Vec::new(), 0);
    let mut reader = sheet::rows(rows);
    let mut record = ByteRecord::new();
    let (mut begin, mut wrong) = (0, None);
    for number in 1_usize.. {
        if !reader.read_byte_record(&mut record).map_err(|_| number)? {
            break;
        }
        let end = usize::try_from(reader.position().byte()).unwrap_or(rows.len());
        let row = &rows[begin..end];
        begin = end;
        // A quote that is still open has swallowed the end of the line.
        let closed = (row.iter()).fold(true, |closed, byte| closed ^ (*byte == b'"'));
        let whole = record.len() == columns && row.ends_with(b"\n") && closed;
        let value = record.get(key).filter(|_| whole);
        match value.and_then(|value| std::str::from_utf8(value).ok()?.parse::<f64>().ok()) {
            None => wrong = wrong.or(Some(number)),
            Some(value) if value > last => {}
            Some(_) => {
                if let Some(number) = wrong {
                    return Err(number);
                }
                kept.extend_from_slice(&row[..row.len() - 1]);
                kept.extend(b",0.0".repeat(wanted - columns));
                kept.push(b'\n');
                count += 1;
            }
        }
    }
    Ok((kept, count))
}

fn header(columns: &[Column], copies: u32) -> Vec<u8> {
    let unit = |c: &Column| match c.unit.as_str() {
        "" => "-".to_owned(),
        unit => unit.to_owned(),
    };
    let mut lines = sheet::units_line(columns.iter().map(unit));
    if copies > 1 {
        lines.extend(sheet::share_line(1.0 / f64::from(copies)));
    }
    lines.extend(sheet::line(columns.iter().map(|c| &c.name)));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns() -> Vec<Column> {
        vec![
            Column::new("step", ""),
            Column::new("time", "s"),
            Column::new("dt_reason", ""),
        ]
    }

    fn row(step: u64, time: f64) -> [Value<'static>; 3] {
        [
            Value::Count(step),
            Value::Real(time),
            Value::Word("courant"),
        ]
    }

    #[test]
    fn numbers_come_back_with_the_same_bits() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut table = Table::create(&path, &columns(), 1).unwrap();
        let times = [1.0 / 3.0, -0.0, 1e-300, f64::MAX, f64::INFINITY, 2.5e-9];
        for time in times {
            table.row(&row(1, time)).unwrap();
        }
        let text = fs::read_to_string(&path).unwrap();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("# units: -,s,-"));
        assert_eq!(lines.next(), Some("step,time,dt_reason"));
        for (line, time) in lines.zip(times) {
            let back: f64 = line.split(',').nth(1).unwrap().parse().unwrap();
            assert_eq!(back.to_bits(), time.to_bits());
        }
    }

    #[test]
    fn a_restart_drops_later_rows_and_a_half_written_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut table = Table::create(&path, &columns(), 1).unwrap();
        for step in 0..6_u32 {
            table.row(&row(step.into(), f64::from(step) * 0.1)).unwrap();
        }
        drop(table);
        let whole = fs::read_to_string(&path).unwrap();
        fs::write(&path, format!("{whole}6,0.6,cou")).unwrap();
        let mut table = Table::resume(&path, &columns(), 1, "step", 3.0).unwrap();
        table.row(&row(4, 4.0 * 0.1)).unwrap();
        drop(table);
        let text = fs::read_to_string(&path).unwrap();
        assert!(whole.starts_with(&text), "{text}");
        assert_eq!(text.lines().count(), 2 + 5);
        Table::resume(&path, &columns(), 1, "time", 9.0).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }

    #[test]
    fn a_restart_may_count_more_than_before() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut table = Table::create(&path, &columns()[..2], 1).unwrap();
        for (step, time) in [(0, 0.0), (1, 0.5), (2, 1.0)] {
            table.row(&row(step, time)[..2]).unwrap();
        }
        let [step, time, _] = columns().try_into().unwrap();
        let more = [step, time, Column::new("mass", "kg")];
        let mut table = Table::resume(&path, &more, 1, "step", 1.0).unwrap();
        let values = [Value::Count(2), Value::Real(1.5), Value::Real(3.0)];
        table.row(&values).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let whole = "# units: -,s,kg\nstep,time,mass\n0,0.0,0.0\n1,0.5,0.0\n2,1.5,3.0\n";
        assert_eq!(text, whole);
        // Fewer columns than there are would lose what is counted.
        assert!(Table::resume(&path, &more[..2], 1, "step", 9.0).is_err());
    }

    #[test]
    fn names_with_commas_quotes_and_line_ends_stay_in_their_columns() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("contacts.csv");
        let names = ["bumper, front", "a \"b\"", "two\nlines", "plain"];
        let row = |step: u64, name| [Value::Count(step), Value::Real(0.5), Value::Word(name)];
        let mut table = Table::create(&path, &columns(), 1).unwrap();
        for (step, name) in (0..).zip(names) {
            table.row(&row(step, name)).unwrap();
        }
        drop(table);
        let whole = fs::read_to_string(&path).unwrap();
        let sheet = sheet::Sheet::parse(&whole).unwrap();
        let read: Vec<&str> = sheet
            .rows
            .iter()
            .map(|(_, cells)| cells[2].as_str())
            .collect();
        assert_eq!(read, names);
        // Cut off anywhere in its last row, the table continues as if that had never been begun.
        let last = whole.find("3,0.5,plain").unwrap();
        for cut in last..whole.len() {
            fs::write(&path, &whole[..cut]).unwrap();
            let mut table = Table::resume(&path, &columns(), 1, "step", 9.0).unwrap();
            table.row(&row(3, "plain")).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), whole, "cut at {cut}");
        }
        Table::resume(&path, &columns(), 1, "step", 2.0).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), whole[..last]);
        // A quote that is never closed hides all that follows.
        fs::write(&path, format!("{}0,0.5,\"open\n", &whole[..last])).unwrap();
        Table::resume(&path, &columns(), 1, "step", 9.0).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), whole[..last]);
        // A row too short in the middle.
        fs::write(&path, whole.replace("1,0.5,", "1,0.5\n")).unwrap();
        let error = Table::resume(&path, &columns(), 1, "step", 9.0).unwrap_err();
        assert!(
            error.to_string().contains("row 2 has not 3 values"),
            "{error}"
        );
        // Remains of a power cut after the last row that is kept.
        fs::write(&path, format!("{whole}\0\0\0\n4,0.5\n")).unwrap();
        Table::resume(&path, &columns(), 1, "step", 3.0).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), whole);
    }

    #[test]
    fn other_columns_are_refused_and_a_missing_table_is_started() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("contacts.csv");
        Table::resume(&path, &columns(), 1, "time", 1.0).unwrap();
        let error = Table::resume(&path, &columns()[..2], 1, "time", 1.0).unwrap_err();
        assert!(error.to_string().contains("columns"), "{error}");
    }

    #[test]
    fn a_table_goes_on_with_the_share_that_it_began_with() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let begin = |copies| {
            let mut table = Table::create(&path, &columns(), copies).unwrap();
            table.row(&row(0, 0.0)).unwrap();
            fs::read_to_string(&path).unwrap()
        };
        let whole = begin(4);
        assert!(whole.starts_with("# units: -,s,-\n# computed_share: 0.25\nstep,"));
        let parsed = sheet::Sheet::parse(&whole).unwrap();
        assert_eq!(parsed.computed_share, Some(0.25));
        assert_eq!(parsed.text(), whole.as_bytes());
        let table = Table::resume(&path, &columns(), 4, "step", 9.0).unwrap();
        assert!(table.is_of_whole());
        assert_eq!(fs::read_to_string(&path).unwrap(), whole);
        // One of a program that did not state it.
        let part = begin(1);
        let table = Table::resume(&path, &columns(), 4, "step", 9.0).unwrap();
        assert!(!table.is_of_whole());
        assert_eq!(fs::read_to_string(&path).unwrap(), part);
        assert!(
            Table::resume(&path, &columns(), 1, "step", 9.0)
                .unwrap()
                .is_of_whole()
        );
    }
}
